"""Normals of point clouds: planes fitted by total least squares, turned outward together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

from .._check import BoolArray, FloatArray, IntArray
from .distinct import is_among, sorted_distinct
from .enclosure import Enclosure, enclosure
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


@dataclass(frozen=True, eq=False)
class EstimatedNormals:
    """Normals of points that lie in different places, and between which of them the surface runs.

    normals : (n, 3), unit, outward on every closed piece.
    enclosed : (n,), the points whose normals come from an `enclosure`. sides : the sides of the triangles of its
        border, as numbers low · n + high, ascending.
    """

    normals: FloatArray
    enclosed: BoolArray
    sides: IntArray

    def off_surface(self, ends: IntArray) -> BoolArray:
        """(e,): whether edges (e, 2) between enclosed points leave the border, through the air or the inside."""
        low, high = np.sort(ends, axis=1).T
        return np.asarray(self.enclosed[ends].all(axis=1) & ~is_among(low * len(self.normals) + high, self.sides))


def estimate_normals(points: FloatArray) -> EstimatedNormals:
    """Normals of points (n, 3) in different places.

    Each is the direction in which the points of its ε-ball spread least (total least squares), nearer points
    counting more. One orientation spreads over each connected piece of the neighbourhood graph, along a minimum
    spanning tree that prefers short steps along the surface; the piece is then turned so that its normals point
    out of it (their flux is positive). A plane has no outside: there the sign is arbitrary, but always the same.

    Where neighbours then disagree, sheets touch, as two thighs or a hand and a hip do, or are thin, as fingers are;
    and where pieces lie next to each other, balls are too small, as along a tail that consists of rings of points. If
    such a body is closed, its `enclosure` says which side of a point is outside and which points of its ball lie on the
    same sheet.
    """
    enclosed, facets = np.zeros(len(points), dtype=bool), np.empty((0, 3), dtype=np.int64)
    if len(points) < 2:
        return EstimatedNormals(np.tile([0.0, 0.0, 1.0], (len(points), 1)), enclosed, facets.ravel())
    nearest = nearest_neighbours(points, PROPAGATION_NEIGHBOURS)
    fitted = _fitted_normals(points, nearest, nearest.ball_weights(BALL_NEIGHBOURS))
    tree = minimum_spanning_tree(undirected(nearest.indices, _reluctance(points, fitted, nearest)))
    pieces = connected_components(tree, directed=False)[1].astype(np.int64)
    normals = _oriented(points, fitted, nearest, tree, pieces)
    doubt = _contradicted(points, normals, nearest)
    bodies = _bodies(points, pieces, nearest)
    for body in range(bodies.max() + 1):
        members = np.flatnonzero(bodies == body)
        if doubt[members].mean() > DOUBT or np.ptp(pieces[members]) > 0:
            border = _closed_border(points[members])
            if border is not None:
                normals[members] = _sheets_apart(points[members], normals[members], border)
                enclosed[members] = True
                facets = np.concatenate([facets, members[border.facets]])
    ends = np.sort(facets[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return EstimatedNormals(normals, enclosed, sorted_distinct(ends[:, 0] * len(points) + ends[:, 1]))


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


def _closed_border(points: FloatArray) -> Enclosure | None:
    """The border of what the points enclose, or None if they are open, or too few to tell."""
    tetrahedra = Tetrahedra.between(points)
    if tetrahedra is None:
        return None
    border = enclosure(tetrahedra)
    spacing = nearest_neighbours(points, 6).distances.mean(axis=1) / tetrahedra.scale
    gap = border.radii > GAP * spacing[border.facets].max(axis=1)
    return border if border.areas @ gap <= OPEN_SHARE * border.areas.sum() else None


def _sheets_apart(points: FloatArray, normals: FloatArray, border: Enclosure) -> FloatArray:
    """(n, 3), unit: normals by what the points enclose; the old `normals` of points that its border passes by."""
    passed = (border.normals == 0).all(axis=1, keepdims=True)
    nearest = nearest_neighbours(points, BALL_NEIGHBOURS)
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
