"""Mini-batches of 100 pairs a second for the paper's networks; descriptors of a person once its spectra are there, and
from nothing by the shipped model.

The paper reports 43, 29 and 17 mini-batches a second for ADD1 to ADD3, and 0.5 s a shape, on a GPU of 2014.
"""

import tempfile
import time

import numpy as np
import torch

from add_core.io import humans
from add_core.learning import InputRecipe, Model, TrainingSettings, build_network, load_model
from add_core.learning.inputs import Moments
from add_core.learning.training import fit
from add_core.learning.training_set import PreparedShape

POINTS, STEPS = 6890, {"1": 60, "2": 30, "3": 15}
PUBLISHED = {"1": 43, "2": 29, "3": 17}


def made_up(recipe: InputRecipe, seed: int) -> PreparedShape:
    draw = np.random.default_rng(seed)
    values = draw.normal(size=(POINTS, recipe.channels, recipe.splines)).astype(np.float16)
    ones = np.ones((recipe.channels, recipe.splines), np.float32)
    positions = draw.normal(size=(POINTS, 3)).astype(np.float32)
    return PreparedShape(values, np.arange(POINTS), np.ones(POINTS), positions, Moments(0 * ones, ones), str(seed))


def measure(name: str) -> tuple[float, float]:
    """Mini-batches a second, and seconds for the descriptors of all points of a shape."""
    recipe = InputRecipe(alphas=(0.0, 25.0, 50.0) if name.startswith("m") else (50.0,))
    network = build_network(name, splines=recipe.splines)
    shapes = [made_up(recipe, seed) for seed in range(2)]
    steps, marks = STEPS[name[-1]], []
    settings = TrainingSettings(loss="siamese", optimizer="adadelta", steps=steps, pairs=100, checkpoint_every=10**6)
    with tempfile.TemporaryDirectory() as folder:
        fit(
            network.architecture,
            recipe,
            shapes,
            folder,
            settings=settings,
            report=lambda event: marks.append(time.perf_counter()) if event["event"] == "step" else None,
        )
    model = Model(network, recipe, shapes[0].moments)
    start = time.perf_counter()
    model.describe_inputs(shapes[0].values, shapes[0].mass)
    # Half of the steps warm up; the last one writes the checkpoint.
    speed = (steps // 2 - 1) / (marks[-2] - marks[steps // 2 - 1])
    return speed, time.perf_counter() - start


def from_nothing() -> tuple[float, float]:
    """Seconds for the shipped model's descriptors of a person without a cache, and with the spectra at hand."""
    model, person = load_model("humans-madd3"), humans()[80]
    start = time.perf_counter()
    family = model.recipe.spectra(person, cache=False)
    middle = time.perf_counter()
    model.describe_inputs(model.recipe.inputs(family), family.mass, person)
    end = time.perf_counter()
    return end - start, end - middle


def main() -> None:
    print(f"{torch.get_num_threads()} threads, {POINTS} points, M = {InputRecipe().splines}")
    print("network  batches/s  paper (GPU)  descriptors s")
    for name in ("ADD1", "ADD2", "ADD3", "mADD1", "mADD2", "mADD3"):
        speed, seconds = measure(name)
        published = PUBLISHED[name[-1]] if not name.startswith("m") else "-"
        print(f"{name:7}  {speed:9.1f}  {published!s:>11}  {seconds:13.2f}")
    whole, after = from_nothing()
    print(
        f"humans-madd3 of a person: {whole:.1f} s from nothing (asked: 12), {after:.2f} s with its spectra (asked: 1.5)"
    )


if __name__ == "__main__":
    main()
