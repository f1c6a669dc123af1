"""The Princeton protocol: how far from the truth, along the surface, do matches land?"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, IntArray, count_in, index_array, instance_of, numbers, positive, read_only
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh
from ..geometry.pair_distances import PairDistances
from .blocks import checked_descriptors, distance_blocks
from .truth import SurfacePoints, Truth

Lengths = Callable[[IntArray, IntArray], FloatArray]
"""Geodesic distances of pairs: two (p,) arrays of target vertices to (p,) lengths."""

RADII = np.linspace(0.0, 0.3, 101)
"""The customary radii, divided by the root of the target's area: 0 to 0.3 in 100 steps."""
SIDES = ((0, 1), (1, 2), (2, 0))
MOST_TIES = 64
"""Equally near matches of one point that are looked at; more are drawn from at random, with a fixed seed."""


@dataclass(frozen=True, eq=False)
class PrincetonCurve:
    """Share y of matches within geodesic radius x of the truth.

    x : (r,), radius ÷ √area of the target, dimensionless. y : (r,), from 0 to 1, ascending.
    symmetric : whether the distance to the mirror image counts where that is smaller.
    mean_error : mean geodesic distance ÷ √area, over all matches, however far; inf if some land on another component.
    """

    x: FloatArray
    y: FloatArray
    symmetric: bool
    mean_error: float

    @property
    def headline(self) -> float:
        """Mean of the curve over its radii: its normalised area, 1 for perfect matches."""
        return float(np.trapezoid(self.y, self.x) / (self.x[-1] - self.x[0])) if len(self.x) > 1 else float(self.y[0])

    @property
    def exact(self) -> float:
        """Share of matches that hit the true point itself: the curve at radius 0."""
        return float(self.y[0])


def princeton(
    queries: ArrayLike,
    targets: ArrayLike,
    truth: ArrayLike | SurfacePoints,
    *,
    symmetry: ArrayLike | None = None,
    shape: TriangleMesh | PointCloud | None = None,
    distances: ArrayLike | Lengths | None = None,
    area: float | None = None,
    radii: ArrayLike = RADII,
) -> PrincetonCurve:
    """Princeton protocol for nearest-neighbour matches in descriptor space (Kim, Lipman & Funkhouser 2011).

    queries, targets, truth, symmetry : as for `cmc`; in the symmetric setting the smaller of the geodesic distances
        to the true point and to its mirror image counts. `SurfacePoints` are measured where they lie, not at a vertex.
    shape : the target shape, on which geodesic distances are measured (`PairDistances`) and whose area normalises them.
    distances : in their place, the (n, n) table of the target's geodesic distances, or a function of two index arrays
        (p,); then `area` (length²) is needed too, unless `shape` gives it.
    radii : (r,), ascending, dimensionless: multiples of √area.

    Equally near matches count by equal shares: a constant descriptor scores as a random match would.
    Raises ParameterError if arrays do not fit together, a descriptor is not finite, or distances or area are missing.
    """
    one, two = checked_descriptors(queries, targets)
    known = Truth.of(truth, symmetry, queries=len(one), targets=len(two))
    lengths, root = _measure(shape, distances, area, len(two))
    radii = _checked_radii(radii)
    every = isinstance(lengths, _Table)
    random = np.random.default_rng(0)
    found = []
    for block, squared in distance_blocks(one, two, known.rows):
        row, target = np.nonzero(squared == squared.min(axis=1, keepdims=True))
        counts = np.bincount(row, minlength=len(block))
        if not every and counts.max() > MOST_TIES:
            row, target = _drawn(row, target, counts, random)
            counts = np.bincount(row, minlength=len(block))
        found.append(_curve_counts(known, block[row], target, 1.0 / counts[row], lengths, root, radii))
    return _assembled(found, len(known.rows), radii, symmetric=symmetry is not None)


def match_errors(
    matches: ArrayLike,
    truth: ArrayLike | SurfacePoints,
    *,
    symmetry: ArrayLike | None = None,
    shape: TriangleMesh | PointCloud | None = None,
    distances: ArrayLike | Lengths | None = None,
    area: float | None = None,
) -> FloatArray:
    """Geodesic error ÷ √area of each match: (q,), NaN where the truth is unknown.

    matches : (q,), the target vertex that each point was matched to, by whatever method. The rest is as for
        `princeton`;
        `symmetry` (n,) sets the number of target vertices where neither `shape` nor a table does.
    Raises ParameterError as `princeton` does.
    """
    count = _target_count(shape, distances, symmetry)
    target = index_array("matches", matches, count)
    known = Truth.of(truth, symmetry, queries=len(target), targets=count)
    lengths, root = _measure(shape, distances, area, count)
    errors = np.full(len(target), np.nan)
    errors[known.rows] = _errors(known, np.arange(len(known.rows)), target[known.rows], lengths) / root
    return errors


def princeton_curve(errors: ArrayLike, *, radii: ArrayLike = RADII, symmetric: bool = False) -> PrincetonCurve:
    """The curve of given errors (q,), ÷ √area as from `match_errors`; NaN is left out.

    radii : (r,), ascending, in the errors' unit. symmetric : what the errors are of, said along with the curve.
    Raises ParameterError if no error is known or the radii do not ascend.
    """
    values, reach = numbers("errors", errors).ravel(), _checked_radii(radii)
    values = values[~np.isnan(values)]
    if not len(values):
        raise ParameterError("errors must be known for at least one point, but they are NaN for all.")
    within = (values[:, None] <= reach).sum(axis=0) / len(values)
    return PrincetonCurve(read_only(reach), read_only(within), symmetric, float(values.mean()))


def _checked_radii(radii: ArrayLike) -> FloatArray:
    array = np.atleast_1d(numbers("radii", radii)).copy()
    if array.ndim != 1 or not array.size or not (array[0] >= 0 and (np.diff(array) > 0).all()):
        raise ParameterError("radii must be a list of numbers that ascend from 0 or more, but they are not.")
    return array


class _Table:
    def __init__(self, table: FloatArray) -> None:
        self._table = table

    def __call__(self, first: IntArray, second: IntArray) -> FloatArray:
        return np.asarray(self._table[first, second])


def _target_count(shape: object, distances: object, symmetry: ArrayLike | None) -> int:
    if isinstance(shape, TriangleMesh | PointCloud):
        return shape.vertex_count
    if distances is not None and not callable(distances):
        return len(np.asarray(distances))
    if symmetry is not None:
        return len(np.asarray(symmetry))
    raise ParameterError(
        "shape must be given, or distances as a table: nothing says how many target vertices there are."
    )


def _measure(
    shape: TriangleMesh | PointCloud | None, distances: ArrayLike | Lengths | None, area: float | None, count: int
) -> tuple[Lengths, float]:
    """How to measure pairs of target vertices, and √area."""
    if shape is not None:
        instance_of("shape", shape, TriangleMesh, PointCloud)
    if area is None:
        if shape is None:
            raise ParameterError("area must be given along with distances, or the target as shape: errors are ÷ √area.")
        area = surface_area(shape)
    root = float(np.sqrt(positive("area", area)))
    if shape is not None:
        count_in("the vertices of shape", shape.vertex_count, count, count)
    if callable(distances):
        return distances, root
    if distances is not None:
        table = numbers("distances", distances)
        if table.shape != (count, count):
            raise ParameterError(f"distances must have shape ({count}, {count}), but it has {table.shape}.")
        if not (table >= 0).all():
            raise ParameterError("distances must be lengths, inf between components, but some are negative or NaN.")
        return _Table(table), root
    if shape is None:
        raise ParameterError("distances must be given, or the target as shape: matches are judged along the surface.")
    return PairDistances(shape), root


def surface_area(shape: TriangleMesh | PointCloud) -> float:
    """Area of a mesh, or of the surface that a cloud samples, length²."""
    if isinstance(shape, TriangleMesh):
        return shape.area
    from ..operators import AnisotropicLaplacian

    return float(AnisotropicLaplacian(shape, alpha=0.0).mass.sum())


def _errors(known: Truth, row: IntArray, target: IntArray, lengths: Lengths) -> FloatArray:
    direct = _to_points(known.points, row, target, lengths)
    if known.mirrored is None:
        return direct
    return np.minimum(direct, _to_points(known.mirrored, row, target, lengths))


def _to_points(points: SurfacePoints, row: IntArray, target: IntArray, lengths: Lengths) -> FloatArray:
    """(p,): distances from targets to points inside faces, exact if the way to the face's corners unfolds flat.

    In the plane ‖m − Σ w_j c_j‖² = Σ w_j ‖m − c_j‖² − Σ_{a<b} w_a w_b ‖c_a − c_b‖².
    """
    corners, weights = points.corners[row], points.weights[row]
    nearest = points.nearest[row]
    result = np.array(lengths(nearest, target), dtype=np.float64)
    inside = np.flatnonzero((weights.max(axis=1) < 1.0) & np.isfinite(result))
    if len(inside):
        c, w, m = corners[inside], weights[inside], target[inside]
        squared = np.sum([w[:, j] * lengths(c[:, j], m) ** 2 for j in range(3)], axis=0)
        squared -= np.sum([w[:, a] * w[:, b] * lengths(c[:, a], c[:, b]) ** 2 for a, b in SIDES], axis=0)
        result[inside] = np.sqrt(np.maximum(squared, 0.0))
    return result


def _drawn(row: IntArray, target: IntArray, counts: IntArray, random: np.random.Generator) -> tuple[IntArray, IntArray]:
    """At most MOST_TIES of each row's targets, drawn at random."""
    shuffled = random.permutation(len(row))
    order = shuffled[np.argsort(row[shuffled], kind="stable")]
    place = np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts)
    kept = np.sort(order[place < MOST_TIES])
    return row[kept], target[kept]


@dataclass(frozen=True, eq=False)
class _Counts:
    within: FloatArray
    error: float


def _curve_counts(
    known: Truth, row: IntArray, target: IntArray, weight: FloatArray, lengths: Lengths, root: float, radii: FloatArray
) -> _Counts:
    errors = _errors(known, row, target, lengths) / root
    order = np.argsort(errors)
    reached = np.concatenate([[0.0], np.cumsum(weight[order])])
    within = reached[np.searchsorted(errors[order], radii, side="right")]
    return _Counts(within, float((weight * errors).sum()))


def _assembled(found: list[_Counts], count: int, radii: FloatArray, *, symmetric: bool) -> PrincetonCurve:
    within = np.sum([part.within for part in found], axis=0) / count
    error = sum(part.error for part in found) / count
    return PrincetonCurve(read_only(radii), read_only(np.minimum(within, 1.0)), symmetric, error)
