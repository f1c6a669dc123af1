"""Which part of a spectrum says something."""

from __future__ import annotations

import numpy as np

from ..errors import ParameterError
from ..spectra import SpectralFamily, Spectrum


def checked_spectrum(spectrum: Spectrum, *, name: str = "spectrum") -> Spectrum:
    """`spectrum` itself, called `name` in complaints.

    Raises ParameterError if it is none, above all if it is a whole family.
    """
    if np.ndim(getattr(spectrum, "eigenvalues", 0.0)) != 1:
        raise ParameterError(
            f"{name} must be that of one operator, but it is a {type(spectrum).__name__}. "
            "Take one of a family, family[0], or compute_spectrum."
        )
    return spectrum


def checked_family(family: SpectralFamily) -> SpectralFamily:
    """`family` itself. Raises ParameterError if it is none, above all if it is the spectrum of one operator."""
    if np.ndim(getattr(family, "alphas", 0.0)) != 1:
        raise ParameterError(f"family must be what compute_spectra returns, but it is a {type(family).__name__}.")
    return family


def lowest_nonzero_eigenvalue(spectrum: Spectrum) -> float:
    """λ_1, 1/length²: the lowest eigenvalue above rounding; a shape of several pieces has several zeros before it.

    Raises ParameterError if all of them are zero.
    """
    checked_spectrum(spectrum)
    rounding = 1e-8 * spectrum.eigenvalues[-1]
    if spectrum.eigenvalues[0] != 0:  # our own zeros are exact; those of other solvers are rounding
        rounding = max(rounding, 1e-10 * 4 * np.pi / spectrum.mass.sum())
    moving = spectrum.eigenvalues[spectrum.eigenvalues > rounding]
    if not len(moving):
        raise ParameterError("spectrum must hold a non-zero eigenvalue, but all are zero. Compute more of them.")
    return float(moving[0])
