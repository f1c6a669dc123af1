"""Train the models in assets/models from the shipped shapes: `python train_models.py humans -o RUN`.

Nearly all of the time goes into spectra: 17 operators for each of a hundred shapes, half an hour to an hour on a core,
and 2 GB of disk in RUN. It may be stopped and started again.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from add_core.io import Collection, dogs, humans
from add_core.learning import InputRecipe, LearningTask, TrainingSettings, TrainingShape, train
from add_core.learning.variations import blend, vary

RECIPE = InputRecipe(angles=8, eigenpairs=300, splines=96)
SETTINGS = TrainingSettings(steps=4000, pairs=192, validate_every=250)
SHAPES = {"humans": 96, "dogs": 48}
UNCHANGED = 0.25
"""Share of the training shapes that keep skin and meshing."""


def person(number: int) -> TrainingShape:
    """One of the eight people to train on, or a body blended from three of them in one pose; most of them varied."""
    draw = np.random.default_rng([1, number])
    pose = int(draw.integers(10))
    if draw.random() < 0.4:
        mesh: Any = humans()[10 * (number % 8) + pose]
    else:
        subjects, weights = draw.choice(8, 3, replace=False), draw.dirichlet([0.6] * 3)
        # From the mean outwards: bodies beyond the eight, as those of the test people may be.
        mesh = blend([humans()[10 * int(s) + pose] for s in subjects], 1 / 3 + 1.4 * (weights - 1 / 3))
    return _perhaps_varied(TrainingShape(mesh, np.arange(mesh.vertex_count)), draw)


def dog(number: int) -> TrainingShape:
    """One of the thirty dogs to train on, most of them varied."""
    draw = np.random.default_rng([2, number])
    mesh = dogs()[number % 30]
    return _perhaps_varied(TrainingShape(mesh, np.arange(mesh.vertex_count)), draw)


def _perhaps_varied(item: TrainingShape, draw: np.random.Generator) -> TrainingShape:
    return item if draw.random() < UNCHANGED else vary(item, seed=int(draw.integers(2**31)))


def main() -> None:
    """Train one model; the last weights count, because no shape that is kept for the test may choose among them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", choices=sorted(SHAPES))
    parser.add_argument("-o", "--output", type=Path, required=True)
    arguments = parser.parse_args()
    make, collection = {"humans": (person, humans()), "dogs": (dog, dogs())}[arguments.data]
    train(
        _task(make, collection, SHAPES[arguments.data]),
        arguments.output,
        architecture="mADD3",
        recipe=RECIPE,
        settings=SETTINGS,
        report=lambda event: print(event, flush=True) if event["event"] != "step" else None,
    )


def _task(make: Any, collection: Collection, count: int) -> LearningTask:
    return LearningTask([make(number) for number in range(count)], symmetry=collection.symmetry)


if __name__ == "__main__":
    main()
