"""Options that several commands share, and what their words mean."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

import click

from ..geometry import PointCloud, TriangleMesh, normalize
from ..operators import CONDUCTIVITIES
from .shapes import open_shape

_Command = TypeVar("_Command", bound=Callable[..., Any])

as_json = click.option(
    "--json", "as_json", is_flag=True, help="JSON: the result on stdout, progress on stderr, a line each."
)
conductivity = click.option(
    "--conductivity",
    type=click.Choice(CONDUCTIVITIES),
    default="curvature",
    show_default=True,
    help="How heat prefers directions: by the curvature, eq. (9), or by α alone, eq. (10).",
)
own_units = click.option(
    "--own-units",
    is_flag=True,
    help="Keep the shape's own length unit. Otherwise it is scaled to unit geodesic diameter first, so that α and t "
    "mean the same on every shape.",
)


def output(endings: Iterable[str], *, required: bool = False) -> Callable[[_Command], _Command]:
    """The option -o, refused before any work is done if the file's name has none of `endings`."""
    allowed = tuple(endings)

    def check(context: click.Context, parameter: click.Parameter, path: Path | None) -> Path | None:
        if path is not None and path.suffix.lower() not in allowed:
            raise click.BadParameter(f"{path} must end in one of {', '.join(allowed)}.", context, parameter)
        return path

    words = f"File to write: {', '.join(allowed)}."
    kind = click.Path(path_type=Path, dir_okay=False)
    return click.option("-o", "--output", type=kind, callback=check, required=required, help=words)


class Numbers(click.ParamType[tuple[float, ...]]):
    """Numbers with commas between them, as `0,25,50`."""

    name = "numbers"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        if isinstance(value, tuple):
            return value
        try:
            return tuple(float(part) for part in str(value).split(","))
        except ValueError:
            self.fail(f"{value!r} is not a list of numbers such as 0,25,50.", param, ctx)


def shape_to_work_on(name: str, *, own_units: bool) -> TriangleMesh | PointCloud:
    """The shape that `name` stands for, scaled to unit geodesic diameter unless it keeps its own units."""
    shape = open_shape(name)
    return shape if own_units else normalize(shape)


def length_unit(own_units: bool) -> str:
    """What lengths are counted in: to be said wherever a number depends on it."""
    return "the file's unit" if own_units else "geodesic diameters"
