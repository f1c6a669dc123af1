"""Counterparts on another meshing: the nearest vertex that it has, seen on one body that both are drawn on."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from .._check import FloatArray, IntArray
from ..errors import ParameterError
from .training_set import PreparedShape

CLUSTER, NEAREST = 5, 16
"""Vertices that are drawn together, and among how many neighbours of the first the others are drawn."""
AROUND = 8
"""Neighbours of a counterpart among which a wrong point is drawn."""


def nearby_pairs(
    one: PreparedShape, two: PreparedShape, positions: FloatArray, count: int, draw: np.random.Generator
) -> tuple[IntArray, IntArray, IntArray]:
    """Vertices (count,) of shape one, their counterparts (count,) on two, and vertices (count // 2,) of two near these.

    positions : (P, 3), where each place is on the one body. Vertices of places from P on, or of none, are not drawn.
    Two shapes of one connectivity have exact counterparts; on others these are off by half an edge, like the answer
    that is asked of a descriptor there. Raises ParameterError for a shape of which no place has a position.
    """
    (known, tree), (others, other_tree) = (_on_body(shape, positions) for shape in (one, two))
    firsts = draw.integers(len(known), size=-(-count // CLUSTER))
    nearest = tree.query(tree.data[firsts], k=min(NEAREST, len(known)))[1].reshape(len(firsts), -1)
    columns = draw.integers(nearest.shape[1], size=(len(firsts), CLUSTER - 1))
    rows = np.concatenate([firsts[:, None], np.take_along_axis(nearest, columns, axis=1)], axis=1).ravel()[:count]
    chosen = known[rows]
    found = np.asarray(other_tree.query(tree.data[rows])[1])
    some = draw.choice(count, count // 2, replace=False)
    around = other_tree.query(other_tree.data[found[some]], k=min(AROUND + 1, len(others)))[1].reshape(len(some), -1)
    wrong = around[np.arange(len(some)), draw.integers(around.shape[1], size=len(some))]
    return np.asarray(chosen), np.asarray(others[found]), np.asarray(others[wrong])


def _on_body(shape: PreparedShape, positions: FloatArray) -> tuple[IntArray, cKDTree]:
    known = np.flatnonzero((shape.places >= 0) & (shape.places < len(positions)))
    if not len(known):
        raise ParameterError(
            f"positions must have a row for some place of {shape.name!r}, but there are only {len(positions)} rows."
        )
    return known, cKDTree(positions[shape.places[known]])
