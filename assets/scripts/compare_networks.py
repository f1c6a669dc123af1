"""The comparison of the paper's Figures 7 and 8: networks of equal budget and signatures, on the test people.

    python compare_networks.py -o FOLDER [--inputs RUN/inputs] [--report ../reports]
    python compare_networks.py -o FOLDER --longer

All networks learn from the same bodies for the same number of mini-batches; OSD is in closed form and learns from them
too, the windowed Fourier network from as many mini-batches of a part of them. FOLDER keeps what was done. --longer
gives the networks of the paper, and them alone, more bodies and steps, and writes longer_mesh and so on.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch
import training_bodies
from train_models import RECIPE

from add_core.contest.pairs import chosen_pairs
from add_core.evaluation import Scores, averaged, save_report, table
from add_core.evaluation.baselines import describe_with
from add_core.evaluation.samples import Sample, sample
from add_core.evaluation.scores import PROTOCOLS, descriptor_scores
from add_core.geometry import TriangleMesh, normalize
from add_core.geometry.pair_distances import PairDistances
from add_core.io import humans
from add_core.learning import InputRecipe, Model, TrainingSettings, TrainingShape, load_model
from add_core.learning.architectures import build_network
from add_core.learning.inputs import Moments
from add_core.learning.optimal_spectral import linear_part, linear_recipe, optimal_spectral_descriptor
from add_core.learning.training import fit
from add_core.learning.training_set import PreparedShape, prepare
from add_core.learning.windowed_fourier import FourierShape, WindowedFourierNetwork, learn_windowed_fourier
from add_core.spectra import compute_spectra

BODIES, MORE_BODIES = range(0, 112, 2), range(0, 200, 2)
SETTINGS = TrainingSettings(
    learning_rate=3e-3,
    steps=1500,
    pairs=160,
    noise=0.15,
    averaging=0.99,
    arithmetic="bfloat16",
    checkpoint_every=250,
    validate_every=250,
)
"""Of all networks alike. On persons 7 and 8, whom BODIES leave out, 0.001 left ADD1 to ADD3 far from converged."""
LONGER = replace(
    SETTINGS, learning_rate=2e-3, steps=3600, pairs=100, noise=0.1, arithmetic="float32", checkpoint_every=500
)
NETWORKS = ("ADD1", "ADD2", "ADD3", "mADD1", "mADD2", "mADD3")
ISOTROPIC = ("ADD1", "ADD3", "mADD1", "mADD3")
"""Networks whose isotropic twins are trained too; that of mADD3 is the isotropic network of the figures."""
SIGNATURES = ("hks", "wks")
VARIANTS = ("mesh", "remeshed", "cloud")
PAIRS, QUERIES = 3, 500

Describe = Callable[[PreparedShape, Sample], np.ndarray]


@dataclass(frozen=True)
class View:
    """Which channels of the common inputs a network sees, and the recipe that says so."""

    recipe: InputRecipe
    channels: tuple[int, ...]

    @classmethod
    def of(cls, name: str, *, isotropic: bool) -> View:
        """ADD networks see the channels of α = 50, mADD networks all, isotropic twins the one of α = 0 repeated."""
        alphas = RECIPE.alphas if name.startswith("m") else (50.0,)
        recipe = replace(RECIPE, alphas=alphas, isotropic=isotropic)
        first = RECIPE.channels - recipe.channels
        return cls(recipe, (0,) if isotropic else tuple(range(first, RECIPE.channels)))

    def __call__(self, shape: PreparedShape) -> PreparedShape:
        chosen = list(self.channels)
        moments = Moments(shape.moments.mean[chosen], shape.moments.deviation[chosen])
        seen = replace(shape, values=np.ascontiguousarray(shape.values[:, chosen]), moments=moments)
        repeated = np.zeros(self.recipe.channels, dtype=np.int64)
        return replace(seen, channels=repeated) if self.recipe.isotropic else seen


def network(
    name: str, shapes: list[PreparedShape], folder: Path, settings: TrainingSettings, *, isotropic: bool = False
) -> Describe:
    """Train one of the paper's networks, or take the one trained before."""
    view = View.of(name, isotropic=isotropic)
    built = build_network(name, alphas=view.recipe.alphas, angles=RECIPE.angles, splines=RECIPE.splines)
    # Reflection exchanges angles: nothing to learn from without any.
    symmetry = None if isotropic else training_bodies.people_middles().symmetry
    model = fit(
        built.architecture, view.recipe, [view(s) for s in shapes], folder, settings=settings, symmetry=symmetry
    )

    def describe(shape: PreparedShape, part: Sample) -> np.ndarray:
        seen = view(shape)
        values = seen.values if seen.channels is None else np.repeat(seen.values, len(seen.channels), axis=1)
        return model.describe_inputs(values, shape.mass, part.shape)

    return describe


def osd(shapes: list[PreparedShape]) -> Describe:
    """Optimal spectral descriptors, from the channel of α = 0 without the logarithm."""
    symmetry = training_bodies.people_middles().symmetry
    linear = [linear_part(shape) for shape in shapes]
    model = optimal_spectral_descriptor(linear, linear_recipe(RECIPE), symmetry=symmetry)
    return lambda shape, _: model.describe_inputs(linear_part(shape).values, shape.mass)


def windowed_fourier(bodies: list[TrainingShape], file: Path) -> Describe:
    """The learned windowed Fourier network, which sees eigenfunctions rather than inputs."""
    if file.exists():
        kept = torch.load(file, weights_only=True)
        learned = WindowedFourierNetwork()
        learned.load_state_dict(kept)
    else:
        learned = learn_windowed_fourier(bodies, steps=SETTINGS.steps // 2)
        torch.save(learned.state_dict(), file)
    return lambda _, part: learned.describe(FourierShape.of(part.shape))


def signature(name: str) -> Describe:
    """A hand-made signature of sixteen numbers."""

    def describe(_: PreparedShape, part: Sample) -> np.ndarray:
        family = compute_spectra(normalize(part.shape), alphas=(0.0,), angles=1, count=RECIPE.eigenpairs)
        return describe_with(name, family)

    return describe


def evaluate(
    methods: dict[str, Describe],
    folder: Path,
    variant: str,
    protocols: tuple[str, ...] = PROTOCOLS,
    *,
    pairs: int = PAIRS,
    queries: int = QUERIES,
) -> list[Scores]:
    """Scores of every method on the same pairs."""
    found: dict[str, list[Scores]] = {name: [] for name in methods}
    numbers = chosen_pairs(humans(), pairs, 0)
    parts = {i: sample(humans(), i, variant) for pair in numbers for i in pair}
    shapes = {i: prepared_sample(part, folder / "test") for i, part in parts.items()}
    described = {(name, i): describe(shapes[i], parts[i]) for name, describe in methods.items() for i in parts}
    for i, j in numbers:
        distances = PairDistances(parts[j].shape)
        for name in methods:
            pair = (described[name, i], described[name, j])
            scores = descriptor_scores(
                name, parts[i], parts[j], pair, protocols=protocols, distances=distances, queries=queries
            )
            found[name].append(scores)
    return [averaged(scores) for scores in found.values()]


def shipped(name: str) -> Describe:
    """A model of assets/models, or in the folder of a training."""
    model: Model = load_model(name)
    return lambda shape, part: model.embed_inputs(shape.values, shape.mass, part.shape)


def prepared_sample(part: Sample, folder: Path) -> PreparedShape:
    """Inputs of a test sample, computed once."""
    item = TrainingShape(part.shape, np.arange(part.shape.vertex_count))
    return prepare([item], RECIPE, folder, workers=1)[0]


def learned_methods(folder: Path, inputs: Path) -> dict[str, Describe]:
    """All that learn, from the least to the most that they can express."""
    bodies = [training_bodies.person(number) for number in BODIES]
    shapes = prepare(bodies, RECIPE, inputs)
    made: dict[str, Describe] = {"osd": osd(shapes)}
    meshes = [item for item in bodies if isinstance(item.shape, TriangleMesh)]
    made["learned-wft"] = windowed_fourier(meshes[:24], folder / "wft.pt")
    return made | networks(shapes, folder, SETTINGS)


def networks(shapes: list[PreparedShape], folder: Path, settings: TrainingSettings) -> dict[str, Describe]:
    """The paper's networks, and isotropic twins of some."""
    made: dict[str, Describe] = {}
    for name in NETWORKS:
        if name in ISOTROPIC:
            twin = "isotropic" if name == "mADD3" else f"{name}, isotropic"
            made[twin] = network(name, shapes, folder / f"{name}-isotropic", settings, isotropic=True)
        made[name] = network(name, shapes, folder / name, settings)
        print(name, flush=True)
    return made


def compare(methods: dict[str, Describe], given: argparse.Namespace) -> None:
    """Score the methods on each variant of the test people, and write a report of it."""
    settings, bodies, times = (LONGER, MORE_BODIES, 2) if given.longer else (SETTINGS, BODIES, 1)
    pairs, queries = times * PAIRS, times * QUERIES
    protocols = ("cmc", "roc") if given.longer else PROTOCOLS
    for variant in VARIANTS:
        scores = evaluate(methods, given.output, variant, protocols, pairs=pairs, queries=queries)
        print(variant, table(scores), sep="\n", flush=True)
        note = f"{settings.steps} mini-batches of {settings.pairs} pairs from {len(bodies)} bodies for each network."
        save_report(
            scores,
            given.report / f"{'longer' if given.longer else 'learned'}_{variant}",
            title=f"16 numbers, test people, {variant}",
            command="python assets/scripts/compare_networks.py -o FOLDER" + " --longer" * given.longer,
            notes=[f"{pairs} pairs, {queries} queries each.", note],
        )


def score_models(methods: dict[str, Describe], folder: Path) -> None:
    """Write scores.json of the first model, for `ship_model.py`."""
    found = {variant: evaluate(methods, folder, variant, ("cmc", "roc")) for variant in VARIANTS}
    for variant, scores in found.items():
        print(variant, table(scores), sep="\n", flush=True)
    first = {variant: scores[0].numbers for variant, scores in found.items()}
    (folder / "scores.json").write_text(json.dumps(first, indent=1), encoding="utf-8")


def main() -> None:
    """Train, score and write a report for each variant of the test people."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--inputs", type=Path)
    parser.add_argument("--report", type=Path, default=Path(__file__).parents[1] / "reports")
    parser.add_argument("--models", nargs="*", default=["humans-madd3"], help="Score these too.")
    parser.add_argument("--only-models", action="store_true", help="Train nothing; scores.json of the first.")
    parser.add_argument("--longer", action="store_true", help="The networks alone, trained for longer.")
    given = parser.parse_args()
    torch.set_num_threads(1)
    given.output.mkdir(parents=True, exist_ok=True)
    inputs = given.inputs or given.output / "inputs"
    models = {str(name): shipped(name) for name in given.models}
    if given.only_models:
        score_models(models, given.output)
    elif given.longer:
        shapes = prepare([training_bodies.person(number) for number in MORE_BODIES], RECIPE, inputs)
        compare(networks(shapes, given.output, LONGER), given)
    else:
        signatures = {name: signature(name) for name in SIGNATURES}
        compare(signatures | learned_methods(given.output, inputs) | models, given)


if __name__ == "__main__":
    main()
