"""Nearest neighbours of a cloud's points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Neighbours:
    """The k nearest neighbours of every point, nearest first, the point itself left out.

    indices : (n, k) int64. distances : (n, k), in the cloud's own unit.
    """

    indices: IntArray
    distances: FloatArray

    @property
    def lengths(self) -> csr_array:
        """(n, n): a graph of distances between neighbours, to be read as undirected; duplicates are 0 apart."""
        n, k = self.indices.shape
        i, j, d = np.repeat(np.arange(n), k), self.indices.ravel(), self.distances.ravel()
        low, high = np.minimum(i, j), np.maximum(i, j)
        # A stored zero means "no edge" to nobody here: csgraph keeps explicit zeros of sparse input.
        order = np.unique(low * n + high, return_index=True)[1]
        return csr_array(coo_array((d[order], (low[order], high[order])), shape=(n, n)))


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
