"""The dense eigensolver, which serves small shapes and where Lanczos fails; exact beside slivers too."""

from __future__ import annotations

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve
from scipy.sparse import csr_array

from .._check import FloatArray
from ..errors import ConvergenceError
from .refinement import RESIDUAL, StandardPairs, failing


def dense_pairs(matrix: csr_array, kernel: FloatArray, count: int, scale: float) -> StandardPairs:
    """The `count` smallest eigenpairs of A = S^−½ W S^−½ (n, n) beside its `kernel` (c, n), by LAPACK.

    A sliver makes entries of A so large that their rounding exceeds the smallest eigenvalues. These come from the
    inverse then, to which slivers add next to nothing, and the largest from A itself.

    scale : about the largest eigenvalue asked for. Raises ConvergenceError if neither gives a pair its residual.
    """
    direct = _lowest(matrix, kernel, count)
    bad = failing(matrix, direct)
    if not bad.any():
        return direct
    inverse = _inverse(matrix, kernel, count, scale)
    end = int(np.flatnonzero(bad)[-1]) + 1
    mixed = StandardPairs(
        np.concatenate([inverse.values[:end], direct.values[end:]]),
        np.column_stack([inverse.vectors[:, :end], direct.vectors[:, end:]]),
    )
    bad = failing(matrix, mixed)
    if bad.any():
        raise ConvergenceError(
            f"{bad.sum()} of {count} eigenpairs miss a residual of {RESIDUAL:.0e}, for the shape has faces that are "
            "next to flat. Look for them with add-core info, and repair the shape."
        )
    return mixed


def _lowest(matrix: csr_array, kernel: FloatArray, count: int) -> StandardPairs:
    """From A, the kernel lifted above the whole spectrum so that the smallest eigenvalues are those beside it."""
    top = 2.0 * float(abs(matrix).sum(axis=1).max())
    values, vectors = np.linalg.eigh(matrix.toarray() + top * (kernel.T @ kernel))
    return StandardPairs(np.maximum(values[:count], 0.0), vectors[:, :count])


def _inverse(matrix: csr_array, kernel: FloatArray, count: int, scale: float) -> StandardPairs:
    """From (A + σ)⁻¹, the kernel lowered below its whole spectrum; a last inverse iteration settles tiny vertices."""
    n = len(kernel.T)
    try:
        factor = cho_factor(matrix.toarray() + scale * np.eye(n), lower=True)
    except LinAlgError:
        raise ConvergenceError(
            "faces that are next to flat make the operator indefinite by rounding. Repair the shape: add-core info."
        ) from None
    inverse = cho_solve(factor, np.eye(n))
    values, vectors = np.linalg.eigh((inverse + inverse.T) / 2 - kernel.T @ kernel / scale)
    values, vectors = values[::-1][:count], vectors[:, ::-1][:, :count]
    vectors = cho_solve(factor, vectors)
    vectors /= np.linalg.norm(vectors, axis=0)
    return StandardPairs(np.maximum(1.0 / np.maximum(values, 1e-300) - scale, 0.0), vectors)
