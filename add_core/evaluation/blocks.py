"""Distances between descriptors, a block of query points at a time: never the whole table."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial.distance import cdist

from .._check import FloatArray, IntArray, descriptor_array
from ..correspondence.nearest import without_unit
from ..errors import ParameterError

BLOCK = 2_000_000
"""Distances in one block: 16 MB, and a few copies of that while it is worked on."""
WIDEST_DIRECT = 64
"""Descriptors with more numbers are compared by matrix products, ten times faster and exact to 2⁻²¹ of their spread."""


def checked_descriptors(queries: object, targets: object) -> tuple[FloatArray, FloatArray]:
    """Queries (q, d) and targets (n, d) as finite float64 arrays of one width; ParameterError otherwise."""
    one = descriptor_array("queries", queries)  # type: ignore[arg-type]
    two = descriptor_array("targets", targets, width=one.shape[1])  # type: ignore[arg-type]
    if len(two) < 2:
        raise ParameterError("targets must hold at least two points to tell apart, but it holds one.")
    return one, two


def distance_blocks(queries: FloatArray, targets: FloatArray, rows: IntArray) -> Iterator[tuple[IntArray, FloatArray]]:
    """Yield (positions in `rows`, squared distances (b, n) of those queries to all targets), block by block.

    Equal descriptors are equally far, to the last bit, whichever block they come in: ties are decided by the
    descriptors, not by rounding. The unit is arbitrary but the same for all blocks.
    """
    one, two = without_unit(queries, targets)
    step = max(1, BLOCK // len(targets))
    measure = _Direct(one, two) if one.shape[1] <= WIDEST_DIRECT else _ByProducts(one, two)
    for low in range(0, len(rows), step):
        positions = np.arange(low, min(low + step, len(rows)))
        yield positions, measure(rows[positions])


class _Direct:
    def __init__(self, queries: FloatArray, targets: FloatArray) -> None:
        self._queries, self._targets = queries, targets

    def __call__(self, rows: IntArray) -> FloatArray:
        return np.asarray(cdist(self._queries[rows], self._targets, "sqeuclidean"))


class _ByProducts:
    """‖a − b‖² = ‖a‖² + ‖b‖² − 2 a·b about the middle of the targets, rounded to a grid coarser than its errors."""

    def __init__(self, queries: FloatArray, targets: FloatArray) -> None:
        middle = targets.mean(axis=0)
        self._queries, self._targets = queries - middle, targets - middle
        self._lengths = (self._queries**2).sum(axis=1), (self._targets**2).sum(axis=1)
        raw = max(float((queries**2).sum(axis=1).max()), float((targets**2).sum(axis=1).max()))
        spread = max(float(lengths.max()) for lengths in self._lengths)
        self._grid = 2.0**-42 * spread + 2.0**-90 * raw or 1.0

    def __call__(self, rows: IntArray) -> FloatArray:
        squared = self._queries[rows] @ self._targets.T
        squared *= -2.0
        squared += self._lengths[0][rows, None]
        squared += self._lengths[1][None, :]
        squared /= self._grid
        np.rint(squared, out=squared)
        return np.asarray(np.maximum(squared, 0.0))
