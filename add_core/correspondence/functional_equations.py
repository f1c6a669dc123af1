"""The least-squares problem whose solution is a functional map."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse.linalg import LinearOperator, cg

from .._check import FloatArray
from ..errors import ConvergenceError
from ..spectra import Spectrum

Operators = list[tuple[FloatArray, FloatArray]]
"""Pairs of matrices (k1, k1) and (k2, k2) that correspond."""


@dataclass(frozen=True)
class Weights:
    """Weights ≥ 0 of the four terms, each term already divided by its own size, so that 1 is as good as any other."""

    descriptors: float = 1.0
    laplacian: float = 1e-1
    products: float = 1.0
    orientation: float = 1.0


@dataclass(frozen=True, eq=False)
class MapEquations:
    """min_C w_d ‖C A₁ − A₂‖² + w_l Σ (λ₂ᵢ − λ₁ⱼ)² C²ᵢⱼ + Σ w ‖C X₁ − s X₂ C‖².

    signals_1 : (k1, d), signals_2 : (k2, d), coefficients of descriptors. gaps : (k2, k1), weighted squared eigenvalue
    gaps. commuting_pairs : weight, sign and matrices of each pair. All terms are quadratic in C (k2, k1).
    """

    signals_1: FloatArray
    signals_2: FloatArray
    gaps: FloatArray
    weights: Weights
    commuting_pairs: tuple[tuple[float, float, FloatArray, FloatArray], ...] = ()

    @classmethod
    def of(
        cls,
        spectrum_1: Spectrum,
        spectrum_2: Spectrum,
        signals: tuple[FloatArray, FloatArray],
        counts: tuple[int, int],
        weights: Weights,
    ) -> MapEquations:
        """Terms of descriptors and Laplacians, from signals (n1, d) and (n2, d) of unit length."""
        coefficients = [
            spectrum.eigenfunctions[:, :count].T @ (spectrum.mass[:, None] * values)
            for spectrum, values, count in zip((spectrum_1, spectrum_2), signals, counts, strict=True)
        ]
        # Isometric shapes of different size have proportional eigenvalues: λ · area has no unit.
        first = spectrum_1.eigenvalues[: counts[0]] * spectrum_1.mass.sum()
        second = spectrum_2.eigenvalues[: counts[1]] * spectrum_2.mass.sum()
        top = float(max(first.max(), second.max())) or 1.0
        gaps = weights.laplacian * ((second[:, None] - first[None, :]) / top) ** 2
        share = np.sqrt(max(weights.descriptors, 1e-300) / max(float(np.linalg.norm(coefficients[0])) ** 2, 1e-300))
        return cls(share * coefficients[0], share * coefficients[1], gaps, weights)

    def commuting(self, pairs: Operators, sign: float, *, orientation: bool = False) -> MapEquations:
        """The same problem with a term ‖C X₁ − sign · X₂ C‖² for each pair of operators."""
        weight = self.weights.orientation if orientation else self.weights.products
        added = tuple(
            (weight / (len(pairs) * max(float(np.linalg.norm(one, 2)) ** 2, 1e-300)), sign, one, two)
            for one, two in pairs
        )
        return replace(self, commuting_pairs=self.commuting_pairs + added)

    def solve(self) -> FloatArray:
        """C (k2, k1): row by row where only the first two terms are there, by conjugate gradients otherwise.

        Raises ConvergenceError if the problem has no unique solution that can be found.
        """
        gram, right = self.signals_1 @ self.signals_1.T, self.signals_2 @ self.signals_1.T
        regular = gram + 1e-12 * np.eye(len(gram)) * max(np.trace(gram) / len(gram), 1e-300)
        rows = np.linalg.solve(regular + np.eye(len(gram)) * self.gaps[:, None, :], right[:, :, None])[:, :, 0]
        if not self.commuting_pairs:
            return rows
        shape = right.shape
        diagonal = np.diag(regular) + self.gaps + self._commuting_diagonal()
        normal = LinearOperator(
            (right.size, right.size), matvec=lambda c: self._normal(c.reshape(shape), regular).ravel(), dtype=float
        )
        inverse = LinearOperator(normal.shape, matvec=lambda c: c / diagonal.ravel(), dtype=float)
        solution, failed = cg(normal, right.ravel(), x0=rows.ravel(), rtol=1e-9, maxiter=4000, M=inverse)
        if failed and not np.isfinite(solution).all():
            raise ConvergenceError("The functional map was not found. Give more descriptors or fewer eigenfunctions.")
        return np.asarray(solution.reshape(shape))

    def _normal(self, c: FloatArray, gram: FloatArray) -> FloatArray:
        result = c @ gram + self.gaps * c
        for weight, sign, one, two in self.commuting_pairs:
            residual = c @ one - sign * (two @ c)
            result += weight * (residual @ one.T - sign * (two.T @ residual))
        return np.asarray(result)

    def _commuting_diagonal(self) -> FloatArray:
        total = np.zeros(self.gaps.shape)
        for weight, sign, one, two in self.commuting_pairs:
            first, second = (one**2).sum(axis=1), (two**2).sum(axis=0)
            total += weight * (first[None, :] + second[:, None] - 2 * sign * np.outer(np.diag(two), np.diag(one)))
        return total


def unit_signals(values: FloatArray, spectrum: Spectrum) -> FloatArray:
    """(n, d): each column scaled to unit length on the shape, in the inner product of its mass."""
    lengths = np.sqrt(np.maximum((spectrum.mass[:, None] * values**2).sum(axis=0), 1e-300))
    return np.asarray(values / lengths)


def reduced_operators(
    signals: tuple[FloatArray, FloatArray],
    spectra: tuple[Spectrum, Spectrum],
    counts: tuple[int, int],
) -> Operators:
    """Products with each descriptor in the bases of both shapes: X = Φᵀ S diag(f) Φ."""
    pairs = []
    for one, two in zip(signals[0].T, signals[1].T, strict=True):
        matrices = [
            spectrum.eigenfunctions[:, :count].T
            @ ((spectrum.mass * column)[:, None] * spectrum.eigenfunctions[:, :count])
            for spectrum, column, count in zip(spectra, (one, two), counts, strict=True)
        ]
        pairs.append((matrices[0], matrices[1]))
    return pairs
