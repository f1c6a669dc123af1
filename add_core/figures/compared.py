"""The networks that are compared with each other: as a shipped report has them, or trained here on request."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

from .._assets import asset
from ..contest.describing import why_not
from ..errors import ParameterError, ShapeFileError
from ..evaluation import Scores
from ..evaluation.report_reading import load_report
from .methods import method
from .studio import Studio

ARCHITECTURES = ("ADD1", "ADD2", "ADD3", "mADD1", "mADD2", "mADD3")
RIVALS = ("OSD", "learned WFT", "isotropic network")
"""The paper's learned rivals, and the network that has everything but direction."""
SHAPES, ANGLES, SPLINES, VALIDATE_EVERY = 16, 8, 64, 250
"""Of a training on request: bodies, directions, splines, and steps between validations, the fewest that are taken."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """scores : of networks on the shipped people. source : where they come from, as part of a sentence."""

    scores: tuple[Scores, ...]
    source: str

    def of(self, titles: tuple[str, ...]) -> list[Scores]:
        """Those of the methods with these titles, in the titles' order; each once."""
        found = {method(score.method).title: score for score in reversed(self.scores)}
        return [found[title] for title in titles if title in found]


def shipped_comparison() -> Comparison | None:
    """The report on meshes, among those that ship, with most of `ARCHITECTURES`; None if none has two of them."""
    best, most = None, 1
    for folder in _reports():
        comparison = Comparison(tuple(load_report(folder)), f"the report {folder.name} that ships with the project")
        count = len(comparison.of(ARCHITECTURES))
        if count > most:
            best, most = comparison, count
    return best


def _reports() -> list[Path]:
    try:
        folder = asset("reports", "README.md").parent
    except ShapeFileError:
        return []
    return sorted(path.parent for path in folder.glob("*_mesh/scores.json"))


def train_all(studio: Studio, folder: Path, minutes: float) -> list[str]:
    """Train every architecture on the cast's collection for so many minutes each, after its inputs are made; the
    folders of the models. What `folder` holds of an earlier call is gone on with.

    Raises ParameterError if torch is not installed.
    """
    reason = why_not(ARCHITECTURES[0])
    if reason is not None and "torch" in reason:
        raise ParameterError(f"networks cannot be trained: {reason}.")
    from ..learning import InputRecipe, LearningTask, TrainingSettings, train
    from ..learning.architectures import default_alphas

    folders = []
    for name in ARCHITECTURES:
        run = folder / f"{studio.quality.name}, {minutes:g} minutes" / name
        if not (run / "finished").is_file():
            task = LearningTask.of(studio.cast.collection, most=SHAPES)
            alphas, count = default_alphas(name), studio.quality.eigenpairs
            recipe = InputRecipe(alphas=alphas, angles=ANGLES, eigenpairs=count, splines=SPLINES)
            settings = TrainingSettings(validate_every=VALIDATE_EVERY)
            train(
                task,
                run,
                architecture=name,
                recipe=recipe,
                settings=settings,
                minutes=minutes,
                report=studio.listen,
            )
            shutil.rmtree(run / "inputs", ignore_errors=True)  # hundreds of megabytes that the model needs no more
            (run / "finished").touch()
        folders.append(str(run))
        studio.done()
    return folders
