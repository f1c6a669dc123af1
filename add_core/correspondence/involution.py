"""Functional maps of symmetries: equal to their own transpose and to their own inverse."""

from __future__ import annotations

import numpy as np

from .._check import FloatArray, IntArray
from ..spectra import Spectrum
from .nearest import nearest_matches


def nearest_involution(matrix: FloatArray) -> FloatArray:
    """The symmetric orthogonal matrix nearest to a square one, (k, k): signs of its symmetric part's eigenvalues."""
    values, vectors = np.linalg.eigh(0.5 * (matrix + matrix.T))
    return np.asarray((vectors * np.where(values >= 0, 1.0, -1.0)) @ vectors.T)


def involution_of_matches(spectrum: Spectrum, rows: IntArray, matches: IntArray, size: int) -> FloatArray:
    """The (size, size) map of matches (r,) of the vertices `rows` (r,), made an involution."""
    functions = spectrum.eigenfunctions[:, :size].astype(np.float64)
    fitted = np.linalg.lstsq(functions[rows], functions[matches], rcond=None)[0]
    return nearest_involution(fitted.astype(np.float64))


def grown_involution(spectrum: Spectrum, start: FloatArray, rows: IntArray, size: int, *, step: int = 5) -> FloatArray:
    """ZoomOut from `start` (k, k) to (size, size) on the vertices `rows` (r,), an involution at every step."""
    functions = spectrum.eigenfunctions
    matrix = nearest_involution(start)
    while len(matrix) < size:
        k = len(matrix)
        matches = nearest_matches(functions[rows, :k], functions[:, :k] @ matrix.T)
        matrix = involution_of_matches(spectrum, rows, matches, min(k + step, size))
    return matrix
