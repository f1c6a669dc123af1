"""Heat kernel signature: how much heat stays."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, count_in, positive_array
from ..errors import ParameterError
from ..spectra import Spectrum


def heat_kernel_signature(spectrum: Spectrum, times: ArrayLike) -> FloatArray:
    """HKS of every vertex, h_t(x, x) = Σ_k exp(−t λ_k) φ_k(x)²: (n, T), 1/length².

    times : (T,), length², > 0. The diagonal of eq. (7), Sun et al. 2009; with the spectrum of an anisotropic
        operator, of eq. (17).
    Raises ParameterError if a time is not positive.
    """
    moments = positive_array("times", times)
    return np.asarray(spectrum.eigenfunctions**2 @ np.exp(-np.outer(spectrum.eigenvalues, moments)))


def heat_kernel_times(spectrum: Spectrum, count: int = 100) -> FloatArray:
    """The times of Sun et al. 2009, (count,), length²: geometric from 4 ln 10/λ_K to 4 ln 10/λ_1, the lowest
    non-zero eigenvalue.

    Raises ParameterError if the spectrum holds no non-zero eigenvalue.
    """
    count = count_in("count", count, 1, 1_000_000)
    highest = spectrum.eigenvalues[-1]
    rounding = max(1e-8 * highest, 1e-10 * 4 * np.pi / spectrum.mass.sum())
    moving = spectrum.eigenvalues[spectrum.eigenvalues > rounding]
    if not len(moving):
        raise ParameterError("spectrum must hold a non-zero eigenvalue to take times from. Compute more of them.")
    return np.asarray(4 * np.log(10) / np.geomspace(highest, moving[0], count))
