"""Anisotropic heat kernel signature: how much heat stays when it may run one way more easily than another."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, positive_array
from ..errors import ParameterError
from ..spectra import SpectralFamily
from .heat import heat_kernel_signature, heat_kernel_times


def anisotropic_heat_kernel_signature(family: SpectralFamily, times: ArrayLike) -> FloatArray:
    """AHKS of every vertex, h_{α,θ,t}(x, x), section 4.1: (n, C, T), 1/length², one channel for each (α, θ) of the
    family.

    times : (T,) for all channels or (C, T), length², > 0. Heat runs slower as α grows, so that channels of
        different α see
    comparable regions only at times of their own: `anisotropic_heat_kernel_times`.
    Raises ParameterError if a time is not positive or `times` has neither shape.
    """
    moments = np.asarray(times, dtype=np.float64)
    if moments.ndim < 2:
        moments = np.broadcast_to(positive_array("times", moments), (len(family), moments.size))
    if moments.ndim != 2 or len(moments) != len(family):
        raise ParameterError(f"times must be (T,) or ({len(family)}, T), but it is {moments.shape}.")
    channels = [heat_kernel_signature(spectrum, t) for spectrum, t in zip(family, moments, strict=True)]
    return np.stack(channels, axis=1)


def anisotropic_heat_kernel_times(family: SpectralFamily, count: int = 100) -> FloatArray:
    """Times for each channel, (C, count), length²: those of Sun et al. 2009 for the spectra of one α, the same for
    all its θ.

    Geometric from 4 ln 10/λ_K to 4 ln 10/λ_1, both averaged (geometrically) over the angles: one angle must not be
    compared with another at a different time.
    """
    times = np.empty((len(family), count))
    for alpha in np.unique(family.alphas):
        members = np.flatnonzero(family.alphas == alpha)
        own = np.array([heat_kernel_times(family[int(channel)], count) for channel in members])
        times[members] = np.exp(np.log(own).mean(axis=0))
    return times
