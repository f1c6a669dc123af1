"""Curvature tensors of point clouds, from how the normals turn between neighbours (section 6)."""

from __future__ import annotations

import numpy as np

from .._check import FloatArray
from .direction_field import ComplexArray, TangentBasis
from .tangent_planes import TangentPlanes

BENDING_NEIGHBOURS = 14
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
    count = BENDING_NEIGHBOURS
    weight = planes.nearest.ball_weights(count) * planes.on_surface[:, :count]
    neighbours = planes.nearest.indices[:, :count]
    s11, s12, s22 = _fitted_shape_operators(planes, weight)
    mean, double_angle = (s11 + s22) / 2, (s11 - s22) / 2 + 1j * s12
    # Tensors in space would lose what sticks out of the tangent plane that they are averaged in: carry them over
    # first.
    carry = planes.basis.transport(np.stack([neighbours.ravel(), np.repeat(np.arange(len(mean)), weight.shape[1])], 1))
    carried = weight * carry.reshape(weight.shape)
    total = 1 + weight.sum(axis=1)
    for _ in range(rounds):
        mean = (mean + (weight * mean[neighbours]).sum(axis=1)) / total
        double_angle = (double_angle + (carried * double_angle[neighbours]).sum(axis=1)) / total
    return _turned_tensors(mean, double_angle, planes.basis)


def _turned_tensors(mean: FloatArray, double_angle: ComplexArray, basis: TangentBasis) -> FloatArray:
    """Tensors in space, turned by 90° as Cohen-Steiner and Morvan's are: what bends along `first` stands at
    `second`."""
    first, second = basis.first, basis.second
    mixed = first[:, :, None] * second[:, None, :]
    tensors = (mean - double_angle.real)[:, None, None] * first[:, :, None] * first[:, None, :]
    tensors += (mean + double_angle.real)[:, None, None] * second[:, :, None] * second[:, None, :]
    tensors -= double_angle.imag[:, None, None] * (mixed + mixed.transpose(0, 2, 1))
    return np.asarray(tensors)


def _fitted_shape_operators(planes: TangentPlanes, weight: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """s11, s12, s22 (n,): the symmetric least-squares fit of Δn = S p in each tangent plane."""
    k = weight.shape[1]
    x, y = planes.plane[:, :k, 0], planes.plane[:, :k, 1]
    u, v = planes.bends[:, :k, 0], planes.bends[:, :k, 1]
    xx, xy, yy = (weight * x * x).sum(1), (weight * x * y).sum(1), (weight * y * y).sum(1)
    right = np.stack([(weight * u * x).sum(1), (weight * (u * y + v * x)).sum(1), (weight * v * y).sum(1)], axis=1)
    zero = np.zeros_like(xx)
    rows = [np.stack([xx, xy, zero], 1), np.stack([xy, xx + yy, xy], 1), np.stack([zero, xy, yy], 1)]
    size = np.maximum(xx + yy, np.finfo(float).tiny)
    matrix = np.stack(rows, axis=1) / size[:, None, None]
    matrix += 1e-6 * np.eye(3)  # neighbours on one line say nothing about the bend across it: take none
    solution = np.linalg.solve(matrix, (right / size[:, None])[:, :, None])[:, :, 0]
    return solution[:, 0], solution[:, 1], solution[:, 2]
