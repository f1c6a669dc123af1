"""The Delaunay triangles around the centre of many small planar point sets at once."""

from __future__ import annotations

import numpy as np

from .._check import BoolArray, FloatArray, IntArray

WIDEST_ANGLE = np.radians(165.0)
"""Triangles with a wider angle are left out. They lie along boundaries, where rounding decides whether points on a
line form a
corner, and hold next to no area but stiffness without bound."""
_TURN_BACK = 1e-12  # radians: a turn backwards by less is rounding of a straight line


def delaunay_stars(plane: FloatArray, usable: BoolArray, weights: FloatArray) -> IntArray:
    r"""Triangles of the Delaunay triangulation of {0} ∪ plane[i, usable[i]] that touch 0, for every row i.

    A neighbour p is Delaunay if its bisector bounds the Voronoi cell of 0, that is, if q = p/|p|² is a corner of
    the convex hull of all q and 0. The hulls of all rows are wrapped in step, each from its nearest neighbour on,
    counter-clockwise. Where 0 is a corner itself the star is open: 0 lies on the boundary.

    plane : (n, k, 2). usable : (n, k). weights : (n, k), added to |p|², so small that they only break ties of
        points on one
    circle: the same ones for a point in all rows keep those rows' triangulations consistent.
    Returns (t, 3): row, first and second neighbour (columns), counter-clockwise about the centre.
    """
    n, k, _ = plane.shape
    squared = (plane**2).sum(axis=2)
    usable = usable & (squared > 0)
    power = np.maximum(squared + weights, squared / 2)
    inverse = np.zeros((n, k + 1, 2))  # the last column is the centre
    np.divide(plane, power[:, :, None], out=inverse[:, :k], where=usable[:, :, None])
    allowed = np.concatenate([usable, np.ones((n, 1), dtype=bool)], axis=1)
    if k == 0:
        return np.empty((0, 3), dtype=np.int64)
    start = np.where(usable, (inverse[:, :k] ** 2).sum(axis=2), -1.0).argmax(axis=1)
    active = np.flatnonzero(usable.any(axis=1))
    current = start.copy()
    # The farthest q is a corner, and the hull lies behind the line through it across its direction.
    heading = np.stack([-inverse[np.arange(n), start, 1], inverse[np.arange(n), start, 0]], axis=1)
    found = [np.empty((0, 3), dtype=np.int64)]
    for _ in range(k + 1):
        if not len(active):
            break
        here = current[active]
        following, heading[active] = _next_corners(inverse[active], allowed[active], here, heading[active])
        triangle = (here < k) & (following < k)
        found.append(np.stack([active, here, following], axis=1)[triangle])
        current[active] = following
        active = active[following != start[active]]
    return _without_slivers(np.concatenate(found), plane)


def _next_corners(
    inverse: FloatArray, allowed: BoolArray, here: IntArray, heading: FloatArray
) -> tuple[IntArray, FloatArray]:
    """The next corner of each hull, counter-clockwise: the one that asks for the smallest turn; and the direction
    to it."""
    rows = np.arange(len(here))
    step = inverse - inverse[rows, here][:, None]
    across = heading[:, None, 0] * step[:, :, 1] - heading[:, None, 1] * step[:, :, 0]
    turn = np.arctan2(across, np.einsum("ni,nki->nk", heading, step))
    turn[turn < -_TURN_BACK] += 2 * np.pi
    turn[~allowed | ~step.any(axis=2)] = np.inf  # the corner itself, and whatever is projected onto it
    following = turn.argmin(axis=1)
    return following, step[rows, following]


def _without_slivers(stars: IntArray, plane: FloatArray) -> IntArray:
    row, first, second = stars.T
    a, b = plane[row, first], plane[row, second]
    positive = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0
    widest = np.minimum(np.minimum(_cosine(a, b), _cosine(-a, b - a)), _cosine(-b, a - b))
    return np.asarray(stars[positive & (widest > np.cos(WIDEST_ANGLE))])


def _cosine(a: FloatArray, b: FloatArray) -> FloatArray:
    length = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    return np.asarray((a * b).sum(axis=1) / np.maximum(length, np.finfo(float).tiny))
