"""Eigenvalues and eigenfunctions of one operator."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh

from .._check import FloatArray, count_in, read_only
from ..operators import AnisotropicLaplacian


@dataclass(frozen=True, eq=False)
class Spectrum:
    """The K lowest solutions of W φ = λ S φ.

    eigenvalues : (K,), ascending, ≥ 0, 1/length². eigenfunctions : (n, K), 1/length, φᵀ S φ = I; zero at vertices
        without mass.
    mass : (n,), the diagonal of S, length².
    """

    eigenvalues: FloatArray
    eigenfunctions: FloatArray
    mass: FloatArray


def compute_spectrum(laplacian: AnisotropicLaplacian, *, theta: float = 0.0, count: int = 300) -> Spectrum:
    """The `count` lowest eigenvalues and eigenfunctions of the operator at angle θ.

    theta : radians. count : from 1 to the number of vertices with mass.
    The sign of an eigenfunction is set so that its entry of largest size is positive.
    Raises ParameterError if `count` is out of range.
    """
    massive = np.flatnonzero(laplacian.mass > 0)
    count = count_in("count", count, 1, len(massive))
    root = np.sqrt(laplacian.mass[massive])
    scaling = diags_array(1 / root)
    symmetric = (scaling @ laplacian.stiffness(theta)[massive][:, massive] @ scaling).tocsc()
    if count > len(massive) // 3 or len(massive) < 100:
        values, vectors = eigh(symmetric.toarray(), subset_by_index=(0, count - 1))
    else:
        shift = -1e-3 * laplacian.weyl_eigenvalue(1)
        values, vectors = eigsh(symmetric, k=count, sigma=shift, v0=root)
    order = np.argsort(values)
    largest = np.abs(vectors).argmax(axis=0)
    signs = np.where(vectors[largest, np.arange(count)] < 0, -1.0, 1.0)
    eigenfunctions = np.zeros((len(laplacian.mass), count))
    eigenfunctions[massive] = (signs * vectors / root[:, None])[:, order]
    return Spectrum(read_only(np.maximum(values[order], 0.0)), read_only(eigenfunctions), laplacian.mass)
