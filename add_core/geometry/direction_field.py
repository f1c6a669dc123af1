"""Axes in tangent planes (directions without a sign), compared and smoothed by their double angle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from .._check import BoolArray, FloatArray, IntArray

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class TangentBasis:
    """An orthonormal basis of the tangent plane at each position; first × second = normal; all (m, 3).

    An axis at angle φ from `first` is written e^{2iφ}.
    """

    first: FloatArray
    second: FloatArray
    normals: FloatArray
    positions: FloatArray

    @classmethod
    def of(cls, normals: FloatArray, positions: FloatArray) -> TangentBasis:
        """Any basis perpendicular to `normals` (m, 3) at `positions` (m, 3)."""
        least = np.argmin(np.abs(normals), axis=1)
        first = np.cross(normals, np.eye(3)[least])
        length = np.linalg.norm(first, axis=1, keepdims=True)
        first = np.divide(first, length, out=np.zeros_like(first), where=length > 0)
        return cls(first, np.cross(normals, first), normals, positions)

    def axes(self, double_angle: ComplexArray) -> FloatArray:
        """Unit vectors (m, 3) along the axes written as e^{2iφ}, of either sign."""
        angle = np.angle(double_angle) / 2
        return np.asarray(np.cos(angle)[:, None] * self.first + np.sin(angle)[:, None] * self.second)

    def double_angles(self, vectors: FloatArray) -> ComplexArray:
        """|tangential part|² e^{2iφ} of `vectors` (m, 3)."""
        z = np.einsum("fi,fi->f", vectors, self.first) + 1j * np.einsum("fi,fi->f", vectors, self.second)
        return np.asarray(z * z)

    def transport(self, pairs: IntArray) -> ComplexArray:
        """Factors (p,) that carry a double angle from plane pairs[:, 0] to pairs[:, 1] by the least rotation."""
        a, b = pairs.T
        axis = np.cross(self.normals[a], self.normals[b])
        cosine = np.einsum("fi,fi->f", self.normals[a], self.normals[b])
        x = self.first[a]
        turned = cosine[:, None] * x + np.cross(axis, x)
        turned += axis * (np.einsum("fi,fi->f", axis, x) / np.maximum(1 + cosine, 1e-12))[:, None]
        z = np.einsum("fi,fi->f", turned, self.first[b]) + 1j * np.einsum("fi,fi->f", turned, self.second[b])
        square = z * z
        return np.asarray(square / np.maximum(np.abs(square), np.finfo(float).tiny))


def fill_axes(
    double_angle: ComplexArray, basis: TangentBasis, *, trusted: BoolArray, usable: BoolArray, neighbours: IntArray
) -> ComplexArray:
    """Replace axes that are not `trusted` by the smoothest continuation of those that are.

    Solves the connection Laplacian of order 2 (axes, not vectors) with the trusted axes held fixed. A connected
    piece that has no trusted axis at all, such as a plane or a perfect sphere, continues its own longest axis of
    inertia instead: arbitrary, but it moves with the shape. Rows that are not `usable` take no part.
    """
    pairs = neighbours[usable[neighbours].all(axis=1)]
    fixed = trusted & usable
    result = double_angle.copy()
    _seed_pieces_without_direction(result, fixed, basis, pairs, usable)
    free = usable & ~fixed
    if not free.any():
        return result
    laplacian = _connection_laplacian(basis, pairs, len(double_angle))
    held = np.where(fixed, result / np.maximum(np.abs(result), np.finfo(float).tiny), 0.0)
    rows = np.flatnonzero(free)
    block = laplacian[rows][:, rows].tocsc()
    block.setdiag(block.diagonal() + 1e-9)  # a lone row between no neighbours would make it singular
    solution = splu(block).solve(-(laplacian[rows] @ held))
    known = np.abs(solution) > 1e-9  # at a singularity of the field the neighbours cancel: keep what was measured
    result[rows[known]] = solution[known]
    return result


def _seed_pieces_without_direction(
    double_angle: ComplexArray, fixed: BoolArray, basis: TangentBasis, pairs: IntArray, usable: BoolArray
) -> None:
    m = len(double_angle)
    graph = csr_array((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=(m, m))
    _, piece = connected_components(graph, directed=False)
    has_direction = np.zeros(piece.max() + 1, dtype=bool)
    has_direction[piece[fixed]] = True
    for k in np.unique(piece[usable & ~has_direction[piece]]):
        rows = np.flatnonzero((piece == k) & usable)
        longest = np.linalg.eigh(np.cov(basis.positions[rows].T, bias=True))[1][:, -1]
        seed = basis.double_angles(np.broadcast_to(longest, (m, 3)))
        strong = rows[np.abs(seed[rows]) > 0.25]
        double_angle[strong] = seed[strong]
        fixed[strong] = True


def _connection_laplacian(basis: TangentBasis, pairs: IntArray, m: int) -> csr_array:
    a, b = pairs.T
    carry = basis.transport(pairs)  # plane a → plane b
    ones = np.ones(len(a))
    rows, columns = np.concatenate([a, b, a, b]), np.concatenate([a, b, b, a])
    values = np.concatenate([ones, ones, -carry.conj(), -carry])
    return csr_array(coo_array((values, (rows, columns)), shape=(m, m)))
