"""Which part of a spectrum says something."""

from __future__ import annotations

import numpy as np

from ..errors import ParameterError
from ..spectra import Spectrum


def lowest_nonzero_eigenvalue(spectrum: Spectrum) -> float:
    """λ_1, 1/length²: the lowest eigenvalue above rounding; a shape of several pieces has several zeros before it.

    Raises ParameterError if all of them are zero.
    """
    rounding = max(1e-8 * spectrum.eigenvalues[-1], 1e-10 * 4 * np.pi / spectrum.mass.sum())
    moving = spectrum.eigenvalues[spectrum.eigenvalues > rounding]
    if not len(moving):
        raise ParameterError("spectrum must hold a non-zero eigenvalue, but all are zero. Compute more of them.")
    return float(moving[0])
