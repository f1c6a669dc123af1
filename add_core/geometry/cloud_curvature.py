"""Curvature tensors of point clouds, from how the normals turn between neighbours (section 6)."""

from __future__ import annotations

import numpy as np

from .._check import FloatArray
from .tangent_planes import TangentPlanes

BENDING_NEIGHBOURS = 12
"""Neighbours whose normals tell the curvature of a point."""
SMOOTHING_ROUNDS = 2


def point_curvature_tensors(planes: TangentPlanes, *, rounds: int = SMOOTHING_ROUNDS) -> FloatArray:
    r"""Curvature tensor at every point, averaged over neighbours.

    The paper takes the covariance of neighbouring normals, whose eigenvalues are κ² times the spread of the
    neighbours. Set against the covariance of normals *with positions* the same data give the sign of κ, its unit,
    and directions that an uneven spread of the neighbours does not turn: the symmetric S that minimises Σ w |S p −
    Δn|² over neighbours at p in the tangent plane, whose normals differ by Δn. On a sphere and a cylinder S is exact.

    Returns (n, 3, 3), symmetric, 1/length; positive where convex. As with meshes each axis carries the curvature
    *across* it: the eigenvector of the largest |eigenvalue| is the direction of MINIMUM curvature. Zero where
    fewer than two neighbours lie on the surface.
    """
    k = min(BENDING_NEIGHBOURS, planes.neighbours.shape[1])
    use = planes.on_surface[:, :k]
    middle = planes.distances[:, k // 2, None] if k else planes.distances
    weight = np.where(use, np.exp(-((planes.distances[:, :k] / middle) ** 2)), 0.0)
    s11, s12, s22 = _fitted_shape_operators(planes, weight)
    first, second = planes.basis.first, planes.basis.second
    mixed = first[:, :, None] * second[:, None, :]
    # Turned by 90°, as Cohen-Steiner and Morvan's tensor is: what bends along `first` stands at `second`.
    tensors = s22[:, None, None] * first[:, :, None] * first[:, None, :]
    tensors += s11[:, None, None] * second[:, :, None] * second[:, None, :]
    tensors -= s12[:, None, None] * (mixed + mixed.transpose(0, 2, 1))
    for _ in range(rounds):
        around = np.einsum("nk,nkij->nij", weight, tensors[planes.neighbours[:, :k]])
        tensors = (tensors + around) / (1 + weight.sum(axis=1))[:, None, None]
    return np.asarray(tensors)


def _fitted_shape_operators(planes: TangentPlanes, weight: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """s11, s12, s22 (n,): the symmetric least-squares fit of Δn = S p in each tangent plane."""
    k = weight.shape[1]
    x, y = planes.plane[:, :k, 0], planes.plane[:, :k, 1]
    u = np.einsum("nki,ni->nk", planes.bends[:, :k], planes.basis.first)
    v = np.einsum("nki,ni->nk", planes.bends[:, :k], planes.basis.second)
    xx, xy, yy = (weight * x * x).sum(1), (weight * x * y).sum(1), (weight * y * y).sum(1)
    right = np.stack([(weight * u * x).sum(1), (weight * (u * y + v * x)).sum(1), (weight * v * y).sum(1)], axis=1)
    zero = np.zeros_like(xx)
    rows = [np.stack([xx, xy, zero], 1), np.stack([xy, xx + yy, xy], 1), np.stack([zero, xy, yy], 1)]
    size = np.maximum(xx + yy, np.finfo(float).tiny)
    matrix = np.stack(rows, axis=1) / size[:, None, None]
    matrix += 1e-6 * np.eye(3)  # neighbours on one line say nothing about the bend across it: take none
    solution = np.linalg.solve(matrix, (right / size[:, None])[:, :, None])[:, :, 0]
    return solution[:, 0], solution[:, 1], solution[:, 2]
