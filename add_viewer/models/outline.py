"""The few points of a large shape by which cameras are placed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from add_core.geometry.shapes import even_directions

FloatArray = NDArray[np.float64]

DIRECTIONS = 200
"""In which the farthest points are kept; closer together where a shape is flat."""
EVENLY = 4000
"""Points kept besides, to know where in a picture the shape is."""
_FEW = 20_000


def outline_of(vertices: FloatArray) -> FloatArray:
    """(m, 3), some of the vertices (n, 3): those that reach farthest, and a few thousand in between; all if few."""
    if len(vertices) <= _FEW:
        return vertices
    spread = vertices.std(axis=0)
    flattened = even_directions(DIRECTIONS - 6) / np.where(spread > 0, spread, 1.0)
    directions = np.vstack([np.eye(3), -np.eye(3), flattened])
    farthest = np.zeros(DIRECTIONS, dtype=np.int64)
    reach = np.full(DIRECTIONS, -np.inf)
    for low in range(0, len(vertices), _FEW):
        along = vertices[low : low + _FEW] @ directions.T
        best = along.argmax(axis=0)
        value = along[best, np.arange(DIRECTIONS)]
        farthest = np.where(value > reach, best + low, farthest)
        reach = np.maximum(value, reach)
    evenly = np.arange(0, len(vertices), -(-len(vertices) // EVENLY))
    return vertices[np.union1d(farthest, evenly)]
