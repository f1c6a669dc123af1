"""`add-core train`: learn a descriptor from shapes with known correspondence."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from ..errors import ParameterError
from ..io import SHIPPED, Collection, open_collection
from ..operators import Conductivity
from . import options
from .reporting import result
from .stopping import Report, stoppable

_NETWORKS = ("ADD1", "ADD2", "ADD3", "mADD1", "mADD2", "mADD3", "mADD4")
_SETTINGS = (
    "optimizer",
    "learning_rate",
    "steps",
    "pairs",
    "noise",
    "validate_every",
    "checkpoint_every",
    "patience",
    "arithmetic",
    "device",
    "seed",
)
"""Options that go to `TrainingSettings` as they are."""
_FOLDER = click.Path(path_type=Path, file_okay=False)


@click.command("train")
@click.option("--architecture", type=click.Choice(_NETWORKS), default="mADD3", show_default=True)
@click.option("--data", required=True, help="humans, poses, dogs, or a folder of shapes with known correspondence.")
@click.option("--angles", type=int, default=16, show_default=True, help="L: directions of each anisotropic operator.")
@click.option("--alphas", type=options.Numbers(), default=None, help="Degrees of anisotropy. [default: the paper's]")
@click.option("--count", type=int, default=300, show_default=True, help="K: eigenpairs of each operator.")
@click.option("--splines", type=int, default=96, show_default=True, help="M: splines on the eigenvalues.")
@options.conductivity
@click.option("--isotropic", is_flag=True, help="The isotropic twin: the same layers without any direction.")
@click.option("--loss", type=click.Choice(("soft-nearest", "siamese", "multinomial")), default=None)
@click.option("--optimizer", type=click.Choice(("adam", "adadelta")), default="adam", show_default=True)
@click.option("--learning-rate", type=float, default=None, help="[default: 0.001 for adam, 1 for adadelta]")
@click.option("--steps", type=int, default=3000, show_default=True, help="Mini-batches in all.")
@click.option("--minutes", type=float, help="Instead of --steps: as many as this machine takes in that time.")
@click.option("--shapes", type=click.IntRange(min=2), help="At most so many to train on. [default: all]")
@click.option("--pairs", type=int, default=192, show_default=True, help="Pairs of points in a mini-batch.")
@click.option("--noise", type=float, default=0.1, show_default=True, help="Added to the standardised inputs.")
@click.option("--variations", type=int, default=0, show_default=True, help="Varied copies of each training shape.")
@click.option("--patience", type=int, default=0, help="Stop after so many validations without improvement; 0: never.")
@click.option("--validate-every", type=int, default=250, show_default=True, help="Steps between two validations.")
@click.option("--checkpoint-every", type=int, default=100, show_default=True, help="Steps between two checkpoints.")
@click.option("--arithmetic", type=click.Choice(("float32", "bfloat16")), default="float32", show_default=True)
@click.option("--device", default="cpu", show_default=True, help="Of torch, such as cuda.")
@click.option("--seed", type=int, default=0, show_default=True)
@click.option("-o", "--output", "run", type=_FOLDER, required=True, help="Run folder.")
@options.as_json
def command(architecture: str, data: str, run: Path, as_json: bool, **chosen: Any) -> None:
    """Learn a descriptor of points from shapes with known correspondence.

    The run folder keeps prepared inputs, checkpoints and, from the first validation on, the best model so far,
    model.safetensors. The same command goes on where it was stopped, to the same weights. What is called the test part
    of the data is not looked at; the last subject (or the last tenth) of the training part is for validation.
    """
    from ..learning import InputRecipe, LearningTask, TrainingSettings, train

    conductivity: Conductivity = chosen["conductivity"]
    alphas = chosen["alphas"] or ((0.0, 25.0, 50.0) if architecture.startswith("m") else (50.0,))
    recipe = InputRecipe(
        alphas=alphas,
        angles=chosen["angles"],
        eigenpairs=chosen["count"],
        splines=chosen["splines"],
        conductivity=conductivity,
        isotropic=chosen["isotropic"],
    )
    settings = TrainingSettings(
        loss=chosen["loss"] or ("multinomial" if architecture == "mADD4" else "soft-nearest"),
        **{name: chosen[name] for name in _SETTINGS},
    )
    task = LearningTask.of(
        _collection(data), most=chosen["shapes"], variations=chosen["variations"], seed=settings.seed
    )
    with _json_lines() if as_json else _live() as said, stoppable(said) as report:
        train(
            task,
            run,
            architecture=architecture,
            recipe=recipe,
            settings=settings,
            minutes=chosen["minutes"],
            report=report,
        )
    if not as_json:
        result({"model": str(run / "model.safetensors")}, as_json=False)


def _collection(data: str) -> Collection:
    if data in SHIPPED and not Path(data).exists():
        return SHIPPED[data]()
    if not Path(data).is_dir():
        raise ParameterError(f"--data must be {', '.join(SHIPPED)} or a folder, but there is no folder {data!r}.")
    return open_collection(data)


@contextmanager
def _json_lines() -> Iterator[Report]:
    # JSON knows no NaN, which a score without a symmetry is.
    def known(value: Any) -> Any:
        return None if isinstance(value, float) and value != value else value

    yield lambda event: click.echo(json.dumps({name: known(value) for name, value in event.items()}))


@contextmanager
def _live() -> Iterator[Report]:
    """A bar on a terminal's stderr, and a line for each validation."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("Inputs")

        def report(event: dict[str, Any]) -> None:
            if event["event"] == "prepare":
                bar.update(task, completed=event["done"], total=event["total"], description=f"Inputs {event['name']}")
            elif event["event"] == "step":
                words = f"Training, loss {event['loss']:.3f}, {event['per_second']:.1f} batches/s"
                bar.update(task, completed=event["step"], total=event["steps"], description=words)
            elif event["event"] == "validation":
                scores = ("loss", "auc", "cmc1", "cmc10", "right_side")
                line = "  ".join(f"{name} {event[name]:.4f}" for name in scores)
                console.print(f"step {event['step']}  {line}", highlight=False)

        yield report
