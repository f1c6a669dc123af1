"""Wave kernel signature: where a quantum particle of one energy is found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, count_in, numbers, positive, read_only
from ..errors import ParameterError
from ..spectra import Spectrum
from .filters import spectral_signature
from .range import lowest_nonzero_eigenvalue


@dataclass(frozen=True, eq=False)
class WaveEnergies:
    """energies : (E,), natural logarithms of eigenvalues. width : σ of the bands around them, same scale."""

    energies: FloatArray
    width: float


def wave_kernel_signature(spectrum: Spectrum, energies: ArrayLike, *, width: float) -> FloatArray:
    """WKS of every vertex: (n, E), 1/length², normalised as Aubry et al. 2011 do.

    WKS(x, e) = Σ_k τ_e(λ_k) φ_k(x)² / Σ_k τ_e(λ_k), τ_e(λ) = exp(−(e − log λ)²/(2 width²)), over the non-zero
    eigenvalues. Its mass-weighted sum is 1 at every energy.

    energies : (E,), natural logarithms of eigenvalues. width : σ > 0, same scale; `wave_kernel_energies` chooses
        both.
    Raises ParameterError for a width that is not positive or an energy that is not finite.
    """
    width = positive("width", width)
    levels = np.atleast_1d(numbers("energies", energies))
    if levels.ndim != 1 or not levels.size or not np.isfinite(levels).all():
        raise ParameterError("energies must be a list of finite numbers (logarithms of eigenvalues), but it is not.")
    lowest, eigenvalues = lowest_nonzero_eigenvalue(spectrum), spectrum.eigenvalues
    moving = eigenvalues >= lowest
    distance = (levels - np.log(eigenvalues[moving])[:, None]) ** 2 / (2 * width**2)
    # Only ratios count: measured from the nearest eigenvalue, no energy far from all of them divides zero by zero.
    band = np.exp(distance.min(axis=0) - distance)
    response = np.zeros((len(eigenvalues), len(levels)))
    response[moving] = band / band.sum(axis=0)
    return spectral_signature(spectrum, response)


def wave_kernel_energies(spectrum: Spectrum, count: int = 100) -> WaveEnergies:
    """The energies of Aubry et al. 2011: `count` from log λ_1 + 2σ to log λ_K − 2σ, evenly, with σ seven times
    their distance.

    Raises ParameterError if the spectrum holds fewer than two different non-zero eigenvalues.
    """
    count = count_in("count", count, 2, 1_000_000)
    low, high = np.log(lowest_nonzero_eigenvalue(spectrum)), np.log(spectrum.eigenvalues[-1])
    distance = (high - low) / (count - 1 + 4 * 7)
    if not distance > 0:
        raise ParameterError("spectrum must hold two different non-zero eigenvalues. Compute more of them.")
    width = 7 * distance
    return WaveEnergies(read_only(np.linspace(low + 2 * width, high - 2 * width, count)), float(width))
