"""From a collection of shapes to a model in one call, which can be stopped and repeated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from .._check import positive
from ..errors import ParameterError
from ..io import Collection
from .architectures import SPECIFICATIONS, build_network, default_alphas
from .budget import within
from .inputs import InputRecipe
from .model import Model
from .settings import TrainingSettings
from .task import LearningTask
from .training import Report, fit
from .training_set import Precision, TrainingShape, prepare

INPUTS = "inputs"
"""Folder of a run that holds the prepared inputs, several MB a shape; it may be deleted once the model is there."""


def train(
    data: Collection | LearningTask | Sequence[TrainingShape],
    folder: str | Path,
    *,
    architecture: str = "mADD3",
    layers: str | None = None,
    recipe: InputRecipe | None = None,
    settings: TrainingSettings | None = None,
    minutes: float | None = None,
    precision: Precision = "float16",
    start: Model | None = None,
    report: Report | None = None,
    workers: int | None = None,
) -> Model:
    """Train a network of the paper and return the model, which `folder` keeps as model.safetensors.

    The same call with the same folder goes on where an earlier one was stopped, bit for bit, spectra included.
    architecture : "ADD1" … "mADD4". layers : in place of the paper's, see `build_network`. recipe : how inputs are
        made; the paper's α for that network and 16 angles unless given.
    minutes : instead of the settings' steps, as many as this machine takes in that time once the inputs are there.
    start : a model whose layers are taken over as far as they fit, such as those of mADD3 for the first ones of mADD4.
    report : called with a dictionary for each event: "prepare", "step", "validation" and "done". Returning False stops,
        as for `fit`. precision, workers : of the prepared inputs, see `prepare`.

    Raises ParameterError for sets or settings that do not fit, GeometryError for a shape without a usable surface,
    ConvergenceError if the loss stops being a number, Cancelled on request.
    """
    task = _task_of(data)
    if architecture not in SPECIFICATIONS:
        raise ParameterError(f"architecture must be one of {', '.join(SPECIFICATIONS)}, but it is {architecture!r}.")
    if minutes is not None:
        positive("minutes", minutes)  # before inputs are made, which takes long
    made = InputRecipe(alphas=default_alphas(architecture)) if recipe is None else recipe
    shapes = [*task.training, *task.validation]
    prepared = prepare(
        shapes,
        made,
        Path(folder) / INPUTS,
        precision=precision,
        workers=workers,
        report=None if report is None else lambda name, done, total: report(_prepared(name, done, total)),
    )
    network = build_network(
        architecture,
        alphas=made.alphas,
        angles=made.angles,
        splines=made.splines,
        reference_size=_classes(task),
        layers=layers,
    )
    chosen = settings or TrainingSettings()
    if network.is_classifier:
        chosen = chosen if settings is not None else replace(chosen, loss="multinomial")
        prepared = [shape.below(network.outputs) for shape in prepared]

    def run(settings: TrainingSettings, folder: Path, report: Report | None) -> Model:
        return fit(
            network.architecture,
            made,
            prepared[: len(task.training)],
            folder,
            settings=settings,
            validation=prepared[len(task.training) :],
            symmetry=task.symmetry,
            reference=task.reference if network.is_classifier else None,
            start=None if start is None else start.network,
            report=report,
        )

    if minutes is not None:
        chosen = within(minutes, chosen, Path(folder), run)
    return run(chosen, Path(folder), report)


def _classes(task: LearningTask) -> int:
    """Vertices of the reference shape, or places that the shapes share."""
    if task.reference is not None:
        return task.reference.vertex_count
    return 1 + max(int(np.max(shape.places)) for shape in [*task.training, *task.validation])


def _task_of(data: Collection | LearningTask | Sequence[TrainingShape]) -> LearningTask:
    if isinstance(data, Collection):
        return LearningTask.of(data)
    return data if isinstance(data, LearningTask) else LearningTask(data)


def _prepared(name: str, done: int, total: int) -> dict[str, object]:
    return {"event": "prepare", "name": name, "done": done, "total": total}
