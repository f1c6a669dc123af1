"""Eigenvalues and eigenfunctions of one operator."""

from __future__ import annotations

import logging
from dataclasses import dataclass

from threadpoolctl import threadpool_limits

from .._check import FloatArray, count_in, finite, instance_of, read_only
from ..eigensolver.solver import PencilSolver
from ..operators import AnisotropicLaplacian

_log = logging.getLogger(__name__)


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
    The first eigenpairs are λ = 0 and the constants of the connected components. Signs are fixed: an eigenfunction is
    positive at the first vertex where it exceeds half of its largest magnitude. Accuracy is that of
    `compute_spectra`.
    Raises ParameterError if `count` is out of range, ConvergenceError if every method fails.
    """
    instance_of("laplacian", laplacian, AnisotropicLaplacian, remedy="AnisotropicLaplacian(shape) makes one.")
    theta = finite("theta", theta)
    count = count_in("count", count, 1, int((laplacian.mass > 0).sum()))
    pattern = laplacian.pattern
    solver = PencilSolver(pattern.indptr, pattern.indices, laplacian.mass)
    with threadpool_limits(1):  # numpy's and scipy's thread pools stall each other
        pairs = solver.eigenpairs(
            laplacian.stiffness_values(theta), count=count, scale=laplacian.weyl_eigenvalue(count)
        )
    if pairs.fallback:
        _log.warning("The operator was solved by the %s.", pairs.fallback)
    return Spectrum(read_only(pairs.values), read_only(pairs.functions), laplacian.mass)
