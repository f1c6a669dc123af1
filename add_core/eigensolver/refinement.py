"""Verification of every computed eigenpair, and the repair of those that fall short."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from .._check import BoolArray, FloatArray
from ..errors import ConvergenceError
from .factorisation import Factorisation, factorise_near

RESIDUAL = 1e-6
"""‖W φ − λ S φ‖ in the norm of S⁻¹, relative to λ, that every eigenpair keeps."""

ROUNDING = 1e-14
"""Slivers make entries of A so large that rounding leaves more: this share of the terms of A u is then the limit."""

ORTHONORMAL = 1e-9
"""Largest entry of φᵀSφ − I, estimated by random probes, beyond which the vectors are made orthonormal again."""

COLUMNS = 64
"""Residuals are formed for this many columns at a time, which keeps memory small and the columns in cache."""

ROWS = 256
"""Eigenfunctions are put together, and their signs looked for, in this many rows at a time."""


@dataclass(frozen=True, eq=False)
class StandardPairs:
    """Eigenvalues (k,) ascending and orthonormal eigenvectors (n, k) of A = S^−½ W S^−½."""

    values: FloatArray
    vectors: FloatArray


def residual_norms(matrix: csr_array, pairs: StandardPairs) -> FloatArray:
    """(k,): ‖A u − λ u‖, which is ‖W φ − λ S φ‖ in the norm of S⁻¹ for φ = S^−½ u."""
    norms = []
    for begin in range(0, len(pairs.values), COLUMNS):
        part = pairs.vectors[:, begin : begin + COLUMNS].copy(order="C")
        defect = matrix @ part
        part *= pairs.values[begin : begin + COLUMNS]
        defect -= part
        norms.append(np.sqrt(np.einsum("ij,ij->j", defect, defect)))
    return np.concatenate(norms)


def failing(matrix: csr_array, pairs: StandardPairs) -> BoolArray:
    """(k,): which pairs miss RESIDUAL, except by what rounding in A u alone can leave."""
    norms = residual_norms(matrix, pairs)
    bad = norms > 0.9 * RESIDUAL * pairs.values  # whoever checks may sum in another order
    if bad.any():
        rounding = ROUNDING * np.linalg.norm(abs(matrix) @ np.abs(pairs.vectors[:, bad]), axis=0)
        bad[bad] = norms[bad] > rounding
    return bad


def repaired(factors: Factorisation, kernel: FloatArray, pairs: StandardPairs) -> StandardPairs:
    """Pairs that all pass, by the factorisation that found them and, for the lowest, by one just below zero.

    kernel : (c, n), and the vectors of pairs: in the tree's order.
    Raises ConvergenceError if that does not help; the Lanczos basis was then too poor to be mended.
    """
    matrix, pairs = factors.matrix, _orthonormal(pairs)
    bad = failing(matrix, pairs)
    mended = bool(bad.any())
    if mended:
        pairs = _polished(factors, pairs, bad)
        bad = failing(matrix, pairs)
    if bad.any() and not bad[len(bad) // 2 :].any():  # the upper half would hardly improve from below zero
        pairs = _improved(factors, kernel, pairs, count=int(np.flatnonzero(bad)[-1]) + 1)
        bad = failing(matrix, pairs)
    if bad.any():
        raise ConvergenceError(f"{bad.sum()} of {len(bad)} eigenpairs miss a residual of {RESIDUAL:.0e}.")
    if mended and _skewness(pairs.vectors) > 5 * ORTHONORMAL:
        raise ConvergenceError("Eigenvectors lost their orthogonality where slivers amplify rounding.")
    return pairs


def _polished(factors: Factorisation, pairs: StandardPairs, bad: BoolArray) -> StandardPairs:
    """One inverse iteration on the bad pairs, each on its own.

    Summing a vector from the basis leaves rounding of the size of its largest entry everywhere. At the tiny vertices of
    slivers A multiplies that by many orders of magnitude, while solving with A damps it as much.
    """
    solved = factors.refining().solve(pairs.vectors[:, bad])
    vectors = pairs.vectors.copy()
    vectors[:, bad] = solved * (np.sign(pairs.values[bad] - factors.shift) / np.linalg.norm(solved, axis=0))
    return StandardPairs(pairs.values, vectors)


def _skewness(vectors: FloatArray) -> float:
    """About the largest entry of uᵀu − I, by random probes instead of all products."""
    probes = np.random.default_rng(2).choice([-1.0, 1.0], size=(vectors.shape[1], 2))
    return float(np.abs(vectors.T @ (vectors @ probes) - probes).max())


def _orthonormal(pairs: StandardPairs) -> StandardPairs:
    u = pairs.vectors
    if _skewness(u) <= ORTHONORMAL:
        return pairs
    triangle = np.linalg.cholesky(u.T @ u)
    return StandardPairs(pairs.values, np.linalg.solve(triangle, u.T).T)


def _improved(factors: Factorisation, kernel: FloatArray, pairs: StandardPairs, *, count: int) -> StandardPairs:
    """A few inverse iterations just below zero on the lowest `count` pairs, kept orthogonal to all others."""
    below = factorise_near(factors.tree, factors.values, -0.01 * float(pairs.values[-1]))
    low, others = pairs.vectors[:, :count], np.vstack([kernel, pairs.vectors[:, count:].T])
    for _ in range(5):
        solved = below.solve(low)
        for _ in range(2):
            solved = solved - others.T @ (others @ solved)
            solved = np.linalg.qr(solved)[0]
        low = solved
    values, mixing = np.linalg.eigh(low.T @ (factors.matrix @ low))
    return StandardPairs(
        np.concatenate([values, pairs.values[count:]]), np.column_stack([low @ mixing, pairs.vectors[:, count:]])
    )


def orient(functions: FloatArray) -> None:
    """Fix the sign of each column in place: positive at the first vertex where it exceeds half of its largest size.

    A threshold, unlike the largest entry itself, does not waver between the two poles of a symmetric shape.
    """
    half = 0.5 * np.maximum(functions.max(axis=0, initial=0.0), -functions.min(axis=0, initial=0.0))
    signs = np.ones(functions.shape[1])
    unknown = np.arange(len(signs))
    for begin in range(0, len(functions), ROWS):
        rows = functions[begin : begin + ROWS, unknown]
        large = np.abs(rows) > half[unknown]
        first = np.argmax(large, axis=0)
        known = np.flatnonzero(large[first, np.arange(len(unknown))])
        signs[unknown[known]] = np.sign(rows[first[known], known])
        unknown = np.delete(unknown, known)
        if len(unknown) == 0:
            break
    functions *= signs
