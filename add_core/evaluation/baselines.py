"""The paper's peers that need no learning, one interface for all: from spectra to a descriptor of every point."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .._check import FloatArray, IntArray, one_of
from ..correspondence import FunctionalMap, guided_zoomout, zoomout
from ..descriptors import (
    angular_contrast,
    anisotropic_heat_kernel_signature,
    anisotropic_heat_kernel_times,
    geometry_vectors,
    heat_kernel_times,
    scale_invariant_heat_kernel_signature,
    scaled_heat_kernel_signature,
    wave_kernel_energies,
    wave_kernel_signature,
    windowed_fourier_descriptor,
)
from ..spectra import SpectralFamily, Spectrum

NUMBERS = 16
"""Numbers of an isotropic descriptor, and of each channel of a directed one."""


def describe_with(name: str, family: SpectralFamily) -> FloatArray:
    """The descriptor `name`, one of BASELINES, of every vertex: (n, d).

    family : spectra of α = 0, and of one α > 0 at several angles for "ahks" and "geometry-vectors".
    Logarithms (values at short times are thousands of times those at long ones; not of SI-HKS and WFT), each column
    standardised over the shape.
    Raises ParameterError for an unknown name.
    """
    return BASELINES[one_of("name", name, tuple(BASELINES))](family)


def isotropic(family: SpectralFamily) -> Spectrum:
    """The spectrum of α = 0, from whose eigenfunctions (n, K) isotropic descriptors and functional maps are made."""
    return family[int(np.flatnonzero(family.alphas == 0)[0])]


def functional_map_matches(one: SpectralFamily, two: SpectralFamily) -> IntArray:
    """Functional maps (Ovsjanikov et al. 2012) from wave kernel signatures, as points: (n2,), `match_21`."""
    spectra = isotropic(one), isotropic(two)
    found = FunctionalMap.from_descriptors(*spectra, _waves(one), _waves(two), count=30)
    return np.asarray(found.match_21)


def refined_matches(
    one: SpectralFamily,
    two: SpectralFamily,
    match_21: IntArray,
    *,
    guides: tuple[FloatArray, FloatArray] | None = None,
    size: int = 120,
) -> FunctionalMap:
    """ZoomOut of matches (n2,) on the isotropic eigenfunctions of both shapes, guided by descriptors.

    guides : descriptors (n1, d) and (n2, d) that tell left from right; None takes AHKS, which families with an α > 0
        hold. size : eigenfunctions of the map. Families of α = 0 alone know no directions: `zoomout` without a guide.
    """
    spectra = isotropic(one), isotropic(two)
    if guides is None and not (one.alphas > 0).any():
        return zoomout(*spectra, match_21, stop=size)
    known = guides if guides is not None else (describe_with("ahks", one), describe_with("ahks", two))
    return guided_zoomout(*spectra, *known, initial=match_21, stop=size)


def _hks(family: SpectralFamily) -> FloatArray:
    return _standardised(np.log(np.maximum(_heat(family), 1e-300)), family)


def _si_hks(family: SpectralFamily) -> FloatArray:
    """Between the times of the heat kernel signature: the original's are for shapes hundreds of units large."""
    times = heat_kernel_times(isotropic(family), NUMBERS)
    values = scale_invariant_heat_kernel_signature(
        isotropic(family), frequencies=NUMBERS, first=float(np.log2(times.min())), last=float(np.log2(times.max()))
    )
    return _standardised(values, family)


def _wks(family: SpectralFamily) -> FloatArray:
    return _standardised(np.log(np.maximum(_waves(family), 1e-300)), family)


def _wft(family: SpectralFamily) -> FloatArray:
    moduli = windowed_fourier_descriptor(isotropic(family), _heat(family)[:, :1], frequencies=NUMBERS)
    return _standardised(moduli[:, 0], family)


def _heat(family: SpectralFamily) -> FloatArray:
    spectrum = isotropic(family)
    return scaled_heat_kernel_signature(spectrum, heat_kernel_times(spectrum, NUMBERS))


def _waves(family: SpectralFamily) -> FloatArray:
    spectrum = isotropic(family)
    chosen = wave_kernel_energies(spectrum, NUMBERS)
    return wave_kernel_signature(spectrum, chosen.energies, width=chosen.width)


def _ahks(family: SpectralFamily) -> FloatArray:
    """What the angles of every α > 0 depart from their mean, all together weighing as much as the mean itself."""
    values = anisotropic_heat_kernel_signature(family, anisotropic_heat_kernel_times(family, NUMBERS))
    directed = family.alphas > 0
    contrast = angular_contrast(values[:, directed], family.alphas[directed])
    weights = np.ones(contrast.shape[1])
    weights[: directed.sum()] = np.sqrt((contrast.shape[1] - directed.sum()) / directed.sum())
    shape = contrast.shape
    return np.asarray((_standardised(contrast, family).reshape(shape) * weights[:, None]).reshape(len(contrast), -1))


def _splines(family: SpectralFamily) -> FloatArray:
    return _standardised(np.log(geometry_vectors(family, count=64) + 1e-4), family)


def _standardised(values: FloatArray, family: SpectralFamily) -> FloatArray:
    """By mean and deviation over the surface, so that dense sampling of hands and faces counts no more."""
    flat, weights = values.reshape(len(values), -1), family.mass / family.mass.sum()
    used = weights > 0
    mean = weights[used] @ flat[used]
    spread = np.sqrt(weights[used] @ (flat[used] - mean) ** 2)
    return np.asarray((flat - mean) / np.where(spread > 1e-9, spread, 1.0))


BASELINES: dict[str, Callable[[SpectralFamily], FloatArray]] = {
    "hks": _hks,
    "si-hks": _si_hks,
    "wks": _wks,
    "wft": _wft,
    "ahks": _ahks,
    "geometry-vectors": _splines,
}
DIRECTED = ("ahks", "geometry-vectors")
"""Baselines that look at every angle."""
UNDIRECTED = ("fm", *(name for name in BASELINES if name not in DIRECTED))
"""Baselines, functional maps among them, that cannot tell left from right."""
