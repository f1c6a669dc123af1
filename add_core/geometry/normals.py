"""Normals of point clouds: planes fitted by total least squares, turned outward together."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

from .._check import FloatArray, IntArray
from .enclosure import enclosure
from .neighbours import Neighbours, nearest_neighbours, undirected
from .tetrahedra import Tetrahedra

BALL_NEIGHBOURS = 12
"""The ε-ball of a point reaches to this one of its nearest neighbours: ε follows the density of the cloud."""
PROPAGATION_NEIGHBOURS = 14
"""Neighbours that a point's orientation may come from."""
NEXT = 3.0
"""Two pieces lie next to each other if they are less than this many times as far apart as the neighbours of a point
reach."""
DOUBT = 0.005
"""Share of the pairs of neighbours whose normals contradict each other above which sheets touch or are thin."""
GAP, OPEN_SHARE = 3.0, 0.04
"""A triangle of the border of an enclosure closes a gap if the circle through its corners is this many times as large
as points are apart there. Of a closed piece with points enough to tell what it encloses, less than this share does."""
STEEPEST, LEAST_AGREEMENT = 0.6, 0.5
"""Sine between a chord and either tangent plane, and reflected cosine of the normals, of points on one sheet."""
NOISE = 3.0
"""Angle between a fitted normal and that of the enclosure, over the median of all, below which noise explains it."""


def estimate_normals(points: FloatArray) -> FloatArray:
    """Unit normals (n, 3) of points that lie in different places, outward on every closed piece.

    Each is the direction in which the points of its ε-ball spread least (total least squares), nearer points
    counting more. One orientation spreads over each connected piece of the neighbourhood graph, along a minimum
    spanning tree that prefers short steps along the surface; the piece is then turned so that its normals point
    out of it (their flux is positive). A plane has no outside: there the sign is arbitrary, but always the same.

    Where neighbours then disagree, sheets touch, as two thighs or a hand and a hip do, or are thin, as fingers are;
    and where pieces lie next to each other, balls are too small, as along a tail that consists of rings of points. If
    such a body is closed, its `enclosure` says which side of a point is outside and which points of its ball lie on the
    same sheet.
    """
    if len(points) < 2:
        return np.tile([0.0, 0.0, 1.0], (len(points), 1))
    nearest = nearest_neighbours(points, PROPAGATION_NEIGHBOURS)
    fitted = _fitted_normals(points, nearest, nearest.ball_weights(BALL_NEIGHBOURS))
    tree = minimum_spanning_tree(undirected(nearest.indices, _reluctance(points, fitted, nearest)))
    pieces = connected_components(tree, directed=False)[1].astype(np.int64)
    normals = _oriented(points, fitted, nearest, tree, pieces)
    doubt = _contradicted(points, normals, nearest)
    bodies = _bodies(points, pieces, nearest)
    for body in range(bodies.max() + 1):
        members = bodies == body
        if doubt[members].mean() > DOUBT or np.ptp(pieces[members]) > 0:
            normals[members] = _sheets_apart(points[members], normals[members])
    return normals


def reflected_cosines(directions: FloatArray, normals: FloatArray, others: FloatArray) -> FloatArray:
    """Cosines between `others` and `normals` mirrored at the plane halfway along unit `directions`; arrays (..., 3).

    Mirroring carries a normal along a chord of any circle exactly, round any bend and to the opposite wall of a
    gap or a limb: 1 says the two normals belong to one surface, −1 that one of them is turned inside out.
    """
    along = np.einsum("...i,...i->...", directions, normals) * np.einsum("...i,...i->...", directions, others)
    return np.asarray(np.einsum("...i,...i->...", normals, others) - 2 * along)


def _bodies(points: FloatArray, pieces: IntArray, nearest: Neighbours) -> IntArray:
    """(n,): `pieces`, those joined that lie next to each other, as the rings do of which a tail may be made."""
    tetrahedra = Tetrahedra.between(points) if pieces.any() else None
    if tetrahedra is None:
        return pieces
    ends = tetrahedra.corners[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]].reshape(-1, 2)
    ends = ends[pieces[ends[:, 0]] != pieces[ends[:, 1]]]
    length = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    joined = pieces[ends[length < NEXT * nearest.distances[ends, -1].max(axis=1)]]
    count = int(pieces.max()) + 1
    links = coo_array((np.ones(len(joined)), (joined[:, 0], joined[:, 1])), shape=(count, count))
    return connected_components(links, directed=False)[1].astype(np.int64)[pieces]


def _sheets_apart(points: FloatArray, normals: FloatArray) -> FloatArray:
    """(n, 3), unit: normals by what the points enclose, or the `normals` if they are open or too few to tell."""
    tetrahedra = Tetrahedra.between(points)
    if tetrahedra is None:
        return normals
    nearest = nearest_neighbours(points, BALL_NEIGHBOURS)
    border = enclosure(tetrahedra)
    spacing = nearest.distances[:, :6].mean(axis=1) / tetrahedra.scale
    gap = border.radii > GAP * spacing[border.facets].max(axis=1)
    if border.areas @ gap > OPEN_SHARE * border.areas.sum():
        return normals
    passed = (border.normals == 0).all(axis=1, keepdims=True)
    return _refitted(points, np.where(passed, normals, border.normals), nearest)


def _refitted(points: FloatArray, normals: FloatArray, nearest: Neighbours) -> FloatArray:
    """(n, 3): planes fitted to the neighbours on the same sheet as `normals` tell, where these planes are about theirs.

    Fitting evens out noise. In folds and at the tips of fingers, where the fit differs, the normals are kept.
    """
    other = normals[nearest.indices]
    here = np.broadcast_to(normals[:, None], other.shape)
    directions = nearest.directions(points)
    heights = np.einsum("nki,nki->nk", directions, here), np.einsum("nki,nki->nk", directions, other)
    beside = np.maximum(np.abs(heights[0]), np.abs(heights[1])) < STEEPEST
    beside &= reflected_cosines(directions, here, other) > LEAST_AGREEMENT
    beside &= np.einsum("nki,nki->nk", here, other) > 0
    fitted = _fitted_normals(points, nearest, nearest.ball_weights(BALL_NEIGHBOURS) * beside)
    cosine = np.einsum("ni,ni->n", fitted, normals)
    turn = np.arccos(np.minimum(np.abs(cosine), 1.0))
    better = (turn < NOISE * np.median(turn)) & (np.count_nonzero(beside, axis=1) >= 4)
    return np.where(better[:, None], np.sign(cosine)[:, None] * fitted, normals)


def _fitted_normals(points: FloatArray, nearest: Neighbours, weight: FloatArray) -> FloatArray:
    offset = points[nearest.indices[:, :BALL_NEIGHBOURS]] - points[:, None]
    mean = np.einsum("nk,nki->ni", weight, offset) / (1.0 + weight.sum(axis=1))[:, None]  # the point itself weighs 1
    centred = offset - mean[:, None]
    spread = np.einsum("nk,nki,nkj->nij", weight, centred, centred) + mean[:, :, None] * mean[:, None, :]
    scale = np.maximum(np.einsum("nii->n", spread), np.finfo(float).tiny)
    return np.asarray(np.linalg.eigh(spread / scale[:, None, None])[1][:, :, 0])


def _oriented(
    points: FloatArray, normals: FloatArray, nearest: Neighbours, tree: csr_array, pieces: IntArray
) -> FloatArray:
    """The normals, turned as the `tree` says, and outward on each of the `pieces` (n,) that it connects."""
    sign = np.ones(len(points))
    for piece in range(pieces.max() + 1):
        members = np.flatnonzero(pieces == piece)
        _propagate(sign, tree, int(members[0]), points, normals)
        middle = points[members] - points[members].mean(axis=0)
        area = nearest.distances[members].max(axis=1) ** 2
        flux = area @ (sign[members] * np.einsum("ni,ni->n", middle, normals[members]))
        if flux < 0:
            sign[members] *= -1
    return np.asarray(sign[:, None] * normals)


def _contradicted(points: FloatArray, normals: FloatArray, nearest: Neighbours) -> FloatArray:
    """(n,): the share of each point's neighbours whose normals are turned against its own."""
    other = normals[nearest.indices]
    here = np.broadcast_to(normals[:, None], other.shape)
    return np.asarray((reflected_cosines(nearest.directions(points), here, other) < 0).mean(axis=1))


def _reluctance(points: FloatArray, normals: FloatArray, nearest: Neighbours) -> FloatArray:
    """(n, k), > 0: how little the orientation of a point says about its neighbour's."""
    direction = nearest.directions(points)
    other = normals[nearest.indices]
    here = np.broadcast_to(normals[:, None], other.shape)
    bend = 1 - np.abs(reflected_cosines(direction, here, other))
    height = np.einsum("nki,nki->nk", direction, here) ** 2 + np.einsum("nki,nki->nk", direction, other) ** 2
    spacing = nearest.distances[:, min(3, nearest.indices.shape[1] - 1), None]
    return np.asarray(1e-3 + bend + 0.3 * height + 0.1 * nearest.distances / spacing)


def _propagate(sign: FloatArray, tree: csr_array, root: int, points: FloatArray, normals: FloatArray) -> None:
    order, before = breadth_first_order(tree, root, directed=False)
    after: IntArray = order[1:].astype(np.int64)
    parent = before[after]
    direction = points[after] - points[parent]
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    agree = np.where(reflected_cosines(direction, normals[parent], normals[after]) < 0, -1.0, 1.0)
    for child, origin, factor in zip(after, parent, agree, strict=True):
        sign[child] = factor * sign[origin]
