"""Windowed Fourier transform on a shape: which frequencies a signal has near each point."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, count_in, numbers, positive
from ..errors import ParameterError
from ..spectra import Spectrum
from .range import checked_spectrum, lowest_nonzero_eigenvalue


def windowed_fourier_transform(
    spectrum: Spectrum, signals: ArrayLike, *, window: ArrayLike, frequencies: int | None = None
) -> FloatArray:
    r"""(S f)_{x,l} = Σ_k ĝ_k φ_k(x) ⟨f, φ_k φ_l⟩ for the lowest frequencies l, eq. (14): (n, P, L).

    Equals ⟨f, g_{x,l}⟩ with the atoms g_{x,l}(y) = φ_l(y) Σ_k ĝ_k φ_k(x) φ_k(y) of eq. (15): the window brought to
    x, then modulated. Unit: the signal's, over length.

    signals : (n,) or (n, P). window : (K,), the ĝ_k. frequencies : L from 1 to K; None for all.
    Raises ParameterError if a length does not fit or a value is not finite.
    """
    checked_spectrum(spectrum)
    functions, mass = spectrum.eigenfunctions, spectrum.mass
    f = numbers("signals", signals)
    f = f[:, None] if f.ndim == 1 else f
    if f.ndim != 2 or len(f) != len(mass) or not np.isfinite(f).all():
        raise ParameterError(
            f"signals must be finite, one row for each of the {len(mass)} vertices, but it is {f.shape}."
        )
    g = numbers("window", window)
    if g.shape != spectrum.eigenvalues.shape or not np.isfinite(g).all():
        raise ParameterError(
            f"window must be finite, one number for each of the {len(spectrum.eigenvalues)} eigenvalues, "
            f"but it is {g.shape}."
        )
    count = functions.shape[1] if frequencies is None else count_in("frequencies", frequencies, 1, functions.shape[1])
    windowed, modulated = functions * g, functions[:, :count]
    columns = [windowed @ (functions.T @ ((mass * column)[:, None] * modulated)) for column in f.T]
    return np.stack(columns, axis=1)


def heat_window(spectrum: Spectrum, *, spread: float = 1.0) -> FloatArray:
    """A window ĝ_k = exp(−t λ_k), scaled to length 1, (K,), that reaches over `spread` times a mean wavelength.

    spread : > 0, in units of the geometric mean of the shortest and longest wavelength of the spectrum.
    Raises ParameterError if it is not positive, or the spectrum holds no non-zero eigenvalue.
    """
    middle = np.sqrt(lowest_nonzero_eigenvalue(spectrum) * spectrum.eigenvalues[-1])
    values = np.exp(-(positive("spread", spread) ** 2) * spectrum.eigenvalues / middle)
    return np.asarray(values / np.linalg.norm(values))


def windowed_fourier_descriptor(
    spectrum: Spectrum, signals: ArrayLike, *, window: ArrayLike | None = None, frequencies: int = 16
) -> FloatArray:
    """Moduli of the windowed Fourier transform, (n, P, L), free of the eigenfunctions' arbitrary signs.

    signals : (n, P), such as geometry vectors (Boscaini et al. 2015). window : (K,), `heat_window` unless given.
    frequencies : L, at most K. Raises like `windowed_fourier_transform`.
    """
    window = heat_window(spectrum) if window is None else window
    return np.abs(windowed_fourier_transform(spectrum, signals, window=window, frequencies=frequencies))
