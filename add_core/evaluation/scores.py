"""All protocols together, for one pair of shapes and averaged over many."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, IntArray, descriptor_array
from ..errors import ParameterError
from ..geometry.pair_distances import PairDistances
from .cmc import cmc
from .princeton import match_errors, princeton, princeton_curve, surface_area
from .right_side import right_side
from .roc import roc
from .samples import Sample, truth_between
from .truth import SurfacePoints

PROTOCOLS = ("cmc", "roc", "princeton")
SETTINGS = ("symmetric", "asymmetric")
FALSE_RATES = np.concatenate([np.linspace(0, 0.1, 101)[:-1], np.linspace(0.1, 1.0, 91)])
"""Where averaged ROC curves are sampled: finely where they rise."""


@dataclass(frozen=True)
class Curve:
    """One averaged curve of a method: x and y, both (p,), of a protocol in a setting."""

    protocol: str
    setting: str
    x: FloatArray
    y: FloatArray


@dataclass(frozen=True)
class Scores:
    """What one method reached, averaged over its pairs of shapes.

    numbers : headline numbers by name, such as "CMC@1", "AUC symmetric", "P(right side)", all dimensionless; errors are
        geodesic ÷ √area. curves : of every protocol and setting that was evaluated. pairs : how many were averaged.
    """

    method: str
    pairs: int
    numbers: dict[str, float]
    curves: tuple[Curve, ...] = field(repr=False)

    def curve(self, protocol: str, setting: str) -> Curve:
        """The curve of a protocol in a setting. Raises ParameterError if it was not evaluated."""
        for one in self.curves:
            if (one.protocol, one.setting) == (protocol, setting):
                return one
        raise ParameterError(f"{self.method} was not evaluated by {protocol}, {setting}. Evaluate it first.")


def descriptor_scores(
    method: str,
    source: Sample,
    target: Sample,
    descriptors: tuple[ArrayLike, ArrayLike],
    *,
    protocols: Sequence[str] = PROTOCOLS,
    distances: PairDistances | None = None,
    queries: int | None = None,
) -> Scores:
    """All protocols, in both settings, for descriptors (q, d) of the source's points and (n, d) of the target's.

    distances : of the target, to be shared between methods. queries : evaluate only so many of the source's points,
        spread evenly over their numbers; None for all of them.
    Raises ParameterError as the protocols do.
    """
    one, two = descriptor_array("descriptors", descriptors[0]), descriptor_array("descriptors", descriptors[1])
    chosen = query_rows(len(one), queries)
    truth = _part(truth_between(source, target), chosen)
    one = one[chosen]
    measure = distances if distances is not None else PairDistances(target.shape)
    area = surface_area(target.shape)
    numbers: dict[str, float] = {}
    curves: list[Curve] = []
    for setting, symmetry in _settings(target):
        if "cmc" in protocols:
            match = cmc(one, two, truth, symmetry=symmetry)
            curves.append(Curve("cmc", setting, match.x, match.y))
            for rank in (1, 10, 50):
                if rank <= len(match.y):
                    numbers[f"CMC@{rank} {setting}"] = match.at(rank)
        if "roc" in protocols:
            receiver = roc(one, two, truth, symmetry=symmetry)
            curves.append(Curve("roc", setting, FALSE_RATES, np.interp(FALSE_RATES, receiver.x, receiver.y)))
            numbers[f"AUC {setting}"] = receiver.auc
        if "princeton" in protocols:
            curve = princeton(one, two, truth, symmetry=symmetry, distances=measure, area=area)
            curves.append(Curve("princeton", setting, curve.x, curve.y))
            numbers[f"mean error {setting}"] = curve.mean_error
    if target.symmetry is not None:
        numbers["P(right side)"] = right_side(one, two, truth, symmetry=target.symmetry).share
    return Scores(method, 1, numbers, tuple(curves))


def match_scores(
    method: str,
    source: Sample,
    target: Sample,
    match: IntArray,
    *,
    distances: PairDistances | None = None,
    queries: int | None = None,
) -> Scores:
    """The Princeton protocol for a correspondence: `match` (q,), the target's point for each of the source's points."""
    chosen = query_rows(len(match), queries)
    truth = _part(truth_between(source, target), chosen)
    measure = distances if distances is not None else PairDistances(target.shape)
    area = surface_area(target.shape)
    numbers, curves = {}, []
    count = target.shape.vertex_count
    for setting, symmetry in _settings(target):
        chart = symmetry if symmetry is not None else np.arange(count)
        errors = match_errors(match[chosen], truth, symmetry=chart, distances=measure, area=area)
        curve = princeton_curve(errors, symmetric=symmetry is not None)
        curves.append(Curve("princeton", setting, curve.x, curve.y))
        numbers[f"mean error {setting}"] = curve.mean_error
    return Scores(method, 1, numbers, tuple(curves))


def averaged(scores: Sequence[Scores]) -> Scores:
    """Mean over pairs of shapes of one method's scores; numbers and curves (p,) that all of them have.

    Raises ParameterError if there are none, or they belong to different methods.
    """
    if len({score.method for score in scores}) != 1:
        raise ParameterError("scores must be those of one method, at least one pair, to be averaged.")
    first = scores[0]
    weights = np.array([score.pairs for score in scores], dtype=np.float64)
    shared = [name for name in first.numbers if all(name in score.numbers for score in scores)]
    numbers = {name: float(np.average([score.numbers[name] for score in scores], weights=weights)) for name in shared}
    curves = tuple(
        Curve(
            curve.protocol,
            curve.setting,
            curve.x,
            np.average([score.curve(curve.protocol, curve.setting).y for score in scores], axis=0, weights=weights),
        )
        for curve in first.curves
    )
    return Scores(first.method, int(weights.sum()), numbers, curves)


def query_rows(count: int, queries: int | None) -> IntArray:
    """Which of `count` points are asked for: all, or `queries` spread evenly: (q,)."""
    if queries is None or queries >= count:
        return np.arange(count)
    return np.unique(np.linspace(0, count - 1, queries).astype(np.int64))


def _settings(target: Sample) -> list[tuple[str, IntArray | None]]:
    if target.symmetry is None:
        return [("asymmetric", None)]
    return [("symmetric", target.symmetry), ("asymmetric", None)]


def _part(truth: SurfacePoints, rows: IntArray) -> SurfacePoints:
    return SurfacePoints(truth.corners[rows], truth.weights[rows])
