"""From a collection of shapes to a model in one call, which can be stopped and repeated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from .._check import IntArray
from ..errors import ParameterError
from ..io import Collection
from .architectures import SPECIFICATIONS, build_network, default_alphas
from .budget import within
from .inputs import InputRecipe
from .model import Model
from .settings import TrainingSettings
from .training import Report, fit
from .training_set import Precision, TrainingShape, places_of, prepare
from .variations import vary

INPUTS = "inputs"
"""Folder of a run that holds the prepared inputs, several MB a shape; it may be deleted once the model is there."""


@dataclass(frozen=True, eq=False)
class LearningTask:
    """What to learn from, and what to judge by.

    training, validation : shapes whose places name the same points. symmetry : (P,), the place that mirrors each, or
    None.
    """

    training: Sequence[TrainingShape]
    validation: Sequence[TrainingShape] = ()
    symmetry: IntArray | None = None

    @classmethod
    def of(cls, collection: Collection, *, most: int | None = None, variations: int = 0, seed: int = 0) -> LearningTask:
        """The training part of a collection's split, all of it where there is no split; its test part is left alone.

        The last of three or more subjects is kept for validation, else the last tenth of the shapes.
        most : shapes to train on, and half as many to validate by, spread over those there are; None for all.
        variations : of each training shape, beside the shape itself; see `vary`. The validation shapes, then, are one
            as it is and one varied by turns: a deliberately different set.
        """
        chosen = np.arange(len(collection)) if collection.training is None else collection.split("train")
        subjects = [collection.subjects[i] if collection.subjects is not None else "" for i in chosen]
        held = np.array([subject == subjects[-1] for subject in subjects])
        if len(set(subjects)) < 3:
            held = np.arange(len(chosen)) >= len(chosen) - max(2, len(chosen) // 10)
        if (~held).sum() < 2:
            raise ParameterError(
                f"{collection.title} must hold at least four shapes to train on, but it has {len(chosen)}."
            )
        reference = int(chosen[0])
        training = places_of(collection, _spread(chosen[~held], most), reference=reference)
        validation = places_of(
            collection, _spread(chosen[held], None if most is None else most // 2), reference=reference
        )
        seeds = iter(np.random.SeedSequence(seed).generate_state(len(chosen) * (1 + variations)).tolist())
        varied = [vary(item, seed=next(seeds)) for _ in range(variations) for item in training]
        if variations:
            validation = [vary(item, seed=next(seeds)) if i % 2 else item for i, item in enumerate(validation)]
        return cls([*training, *varied], validation, collection.symmetry)


def train(
    data: Collection | LearningTask | Sequence[TrainingShape],
    folder: str | Path,
    *,
    architecture: str = "mADD3",
    recipe: InputRecipe | None = None,
    settings: TrainingSettings | None = None,
    minutes: float | None = None,
    precision: Precision = "float16",
    report: Report | None = None,
    workers: int | None = None,
) -> Model:
    """Train a network of the paper and return the model, which `folder` keeps as model.safetensors.

    The same call with the same folder goes on where an earlier one was stopped, bit for bit, spectra included.
    architecture : "ADD1" … "mADD4". recipe : how inputs are made; the paper's α for that network and 16 angles unless
    given. minutes : instead of the settings' steps, as many as this machine takes in that time once the inputs are
    there. report : called with a dictionary for each event: "prepare", "step", "validation" and "done". Returning
        False stops, as for `fit`. precision, workers : of the prepared inputs, see `prepare`.

    Raises ParameterError for sets or settings that do not fit, GeometryError for a shape without a usable surface,
    ConvergenceError if the loss stops being a number, Cancelled on request.
    """
    if isinstance(data, Collection):
        task = LearningTask.of(data)
    else:
        task = data if isinstance(data, LearningTask) else LearningTask(data)
    if architecture not in SPECIFICATIONS:
        raise ParameterError(f"architecture must be one of {', '.join(SPECIFICATIONS)}, but it is {architecture!r}.")
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
        reference_size=1 + max(int(np.max(shape.places)) for shape in shapes),
    )
    chosen = settings or TrainingSettings()
    if network.is_classifier and settings is None:
        chosen = replace(chosen, loss="multinomial")

    def run(settings: TrainingSettings, folder: Path, report: Report | None) -> Model:
        return fit(
            network.architecture,
            made,
            prepared[: len(task.training)],
            folder,
            settings=settings,
            validation=prepared[len(task.training) :],
            symmetry=task.symmetry,
            report=report,
        )

    if minutes is not None:
        chosen = within(minutes, chosen, Path(folder), run)
    return run(chosen, Path(folder), report)


def _spread(indices: IntArray, most: int | None) -> IntArray:
    """At most so many of the indices, at least two, evenly over all of them."""
    if most is None or len(indices) <= max(most, 2):
        return indices
    return indices[np.linspace(0, len(indices) - 1, max(most, 2)).round().astype(np.int64)]


def _prepared(name: str, done: int, total: int) -> dict[str, object]:
    return {"event": "prepare", "name": name, "done": done, "total": total}
