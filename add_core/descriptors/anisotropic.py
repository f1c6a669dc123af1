"""Anisotropic heat kernel signature: how much heat stays when it may run one way more easily than another."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, count_in, numbers, positive_array
from ..errors import ParameterError
from ..spectra import SpectralFamily, Spectrum
from .heat import heat_kernel_signature
from .range import checked_family, lowest_nonzero_eigenvalue

SPAN = 64.0
"""The last default time over the first. On people P(right side) is 0.81 up to here and 0.67 over all times."""


def anisotropic_heat_kernel_signature(family: SpectralFamily, times: ArrayLike) -> FloatArray:
    """AHKS of every vertex, h_{α,θ,t}(x, x), section 4.1: (n, C, T), 1/length², one channel for each (α, θ) of the
    family.

    times : (T,) for all channels or (C, T), length², > 0. Heat runs slower as α grows, so that channels of
        different α see comparable regions only at times of their own: `anisotropic_heat_kernel_times`.
    Raises ParameterError if a time is not positive or `times` has neither shape.
    """
    checked_family(family)
    moments = numbers("times", times)
    if moments.ndim < 2:
        moments = np.broadcast_to(positive_array("times", moments), (len(family), moments.size))
    if moments.ndim != 2 or len(moments) != len(family):
        raise ParameterError(f"times must be (T,) or ({len(family)}, T), but it is {moments.shape}.")
    channels = [heat_kernel_signature(spectrum, t) for spectrum, t in zip(family, moments, strict=True)]
    return np.stack(channels, axis=1)


def anisotropic_heat_kernel_times(family: SpectralFamily, count: int = 100) -> FloatArray:
    """Times for each channel, (C, count), length², from the spectra of one α, the same for all its θ.

    Geometric from ln 10/λ_K to `SPAN` times that, but not beyond the 4 ln 10/λ_1 of Sun et al. 2009; both averaged
    (geometrically) over the angles: one angle must not be compared with another at a different time. At later times
    heat has forgotten which way it set out: the odd part of the curve over θ, which tells left from right, sinks
    below what a change of pose does to its mean.
    Raises ParameterError if the spectrum of some operator holds no non-zero eigenvalue.
    """
    checked_family(family)
    times = np.empty((len(family), count_in("count", count, 1, 1_000_000)))
    for alpha in np.unique(family.alphas):
        members = np.flatnonzero(family.alphas == alpha)
        own = np.array([_ends(family[int(channel)]) for channel in members])
        first, last = np.exp(np.log(own).mean(axis=0))
        times[members] = np.geomspace(float(first), float(last), count)
    return times


def angular_contrast(values: FloatArray, alphas: ArrayLike) -> FloatArray:
    """Logarithms of directed signatures as their mean over θ and what each angle departs from it: (n, C + A, T).

    values : (n, C, T), ≥ 0, such as AHKS; alphas : (C,), of which there are A > 0 different ones. First come the C
    channels less the mean over all angles of their α (0 in an isotropic channel), then the A means. Means say where a
    point is and vary a hundred times as much between points as the departures, which say which way round it is: apart,
    either can be weighed. Vertices without mass, whose values are 0, have the logarithm of 10⁻³⁰⁰ in the means.
    Raises ParameterError if shapes do not fit or a value is negative.
    """
    values, degrees = numbers("values", values), numbers("alphas", alphas)
    if values.ndim != 3 or degrees.shape != (values.shape[1],):
        raise ParameterError(
            f"values must be (n, C, T) with one of alphas for each channel, but they are {values.shape} and "
            f"{degrees.shape}."
        )
    if not (values >= 0).all():
        raise ParameterError("values must be at least 0 to have logarithms, but some are not.")
    logarithms = np.log(np.maximum(values, 1e-300))
    means = np.stack([logarithms[:, degrees == alpha].mean(axis=1) for alpha in np.unique(degrees)], axis=1)
    return np.concatenate([logarithms - means[:, np.searchsorted(np.unique(degrees), degrees)], means], axis=1)


def _ends(spectrum: Spectrum) -> tuple[float, float]:
    last = 4 * np.log(10) / lowest_nonzero_eigenvalue(spectrum)
    first = np.log(10) / spectrum.eigenvalues[-1]
    return first, min(SPAN * first, last)
