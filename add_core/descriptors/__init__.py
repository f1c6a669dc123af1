"""Signatures of points, from the spectra of their shapes."""

from .anisotropic import angular_contrast, anisotropic_heat_kernel_signature, anisotropic_heat_kernel_times
from .filters import spectral_kernel, spectral_signature
from .heat import (
    heat_kernel_signature,
    heat_kernel_times,
    scale_invariant_heat_kernel_signature,
    scaled_heat_kernel_signature,
)
from .smoothing import smoothed
from .splines import geometry_vectors, spline_reach
from .wave import WaveEnergies, wave_kernel_energies, wave_kernel_signature
from .windowed_fourier import heat_window, windowed_fourier_descriptor, windowed_fourier_transform

__all__ = [
    "WaveEnergies",
    "angular_contrast",
    "anisotropic_heat_kernel_signature",
    "anisotropic_heat_kernel_times",
    "geometry_vectors",
    "heat_kernel_signature",
    "heat_kernel_times",
    "heat_window",
    "scale_invariant_heat_kernel_signature",
    "scaled_heat_kernel_signature",
    "smoothed",
    "spectral_kernel",
    "spectral_signature",
    "spline_reach",
    "wave_kernel_energies",
    "wave_kernel_signature",
    "windowed_fourier_descriptor",
    "windowed_fourier_transform",
]
