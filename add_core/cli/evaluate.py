"""`add-core evaluate`: descriptors by the paper's three protocols, as tables, curves and one page."""

from __future__ import annotations

import shlex
import sys
from functools import cache
from pathlib import Path

import click
import numpy as np
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray
from ..correspondence import CorrespondenceForest
from ..errors import ParameterError
from ..evaluation import Scores, averaged, save_report, table
from ..evaluation.baselines import BASELINES, describe_with, functional_map_matches, refined_matches
from ..evaluation.samples import VARIANTS, Sample, sample
from ..evaluation.scores import PROTOCOLS, descriptor_scores, match_scores
from ..geometry import normalize
from ..geometry.pair_distances import PairDistances
from ..io import Collection, dogs, humans, poses
from ..spectra import SpectralFamily, compute_spectra
from .reporting import progress, result

COLLECTIONS = {"humans": humans, "poses": poses, "dogs": dogs}
MAPS, FOREST = "fm", "rf"
REFINED = "+zoomout"


@click.command("evaluate")
@click.option("--data", type=click.Choice(list(COLLECTIONS)), default="humans", show_default=True)
@click.option(
    "--variant",
    type=click.Choice(VARIANTS),
    default="mesh",
    show_default=True,
    help="Same triangles, other triangles (test people only), or clouds of 4,000 points.",
)
@click.option(
    "--descriptors",
    default="hks,wks,ahks",
    show_default=True,
    help=f"Some of {', '.join(BASELINES)}, {MAPS} "
    f"(functional maps), {FOREST} (random forest) or models of add-core train, with commas; "
    f"{REFINED} after one refines its matches.",
)
@click.option("--protocol", type=click.Choice(["all", *PROTOCOLS]), default="all", show_default=True)
@click.option("--pairs", type=click.IntRange(min=1), default=6, show_default=True, help="Pairs of test shapes.")
@click.option("--seed", type=int, default=0, show_default=True, help="Which pairs.")
@click.option("--queries", type=click.IntRange(min=1), help="Points asked for on each shape.", show_default="all")
@click.option("--count", type=click.IntRange(min=10), default=300, show_default=True, help="K: eigenpairs.")
@click.option("--alpha", type=float, default=50.0, show_default=True)
@click.option("--angles", type=click.IntRange(min=1), default=16, show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path, file_okay=False), help="Folder for the report.")
@click.option("--json", "as_json", is_flag=True, help="JSON: the result on stdout, progress on stderr, a line each.")
def command(
    data: str,
    variant: str,
    descriptors: str,
    protocol: str,
    pairs: int,
    seed: int,
    queries: int | None,
    count: int,
    alpha: float,
    angles: int,
    output: Path | None,
    as_json: bool,
) -> None:
    """Match test shapes by descriptors, and compare with the truth: CMC, ROC, Princeton and P(right side).

    Each shape is scaled to unit geodesic diameter; spectra are kept in the cache. With -o, a folder is written with
    index.html, curves.svg, scores.csv, curves.csv and scores.json.
    """
    methods = _methods(descriptors)
    if data != humans().title and any(method.startswith(FOREST) for method in methods):
        raise ParameterError(f"descriptors must not name {FOREST} for {data}: it is trained on the shipped people.")
    protocols = PROTOCOLS if protocol == "all" else (protocol,)
    collection = COLLECTIONS[data]()
    chosen = chosen_pairs(collection, pairs, seed)
    found: dict[str, list[Scores]] = {method: [] for method in methods}
    with progress("Pairs and descriptors", as_json=as_json) as advance:
        for number, numbers in enumerate(chosen):
            done, total = number * (1 + len(methods)), len(chosen) * (1 + len(methods))
            advance(done, total)
            pair = _Pair.of(collection, numbers, variant, alpha=alpha, angles=angles, count=count)
            for order, method in enumerate(methods, start=1):
                advance(done + order, total)
                found[method].append(pair.scores(method, protocols, queries))
        advance(total, total)
    scores = [averaged(found[method]) for method in methods]
    if output is not None:
        _save(scores, output, collection, variant, chosen, queries, count, as_json=as_json)
    if as_json:
        result({score.method: score.numbers for score in scores}, as_json=True)
    else:
        click.echo(table(scores))


def chosen_pairs(collection: Collection, pairs: int, seed: int) -> list[tuple[int, int]]:
    """Different ordered pairs of test shapes, drawn at random."""
    test = collection.split("test")
    every = [(int(i), int(j)) for i in test for j in test if i != j]
    order = np.random.default_rng(seed).permutation(len(every))
    return [every[k] for k in order[: min(pairs, len(every))]]


def _methods(descriptors: str) -> list[str]:
    names = [name.strip() for name in descriptors.split(",") if name.strip()]
    if not names:
        raise ParameterError("descriptors must name at least one, but the list is empty.")
    return list(dict.fromkeys(names))


class _Pair:
    """Two samples with their spectra, and descriptors computed once for all that ask."""

    def __init__(self, samples: tuple[Sample, Sample], families: tuple[SpectralFamily, SpectralFamily]) -> None:
        self._samples, self._families = samples, families
        self._distances = PairDistances(samples[1].shape)
        self._described: dict[str, tuple[FloatArray, FloatArray]] = {}

    @classmethod
    def of(
        cls, collection: Collection, numbers: tuple[int, int], variant: str, *, alpha: float, angles: int, count: int
    ) -> _Pair:
        samples = [sample(collection, number, variant) for number in numbers]
        families = [
            compute_spectra(
                normalize(one.shape), alphas=(0.0, alpha), angles=angles, count=min(count, one.shape.vertex_count - 1)
            )
            for one in samples
        ]
        return cls((samples[0], samples[1]), (families[0], families[1]))

    def scores(self, method: str, protocols: tuple[str, ...], queries: int | None) -> Scores:
        source, target = self._samples
        name = method.removesuffix(REFINED)
        if name in (MAPS, FOREST) or name != method:
            matches = self._matches(name)
            if name != method:
                matches = refined_matches(self._families[1], self._families[0], matches)
            return match_scores(method, source, target, matches, distances=self._distances, queries=queries)
        return descriptor_scores(
            method,
            source,
            target,
            self._descriptors(name),
            protocols=protocols,
            distances=self._distances,
            queries=queries,
        )

    def _matches(self, name: str) -> IntArray:
        """The target's point for each of the source's: the source is shape 2 of the map."""
        if name == MAPS:
            return functional_map_matches(self._families[1], self._families[0])
        if name == FOREST:
            return forest_matches(self._samples, self._descriptors("wks")[0], len(self._families[0].eigenvalues[0]))
        from ..correspondence import nearest_matches

        return nearest_matches(*self._descriptors(name))

    def _descriptors(self, name: str) -> tuple[FloatArray, FloatArray]:
        if name not in self._described:
            if name in BASELINES:
                one, two = (describe_with(name, family) for family in self._families)
            else:
                from ..learning import load_model

                model = load_model(name)
                one, two = (np.asarray(model.describe(part.shape), dtype=np.float64) for part in self._samples)
            self._described[name] = (one, two)
        return self._described[name]


def forest_matches(samples: tuple[Sample, Sample], descriptors: FloatArray, count: int) -> IntArray:
    """(q,): the target's point that a random forest, trained on other people's wave kernel signatures, finds."""
    label = _forest(count).matches(descriptors)
    target = samples[1]
    return np.asarray(KDTree(target.shape.vertices).query(target.original.vertices)[1], dtype=np.int64)[label]


@cache
def _forest(count: int) -> CorrespondenceForest:
    """Trained on one pose of each of the training people; labels are vertices of the first."""
    collection = humans()
    chosen = [int(index) for index in collection.split("train")[::11]]
    described = []
    for index in chosen:
        family = compute_spectra(normalize(collection[index]), alphas=(0.0,), angles=1, count=count)
        described.append(describe_with("wks", family))
    labels = [np.arange(len(values)) for values in described]
    return CorrespondenceForest.train(described, labels, collection[0].vertices)


def _save(
    scores: list[Scores],
    output: Path,
    collection: Collection,
    variant: str,
    chosen: list[tuple[int, int]],
    queries: int | None,
    count: int,
    *,
    as_json: bool,
) -> None:
    listed = "; ".join(f"{collection.names[i]} → {collection.names[j]}" for i, j in chosen)
    asked = "all points" if queries is None else f"{queries} points spread evenly over each first shape"
    notes = [
        f"Mean over {len(chosen)} pairs of test shapes ({variant}): {listed}.",
        f"Asked: {asked}, among all points of the second shape. {count} eigenfunctions. Errors and radii are geodesic "
        "distances ÷ √area; symmetric scores count the mirror image as true.",
    ]
    command = "add-core " + shlex.join(sys.argv[1:])
    save_report(scores, output, title=f"{collection.title}, {variant}", command=command, notes=notes)
    if not as_json:
        click.echo(f"Report: {output / 'index.html'}")
