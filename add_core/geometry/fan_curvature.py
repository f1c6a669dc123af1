"""Curvature tensors of point clouds from the angles between the triangles of their fans, as meshes have them."""

from __future__ import annotations

import numpy as np

from .._check import BoolArray, FloatArray, IntArray
from .curvature import AT_BOUNDARY, SMOOTHING_ROUNDS, vertex_means

POOR, GOOD = 32.0, 36.0
"""Degrees: smallest angle of the triangles around a point, in the mean, below which they say nothing about curvature,
and above which they say as much as those of a mesh. In the median it is 30 to 31 where points are scattered at random,
37 to 43 at the vertices of people and dogs and in clouds that are thinned evenly."""


def fan_curvature_tensors(
    points: FloatArray, triangles: IntArray, weights: FloatArray, *, rounds: int = SMOOTHING_ROUNDS
) -> FloatArray:
    """Curvature tensors (n, 3, 3) at the points that `face_curvature_tensors` would find if the fans were one mesh.

    Every fan tells the angles at the edges from its centre; an edge's is the mean of what the fans of its two ends
    tell, so that fans that disagree about their triangles still agree about the bend.

    points : (n, 3). triangles : (t, 3), the centre of the fan first. weights : (t,), how much of the surface each
    stands for.
    """
    count = len(points)
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    upright = np.cross(b - a, c - a)
    double = np.linalg.norm(upright, axis=1)
    normals = upright / np.maximum(double, np.finfo(float).tiny)[:, None]
    sides = np.sort(triangles[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 3, 2), axis=2) @ np.array([count, 1])
    keys, edge = np.unique(sides, return_inverse=True)
    edge = edge.reshape(-1, 3)
    angles, known = _angles(points, triangles, normals, edge, len(keys))
    ends = np.stack([keys // count, keys % count], axis=1)
    vector = points[ends[:, 1]] - points[ends[:, 0]]
    length = np.maximum(np.linalg.norm(vector, axis=1), np.finfo(float).tiny)
    half = np.einsum("e,ei,ej->eij", angles / (2 * length), vector, vector).reshape(-1, 9)
    density = half[edge].sum(axis=1) / np.maximum(double / 2, np.finfo(float).tiny)[:, None]
    weight = weights * double / 2 * np.where(known[edge].all(axis=1), 1.0, AT_BOUNDARY)
    return vertex_means(triangles, count, density, weight, rounds=rounds)[0]


def trust_in_fans(points: FloatArray, triangles: IntArray) -> FloatArray:
    """(n,): from 0 to 1, how far the triangles around each point and its neighbours are shaped well enough."""
    corners = points[triangles]
    edges = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    length = np.maximum(np.linalg.norm(edges, axis=2), np.finfo(float).tiny)
    cosines = -np.einsum("tci,tci->tc", edges[:, [1, 2, 0]], edges[:, [2, 0, 1]])
    angles = np.arccos(np.clip(cosines / (length[:, [1, 2, 0]] * length[:, [2, 0, 1]]), -1, 1))
    least, touching = np.degrees(angles.min(axis=1)), np.bincount(triangles.ravel(), minlength=len(points))
    for _ in range(SMOOTHING_ROUNDS + 1):
        sums = np.bincount(triangles.ravel(), np.repeat(least, 3), len(points))
        mean = sums / np.maximum(touching, 1)
        least = mean[triangles].mean(axis=1)
    return np.asarray(np.clip((mean - POOR) / (GOOD - POOR), 0.0, 1.0))


def _angles(
    points: FloatArray, triangles: IntArray, normals: FloatArray, edge: IntArray, count: int
) -> tuple[FloatArray, BoolArray]:
    """(e,): signed angles at the edges, positive where convex, 0 where no fan tells; (e,): whether one does."""
    size = len(points)
    begins, ends = (triangles[:, 0] * size + triangles[:, corner] for corner in (1, 2))
    order = np.argsort(begins, kind="stable")
    place = np.minimum(np.searchsorted(begins[order], ends), len(order) - 1)
    right = np.flatnonzero(begins[order[place]] == ends)  # goes before a spoke, counter-clockwise, and `left` after it
    left = order[place[right]]
    spoke = points[triangles[right, 2]] - points[triangles[right, 0]]
    spoke /= np.maximum(np.linalg.norm(spoke, axis=1, keepdims=True), np.finfo(float).tiny)
    sine = np.einsum("si,si->s", spoke, np.cross(normals[left], normals[right]))
    angle = np.arctan2(sine, np.einsum("si,si->s", normals[left], normals[right]))
    told = edge[right, 1]  # the side opposite to the second corner lies between the centre and the third
    times = np.bincount(told, minlength=count)
    return np.bincount(told, angle, count) / np.maximum(times, 1), times > 0
