"""Nearest neighbours of a cloud's points, and points that lie in one place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray, read_only

ONE_PLACE = 1e-9
"""Points nearer than this share of the cloud's extent lie in one place: no direction leads from one to the other."""


@dataclass(frozen=True, eq=False)
class Neighbours:
    """The k nearest neighbours of every point, nearest first, the point itself left out.

    indices : (n, k) int64. distances : (n, k), in the cloud's own unit.
    """

    indices: IntArray
    distances: FloatArray

    def directions(self, points: FloatArray) -> FloatArray:
        """(n, k, 3), unit: from the `points` to their neighbours."""
        return np.asarray((points[self.indices] - points[:, None]) / self.distances[:, :, None])

    def ball_weights(self, count: int) -> FloatArray:
        """(n, count): 1 − d²/ε² of the nearest neighbours at distance d, ε as far as the last of them.

        The ball's border weighs nothing, so it does not matter which of several points there come last.
        """
        distances = self.distances[:, :count]
        # With hardly any neighbours a border without weight would leave too few: reach past the last one.
        radius = distances[:, -1:] * (1.0 if distances.shape[1] > 4 else 1.5)
        return np.asarray(1.0 - (distances / radius) ** 2)


@dataclass(frozen=True, eq=False)
class DistinctPoints:
    """The places of a cloud, each once.

    first : (d,), the first point at each place, ascending. place : (n,), which place each point is at.
    """

    first: IntArray
    place: IntArray


def nearest_neighbours(points: FloatArray, count: int) -> Neighbours:
    """The `count` nearest neighbours of every point, or all others if there are fewer."""
    n = len(points)
    k = min(count, n - 1)
    found = KDTree(points).query(points, k=np.arange(1, k + 2))
    distances, indices = np.asarray(found[0]), np.asarray(found[1])
    # A duplicate may come before the point itself: drop the point where it is found, the last column where it is not.
    own = indices == np.arange(n)[:, None]
    own[~own.any(axis=1), -1] = True
    return Neighbours(indices[~own].reshape(n, k).astype(np.int64), distances[~own].reshape(n, k))


def undirected(indices: IntArray, values: FloatArray) -> csr_array:
    """(n, n): upper triangle of a graph with the edges i – indices[i, :] and their values (n, k), zeros stored as
    such."""
    n, k = indices.shape
    i, j, value = np.repeat(np.arange(n), k), indices.ravel(), values.ravel()
    low, high = np.minimum(i, j), np.maximum(i, j)
    _, once = np.unique(low * n + high, return_index=True)
    return csr_array(coo_array((value[once], (low[once], high[once])), shape=(n, n)))


def distinct_points(points: FloatArray) -> DistinctPoints:
    """The places of a cloud; points nearer than `ONE_PLACE` of its extent share one, chains of them included."""
    n = len(points)
    reach = ONE_PLACE * float(np.ptp(points, axis=0).max())
    _, place = np.unique(points, axis=0, return_inverse=True)  # exact duplicates first: a thousand are a million pairs
    first = _first_of_each(place.ravel())
    pairs = KDTree(points[first]).query_pairs(reach, output_type="ndarray")
    graph = csr_array((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=(len(first),) * 2)
    joined = connected_components(graph, directed=False)[1].astype(np.int64)[place.ravel()]
    first = np.sort(_first_of_each(joined))
    number = np.empty(n, dtype=np.int64)
    number[joined[first]] = np.arange(len(first))
    return DistinctPoints(read_only(first), read_only(number[joined]))


def _first_of_each(labels: IntArray) -> IntArray:
    return np.asarray(np.unique(labels, return_index=True)[1], dtype=np.int64)
