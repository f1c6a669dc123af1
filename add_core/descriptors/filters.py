"""Signatures and kernels of any transfer function of the spectrum, eq. (11)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .._check import FloatArray, numbers, vertex_index
from ..errors import ParameterError
from ..spectra import Spectrum
from .range import checked_spectrum

Transfer = Callable[[FloatArray], FloatArray]


def spectral_signature(spectrum: Spectrum, transfer: FloatArray | Transfer) -> FloatArray:
    """f_q(x) = Σ_k τ_q(λ_k) φ_k(x)² at every vertex, eq. (11): (n, Q), 1/length² times the unit of τ.

    transfer : (K, Q) values of the Q transfer functions at the eigenvalues, or a function from eigenvalues (K,) to
        them.
    Raises ParameterError if it has not one row of finite values for each eigenvalue.
    """
    checked_spectrum(spectrum)
    return np.asarray(spectrum.eigenfunctions**2 @ _responses(spectrum, transfer))


def spectral_kernel(spectrum: Spectrum, source: int, transfer: FloatArray | Transfer) -> FloatArray:
    """k_q(source, ·) = Σ_k τ_q(λ_k) φ_k(source) φ_k: (n, Q), 1/length² times the unit of τ.

    The band-pass sister of the heat kernel, eq. (17) with τ in place of exp(−tλ); transfer as in
    `spectral_signature`. Raises ParameterError for a source that is no vertex.
    """
    checked_spectrum(spectrum)
    source = vertex_index("source", source, len(spectrum.mass))
    weights = spectrum.eigenfunctions[source][:, None] * _responses(spectrum, transfer)
    return np.asarray(spectrum.eigenfunctions @ weights)


def _responses(spectrum: Spectrum, transfer: FloatArray | Transfer) -> FloatArray:
    values = numbers("transfer", transfer(spectrum.eigenvalues) if callable(transfer) else transfer)
    values = values[:, None] if values.ndim == 1 else values
    count = len(spectrum.eigenvalues)
    if values.ndim != 2 or len(values) != count:
        raise ParameterError(
            f"transfer must have one row for each of the {count} eigenvalues, but it is {values.shape}."
        )
    if not np.isfinite(values).all():
        raise ParameterError("transfer must be finite at every eigenvalue, but it is not. Mind λ = 0.")
    return values
