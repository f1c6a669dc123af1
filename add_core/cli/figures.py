"""`add-core figures`: every figure of the paper with one command."""

from __future__ import annotations

import shlex
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import ParameterError
from . import options
from .application import FAILURE, SUCCESS
from .reporting import progress, result

if TYPE_CHECKING:
    from ..figures import Outcome


class _Numbers(click.ParamType[tuple[int, ...]]):
    """Figure numbers with commas between them, as `3,6`."""

    name = "numbers"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[int, ...]:
        if isinstance(value, tuple):
            return value
        try:
            return tuple(int(part) for part in str(value).split(","))
        except ValueError:
            self.fail(f"{value!r} is not a list of figure numbers such as 3,6.", param, ctx)


@click.command("figures")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path, file_okay=False), required=True, help="Folder to write to."
)
@click.option("--only", type=_Numbers(), help="Numbers of figures, e.g. 3,6.", show_default="all")
@click.option(
    "--quality",
    type=click.Choice(("draft", "full")),
    default="full",
    show_default=True,
    help="draft: a few minutes. full: as they stand in a paper, an hour or so on two cores.",
)
@click.option("--format", "image", type=click.Choice(("png", "pdf", "svg")), default="png", show_default=True)
@click.option("--again", is_flag=True, help="Draw figures again that the folder holds already.")
@click.option(
    "--train",
    type=float,
    metavar="MINUTES",
    help="Train the networks of Figure 8 so long each (with few bodies, in DIR/models). By default a shipped report "
    "of longer training is drawn.",
)
@options.as_json
def command(
    output: Path,
    only: tuple[int, ...] | None,
    quality: str,
    image: str,
    again: bool,
    train: float | None,
    as_json: bool,
) -> int:
    """Draw the paper's figures anew from the shipped shapes, with captions and what differs, in index.html.

    What the folder holds already in this quality and format is kept, so the same command goes on where it was stopped.
    Learned descriptors need the extra `learning`, the random forest the extra `forest`; what is missing is left out
    and said.
    """
    try:
        from ..figures import reproduce
    except ImportError as error:  # an extra: whoever only needs numbers need not install it
        if (error.name or "").partition(".")[0] != "matplotlib":
            raise
        raise ParameterError("Figures need matplotlib, which is not installed. Run: pip install matplotlib") from None
    outcomes = reproduce(
        output,
        only=only,
        quality=quality,
        image=image,
        again=again,
        train=train,
        command="add-core " + shlex.join(sys.argv[1:]),
        watch=lambda figure: progress(f"Figure {figure.number}", as_json=as_json),
        finished=None if as_json else _say,
    )
    page = str(output / "index.html")
    if as_json:
        result({"figures": [_facts(one) for one in outcomes], "page": page}, as_json=True)
    else:
        click.echo(f"Open {page}")
    return SUCCESS if any(one.entry is not None for one in outcomes) else FAILURE


def _facts(outcome: Outcome) -> dict[str, Any]:
    if outcome.entry is None:
        return {"number": outcome.figure.number, "drawn": False, "reason": outcome.reason}
    return asdict(outcome.entry) | {"drawn": True, "kept": outcome.kept}


def _say(outcome: Outcome) -> None:
    name = f"Figure {outcome.figure.number:>2}"
    if outcome.entry is None:
        click.echo(f"{name}  not drawn: {outcome.reason}")
        return
    time = "kept; --again draws it anew" if outcome.kept else f"{outcome.entry.seconds:.0f} s"
    click.echo(f"{name}  {outcome.entry.files[0]}  {time}")
    for line in outcome.entry.missing:
        click.echo(f"           left out: {line}")
