"""How much of an evenly bright sky each point of a shape sees: what makes folds and armpits dark."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray
from ..geometry import PointCloud, TriangleMesh
from ..geometry.shapes import even_directions
from .facets import Facets
from .raster import rasterise

RESOLUTION = 220
"""Pixels along the longest side of the shape, of the views that decide what hides what."""
_TOLERANCE = 0.012  # of the longest side: what hides a point must be nearer to the sky by more


def sky_share(shape: TriangleMesh | PointCloud, *, directions: int = 64) -> FloatArray:
    """(n,), 0 to 1: the cosine-weighted share of the directions outside each vertex that nothing stands in.

    directions : how many parts of the sky are looked at, spread evenly; more is smoother. Averaged over neighbours.
    """
    facets = Facets.of(shape)
    middle = 0.5 * (facets.places.min(axis=0) + facets.places.max(axis=0))
    reach = float(np.linalg.norm(facets.places - middle, axis=1).max())
    places = (facets.places - middle) / (2 * reach)
    points, normals = (shape.vertices - middle) / (2 * reach), _vertex_normals(facets, shape.vertex_count)
    solid = facets.faces[-facets.hiding :] if facets.hiding else facets.faces
    seen, whole = np.zeros(len(points)), np.zeros(len(points))
    for toward in even_directions(directions):
        cosine = normals @ toward
        facing = np.flatnonzero(cosine > 0.05)
        seen[facing] += cosine[facing] * _open(places, solid, points[facing], toward)
        whole[facing] += cosine[facing]
    share = np.where(whole > 0, seen / np.where(whole > 0, whole, 1.0), 1.0)
    return _smoothed(share, shape, facets)


def _open(places: FloatArray, faces: IntArray, points: FloatArray, toward: FloatArray) -> FloatArray:
    """1 where nothing lies between a point and the sky in direction `toward`, else 0."""
    across = np.cross(toward, np.eye(3)[np.abs(toward).argmin()])
    across /= np.linalg.norm(across)
    axes = np.stack([across, np.cross(toward, across), toward])
    scale = np.array([RESOLUTION, -RESOLUTION, 1.0])
    offset = np.array([RESOLUTION / 2, RESOLUTION / 2, 0.0])
    depth = rasterise(places @ axes.T * scale + offset, faces, RESOLUTION, RESOLUTION, back_faces=True).depth
    at = points @ axes.T * scale + offset
    column, row = np.clip(at[:, :2].astype(np.int64), 0, RESOLUTION - 1).T
    return np.asarray(depth[row * RESOLUTION + column] < at[:, 2] + _TOLERANCE, dtype=np.float64)


def _vertex_normals(facets: Facets, count: int) -> FloatArray:
    """(n, 3): the mean over the places of each vertex; over the rim of a disc it is the disc's own."""
    total = np.stack([np.bincount(facets.owner, facets.normals[:, k], count) for k in range(3)], axis=1)
    return np.asarray(total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-12))


def _smoothed(share: FloatArray, shape: TriangleMesh | PointCloud, facets: Facets) -> FloatArray:
    """Averaged over neighbours a few times: a part of the sky is either seen or not, which would show as patches."""
    if isinstance(shape, TriangleMesh):
        one = np.concatenate([facets.faces[:, k] for k in range(3)])
        two = np.concatenate([facets.faces[:, (k + 1) % 3] for k in range(3)])
        weight = np.bincount(one, minlength=len(share)) + np.bincount(two, minlength=len(share)) + 1.0
        for _ in range(4):
            total = np.bincount(one, share[two], len(share)) + np.bincount(two, share[one], len(share))
            share = (share + total) / weight
        return np.asarray(share)
    near = KDTree(shape.points).query(shape.points, k=min(8, len(share)))[1]
    return np.asarray(share[near].mean(axis=1))
