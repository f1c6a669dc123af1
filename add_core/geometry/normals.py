"""Normals of point clouds: planes fitted by total least squares, turned outward together."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

from .._check import FloatArray, IntArray
from .neighbours import Neighbours, nearest_neighbours, undirected

BALL_NEIGHBOURS = 12
"""The ε-ball of a point reaches to this one of its nearest neighbours: ε follows the density of the cloud."""
PROPAGATION_NEIGHBOURS = 14
"""Neighbours that a point's orientation may come from."""


def estimate_normals(points: FloatArray) -> FloatArray:
    """Unit normals (n, 3) of points that lie in different places, outward on every closed piece.

    Each is the direction in which the points of its ε-ball spread least (total least squares), nearer points
    counting more. One orientation spreads over each connected piece of the neighbourhood graph, along a minimum
    spanning tree that prefers short steps along the surface; the piece is then turned so that its normals point
    out of it (their flux is positive). A plane has no outside: there the sign is arbitrary, but always the same.

    Closed surfaces thinner than the distance between their points, such as fingers, cannot be told from a sheet.
    """
    if len(points) < 2:
        return np.tile([0.0, 0.0, 1.0], (len(points), 1))
    nearest = nearest_neighbours(points, PROPAGATION_NEIGHBOURS)
    return _orient(points, _fitted_normals(points, nearest), nearest)


def reflected_cosines(directions: FloatArray, normals: FloatArray, others: FloatArray) -> FloatArray:
    """Cosines between `others` and `normals` mirrored at the plane halfway along unit `directions`; arrays (..., 3).

    Mirroring carries a normal along a chord of any circle exactly, round any bend and to the opposite wall of a
    gap or a limb: 1 says the two normals belong to one surface, −1 that one of them is turned inside out.
    """
    along = np.einsum("...i,...i->...", directions, normals) * np.einsum("...i,...i->...", directions, others)
    return np.asarray(np.einsum("...i,...i->...", normals, others) - 2 * along)


def _fitted_normals(points: FloatArray, nearest: Neighbours) -> FloatArray:
    weight = nearest.ball_weights(BALL_NEIGHBOURS)
    offset = points[nearest.indices[:, :BALL_NEIGHBOURS]] - points[:, None]
    mean = np.einsum("nk,nki->ni", weight, offset) / (1.0 + weight.sum(axis=1))[:, None]  # the point itself weighs 1
    centred = offset - mean[:, None]
    spread = np.einsum("nk,nki,nkj->nij", weight, centred, centred) + mean[:, :, None] * mean[:, None, :]
    scale = np.maximum(np.einsum("nii->n", spread), np.finfo(float).tiny)
    return np.asarray(np.linalg.eigh(spread / scale[:, None, None])[1][:, :, 0])


def _orient(points: FloatArray, normals: FloatArray, nearest: Neighbours) -> FloatArray:
    tree = minimum_spanning_tree(undirected(nearest.indices, _reluctance(points, normals, nearest)))
    pieces = connected_components(tree, directed=False)[1]
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


def _reluctance(points: FloatArray, normals: FloatArray, nearest: Neighbours) -> FloatArray:
    """(n, k), > 0: how little the orientation of a point says about its neighbour's."""
    offset = points[nearest.indices] - points[:, None]
    direction = offset / nearest.distances[:, :, None]
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
