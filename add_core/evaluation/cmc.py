"""Cumulative match characteristic: is the true point among the k nearest descriptors?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .._check import BoolArray, FloatArray, IntArray, count_in, read_only
from .blocks import checked_descriptors, distance_blocks
from .truth import SurfacePoints, Truth


@dataclass(frozen=True, eq=False)
class CumulativeMatch:
    """Probability y that the true point is among the x nearest in descriptor space.

    x : (k,), ranks 1 … k. y : (k,), from 0 to 1, ascending. symmetric : whether the mirror image counts as true.
    """

    x: FloatArray
    y: FloatArray
    symmetric: bool

    @property
    def headline(self) -> float:
        """CMC@1: the share of points whose nearest descriptor is the true one."""
        return float(self.y[0])

    def at(self, rank: int) -> float:
        """CMC@`rank`, from 0 to 1. Raises ParameterError if the curve ends before."""
        return float(self.y[count_in("rank", rank, 1, len(self.y)) - 1])


def cmc(
    queries: ArrayLike,
    targets: ArrayLike,
    truth: ArrayLike | SurfacePoints,
    *,
    symmetry: ArrayLike | None = None,
    ranks: int = 100,
) -> CumulativeMatch:
    """Cumulative match characteristic of descriptors, for ranks 1 to `ranks` (or as many as there are targets).

    queries : (q, d), descriptors of the points to be found. targets : (n, d), of the points among which.
    truth : (q,), the target vertex that each query truly is; −1 leaves it out. Or `SurfacePoints`, whose nearest
        corner counts.
    symmetry : (n,), the mirror image of each target vertex. With it the true vertex **or** its mirror image counts.

    Ties count as their expectation under random order: with a constant descriptor y is k/n, chance exactly.
    Raises ParameterError if arrays do not fit together or a descriptor is not finite.
    """
    one, two = checked_descriptors(queries, targets)
    known = Truth.of(truth, symmetry, queries=len(one), targets=len(two))
    true, mirror = known.vertex, known.mirror
    length = min(count_in("ranks", ranks, 1, 10**9), len(two))
    total = np.zeros(length)
    for block, distances in distance_blocks(one, two, known.rows):
        row = np.arange(len(block))
        to_true, to_mirror = distances[row, true[block]], distances[row, mirror[block]]
        wanted = np.minimum(to_true, to_mirror)
        nearer = np.count_nonzero(distances < wanted[:, None], axis=1)
        equal = np.count_nonzero(distances == wanted[:, None], axis=1)
        either = (to_true == to_mirror) & (true[block] != mirror[block])
        total += _hit_probability(nearer, equal, either, length).sum(axis=0)
    ranked = np.arange(1.0, length + 1)
    return CumulativeMatch(read_only(ranked), read_only(total / len(known.rows)), symmetry is not None)


def _hit_probability(nearer: IntArray, equal: IntArray, either: BoolArray, length: int) -> FloatArray:
    """(b, k): probability that a wanted point is among the k first, its `equal` peers standing in random order.

    Where two of the peers are wanted (`either`), both have to be missed: (E−m)(E−m−1)/(E(E−1)) of the orders do.
    """
    drawn = np.clip(np.arange(1, length + 1) - nearer[:, None], 0, equal[:, None])  # m of E peers are within rank k
    left = equal[:, None] - drawn
    one = drawn / equal[:, None]
    pairs = np.maximum(equal * (equal - 1), 1)[:, None]
    both = 1.0 - left * (left - 1) / pairs
    return np.asarray(np.where(either[:, None], both, one))
