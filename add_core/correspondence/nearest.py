"""Nearest neighbours between descriptors: the raw matches from which everything else starts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray, descriptor_array, one_of, read_only

BLOCK = 2_000_000
"""Distances held at once: 16 MB."""
WIDEST_TREE = 8
"""Trees search descriptors of up to this many numbers faster than matrix products do."""
PROJECTED, CANDIDATES = 12, 24
"""Principal directions in which an approximate search looks, and matches that it then compares in full."""


@dataclass(frozen=True, eq=False)
class MutualMatches:
    """Pairs of points that are each other's nearest: `queries[k]` and `targets[k]`, both (p,), queries ascending."""

    queries: IntArray
    targets: IntArray


def nearest_matches(queries: ArrayLike, targets: ArrayLike, *, method: str = "exact") -> IntArray:
    """The target nearest to each query in descriptor space (Euclidean): (q,) indices, the lowest of equally near ones.

    queries : (q, d). targets : (n, d). With descriptors of shape 2 as queries and of shape 1 as targets this is
        `match_21`.
    method : "exact" compares with every target, a block at a time (a k-d tree up to 8 numbers a point, matrix
        products beyond, near ties decided by direct subtraction). "approximate" asks a k-d tree of the twelve
        principal directions for 24 candidates and compares only those in full: for hundreds of thousands of wide
        descriptors.
    Raises ParameterError if a descriptor is not finite or widths differ.
    """
    one_of("method", method, ("exact", "approximate"))
    one = descriptor_array("queries", queries)
    two = descriptor_array("targets", targets, width=one.shape[1])
    one, two = without_unit(one, two)
    if method == "approximate" and one.shape[1] > WIDEST_TREE and len(two) > CANDIDATES:
        return _by_projection(one, two)
    if one.shape[1] <= WIDEST_TREE:
        return _by_tree(one, two)
    return _by_products(one, two)


def without_unit(queries: FloatArray, targets: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Both in a unit in which their largest number is about 1, so that squares neither overflow nor vanish.

    The unit is a power of two: nothing is rounded but what is too small to count.
    """
    size = max(float(np.abs(queries).max()), float(np.abs(targets).max()))
    exponent = -int(np.frexp(size)[1])
    return np.ldexp(queries, exponent), np.ldexp(targets, exponent)


def mutual_matches(queries: ArrayLike, targets: ArrayLike, *, method: str = "exact") -> MutualMatches:
    """Pairs that are nearest to each other both ways.

    queries (q, d), targets (n, d), method : as for `nearest_matches`, which also says what is raised.
    """
    forth = nearest_matches(queries, targets, method=method)
    back = nearest_matches(targets, queries, method=method)
    agreeing = np.flatnonzero(back[forth] == np.arange(len(forth)))
    return MutualMatches(read_only(agreeing), read_only(forth[agreeing]))


def _by_tree(queries: FloatArray, targets: FloatArray) -> IntArray:
    # Equal targets go into the tree once, under their lowest number; a second one equally near shows that there may
    # be any number of them.
    distinct, first = np.unique(targets, axis=0, return_index=True)
    tree = KDTree(distinct)
    near, found = tree.query(queries, k=[1, 2])
    distances, places = np.asarray(near), np.asarray(found)
    matches = first[places[:, 0]].astype(np.int64)
    for row in np.flatnonzero(distances[:, 0] == distances[:, 1]):
        tied = np.sort(first[tree.query_ball_point(queries[row], distances[row, 0] * (1 + 1e-12))])
        matches[row] = tied[((targets[tied] - queries[row]) ** 2).sum(axis=1).argmin()]
    return matches


def _by_products(queries: FloatArray, targets: FloatArray) -> IntArray:
    middle = targets.mean(axis=0)
    one, two = queries - middle, targets - middle
    lengths = (two**2).sum(axis=1)
    matches = np.empty(len(one), dtype=np.int64)
    step = max(1, BLOCK // len(two))
    for low in range(0, len(one), step):
        part = one[low : low + step]
        scores = part @ two.T
        scores *= -2.0
        scores += lengths  # ‖b‖² − 2 a·b orders as ‖a − b‖²
        best = scores.min(axis=1)
        # Products err by rounding of the largest terms; whatever lies within that is compared by subtraction.
        error = 1e-13 * (lengths.max() + (part**2).sum(axis=1))
        matches[low : low + step] = scores.argmin(axis=1)
        close = scores <= (best + error)[:, None]
        for row in np.flatnonzero(np.count_nonzero(close, axis=1) > 1):
            tied = np.flatnonzero(close[row])
            exact = ((targets[tied] - queries[low + row]) ** 2).sum(axis=1)
            matches[low + row] = tied[exact.argmin()]
    return matches


def _by_projection(queries: FloatArray, targets: FloatArray) -> IntArray:
    middle = targets.mean(axis=0)
    centred = targets - middle
    directions = np.linalg.eigh(centred.T @ centred)[1][:, : -PROJECTED - 1 : -1]
    _, found = KDTree(centred @ directions).query((queries - middle) @ directions, k=CANDIDATES)
    candidates = np.sort(np.asarray(found, dtype=np.int64), axis=1)
    matches = np.empty(len(queries), dtype=np.int64)
    step = max(1, BLOCK // (CANDIDATES * queries.shape[1]))
    for low in range(0, len(queries), step):
        part = slice(low, low + step)
        gaps = ((targets[candidates[part]] - queries[part, None, :]) ** 2).sum(axis=2)
        matches[part] = np.take_along_axis(candidates[part], gaps.argmin(axis=1)[:, None], axis=1)[:, 0]
    return matches
