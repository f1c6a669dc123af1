"""What descriptors say about points: which are alike, and which are mistaken for their mirror image."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

BEST = 5
"""Places that are marked and listed."""
APART = 0.05
"""Distance between two of them, in geodesic diameters: neighbours of the best place are no news."""
SAMPLES = 400
BLOCK = 4_000_000
"""Numbers compared at a time: 16 MB."""


def distance_map(descriptors: NDArray[np.floating], point: NDArray[np.floating]) -> FloatArray:
    """(n,): Euclidean distance of each row of `descriptors` (n, d) to `point` (d,), as in the paper's Figure 6."""
    return _lengths(descriptors, lambda rows: point)


def _lengths(descriptors: NDArray[np.floating], others: Callable[[slice], NDArray[np.floating]]) -> FloatArray:
    """(n,) of the differences to `others`, given for a slice of rows: wide descriptors are not copied whole."""
    lengths = np.empty(len(descriptors))
    step = max(1, BLOCK // max(descriptors.shape[1], 1))
    for low in range(0, len(descriptors), step):
        rows = slice(low, low + step)
        gaps = descriptors[rows] - others(rows)
        lengths[rows] = np.einsum("nd,nd->n", gaps, gaps, dtype=np.float64)
    return np.sqrt(lengths)


def best_places(distances: FloatArray, vertices: FloatArray, *, count: int = BEST, apart: float = APART) -> IntArray:
    """The `count` vertices of least distance (n,), the best first, each at least `apart` from those before it.

    vertices : (n, 3). Straight ways through the body count: that is enough to keep neighbours apart.
    """
    left = np.array(distances, dtype=np.float64)
    found: list[int] = []
    for _ in range(count):
        nearest = int(np.argmin(left))
        if not np.isfinite(left[nearest]):
            break
        found.append(nearest)
        left[((vertices - vertices[nearest]) ** 2).sum(axis=1) < apart**2] = np.inf
    return np.array(found, dtype=np.int64)


def ambiguity(descriptors: NDArray[np.floating], symmetry: IntArray) -> FloatArray:
    """(n,): distance of each vertex to its mirror image in `descriptors` (n, d), ÷ the median distance of two points.

    symmetry : (n,) the mirror image of every vertex. 0: taken for its mirror image; 1: told apart as well as any two
    points. Vertices that are their own image get NaN: there is nothing to tell apart.
    """
    own = _lengths(descriptors, lambda rows: descriptors[symmetry[rows]])
    own[symmetry == np.arange(len(symmetry))] = np.nan
    return own / max(median_distance(descriptors), np.finfo(np.float64).tiny)


def median_distance(descriptors: NDArray[np.floating], *, samples: int = SAMPLES) -> float:
    """Median distance of two different points, from pairs of rows spread evenly over `descriptors` (n, d)."""
    rows = np.unique(np.linspace(0, len(descriptors) - 1, min(samples, len(descriptors))).astype(np.int64))
    some = np.asarray(descriptors[rows], dtype=np.float64)
    squares = (some**2).sum(axis=1)
    squared = np.maximum(squares[:, None] + squares[None, :] - 2.0 * some @ some.T, 0.0)
    return float(np.sqrt(np.median(squared[np.triu_indices(len(some), 1)]))) if len(some) > 1 else 0.0
