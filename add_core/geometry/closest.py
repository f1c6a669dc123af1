"""The nearest point of a mesh's surface, faces included, not only its vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray, points_array, read_only
from .mesh import TriangleMesh

NEAREST_CENTRES = 12
"""Faces compared for each point: those whose centres lie nearest. Right where faces are of similar size."""


@dataclass(frozen=True, eq=False)
class ClosestPoints:
    """Points on the surface of a mesh.

    faces : (q,), the face that holds each. weights : (q, 3), barycentric. distances : (q,), to the points asked for.
    """

    faces: IntArray
    weights: FloatArray
    distances: FloatArray


def closest_points(mesh: TriangleMesh, points: ArrayLike, normals: FloatArray | None = None) -> ClosestPoints:
    """The point of the surface nearest to each of `points` (q, 3), straight through space.

    normals : (q, 3). With them only faces that look the same way count, where there are any near: no jump from an arm
        to the body that it touches.
    """
    from trimesh.triangles import closest_point, points_to_barycentric

    wanted = points_array("points", points)
    corners = mesh.vertices[mesh.faces]
    count = min(NEAREST_CENTRES, len(corners))
    near = np.asarray(KDTree(corners.mean(axis=1)).query(wanted, k=np.arange(1, count + 1))[1])
    places = closest_point(corners[near].reshape(-1, 3, 3), np.repeat(wanted, count, axis=0)).reshape(-1, count, 3)
    distances = np.linalg.norm(places - wanted[:, None, :], axis=2)
    if normals is not None:
        away = (mesh.face_normals[near] * normals[:, None, :]).sum(axis=2) < 0
        distances = distances + np.where(away, 1e3 * np.ptp(mesh.vertices), 0.0)
    row, best = np.arange(len(wanted)), distances.argmin(axis=1)
    faces, chosen = near[row, best], places[row, best]
    weights = np.clip(np.nan_to_num(points_to_barycentric(corners[faces], chosen, method="cross"), nan=1 / 3), 0, 1)
    weights /= weights.sum(axis=1, keepdims=True)
    length = np.linalg.norm(chosen - wanted, axis=1)
    return ClosestPoints(read_only(faces.astype(np.int64)), read_only(weights), read_only(length))
