"""Heat kernel signatures: how much heat stays."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, count_in, finite, positive, positive_array
from ..errors import ParameterError
from ..spectra import Spectrum
from .filters import spectral_signature
from .range import checked_spectrum, lowest_nonzero_eigenvalue

_SPAN = 24.0


def heat_kernel_signature(spectrum: Spectrum, times: ArrayLike) -> FloatArray:
    """HKS of every vertex, h_t(x, x) = Σ_k exp(−t λ_k) φ_k(x)²: (n, T), 1/length².

    times : (T,), length², > 0; `heat_kernel_times` chooses them. The diagonal of eq. (7), Sun et al. 2009; with the
    spectrum of an anisotropic operator, of eq. (17).
    Raises ParameterError if a time is not positive.
    """
    checked_spectrum(spectrum)
    moments = positive_array("times", times)
    return spectral_signature(spectrum, np.exp(-np.outer(spectrum.eigenvalues, moments)))


def heat_kernel_times(spectrum: Spectrum, count: int = 100) -> FloatArray:
    """The times of Sun et al. 2009, (count,), length²: geometric from 4 ln 10/λ_K to 4 ln 10/λ_1.

    λ_1 is the lowest non-zero eigenvalue. Raises ParameterError if the spectrum holds none.
    """
    count = count_in("count", count, 1, 1_000_000)
    lowest = lowest_nonzero_eigenvalue(spectrum)
    return np.asarray(4 * np.log(10) / np.geomspace(spectrum.eigenvalues[-1], lowest, count))


def scaled_heat_kernel_signature(spectrum: Spectrum, times: ArrayLike) -> FloatArray:
    """HKS divided by the heat trace Σ_k exp(−t λ_k) of its time, as Sun et al. 2009 compare signatures: (n, T),
    1/length².

    Its mass-weighted sum is 1 at every time, so that no time outweighs the others. Raises like
    `heat_kernel_signature`.
    """
    checked_spectrum(spectrum)
    moments = positive_array("times", times)
    trace = np.exp(-np.outer(spectrum.eigenvalues, moments)).sum(axis=0)
    return np.asarray(heat_kernel_signature(spectrum, moments) / trace)


def scale_invariant_heat_kernel_signature(
    spectrum: Spectrum,
    *,
    frequencies: int = 6,
    base: float = 2.0,
    first: float | None = None,
    last: float | None = None,
    step: float = 1 / 16,
) -> FloatArray:
    """SI-HKS of Bronstein and Kokkinos 2010: (n, frequencies), without unit; the same for a shape of any size.

    Heat is sampled at the logarithmic times base^τ, τ = first, first + step, …, last. The derivative of log h over
    τ knows no factor, and the modulus of its Fourier transform no shift: the lowest `frequencies` of it are kept.
    As in the paper τ spans 24; by default around the middle of the spectrum's own range of times, because the paper's
    1 to 25 fits shapes of its size only (on one of unit diameter all heat is even by then).
    Vertices without mass have zeros. Raises ParameterError if τ does not ascend.
    """
    step, base = positive("step", step), positive("base", base)
    if base <= 1:
        raise ParameterError(f"base must be greater than 1, so that times ascend with τ, but it is {base:g}.")
    start = _middle_exponent(spectrum, base) - _SPAN / 2 if first is None else finite("first", first)
    end = start + _SPAN if last is None else finite("last", last)
    if end - start < 2 * step:
        raise ParameterError(f"last must exceed first by two steps at least, but they are {end:g} and {start:g}.")
    count_in("the number of times, (last - first) / step,", int((end - start) / step), 2, 100_000)
    exponents = np.arange(start, end + step / 2, step)
    frequencies = count_in("frequencies", frequencies, 1, len(exponents) // 2)
    logarithm = np.full((len(spectrum.mass), len(exponents)), 0.0)
    heat = heat_kernel_signature(spectrum, base**exponents)
    np.log(heat, out=logarithm, where=heat > 0)
    spectrum_of_change = np.fft.fft(np.diff(logarithm, axis=1), axis=1)
    return np.abs(spectrum_of_change[:, :frequencies])


def _middle_exponent(spectrum: Spectrum, base: float) -> float:
    ends = heat_kernel_times(spectrum, 2)
    return float(np.log(ends).mean() / np.log(base))
