"""ZoomOut: a functional map refined by letting it grow."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, IntArray, count_in
from ..descriptors.range import checked_spectrum
from ..errors import ParameterError
from ..spectra import Spectrum
from .functional_map import FunctionalMap, SoftMatches
from .nearest import nearest_matches


def zoomout(
    spectrum_1: Spectrum,
    spectrum_2: Spectrum,
    initial: ArrayLike | SoftMatches | FunctionalMap,
    *,
    start: int = 20,
    stop: int = 120,
    step: int = 5,
    samples: int | None = 1500,
    seed: int = 0,
) -> FunctionalMap:
    """Refine a correspondence by spectral upsampling (Melzi et al. 2019).

    Matches are turned into a functional map of k eigenfunctions, that into matches, and k grows by `step`: what low
    frequencies agree upon guides the higher ones.

    spectrum_1, spectrum_2 : of the shape that functions come from, and of the one whose points are matched to it.
    initial : (n2,), vertices of shape 1 for those of shape 2, raw as they come; soft, (n2, n1); or a FunctionalMap,
        from whose own size the map then grows.
    start, stop : first and last number of eigenfunctions, at most those that the spectra hold (both are cut to that).
    samples : points of shape 2 on which the steps in between are made; the first and the last use all. None for all.
    seed : which points they are.
    Returns the map of `stop` eigenfunctions; its `match_21` (n2,) is the refined correspondence.
    Raises ParameterError if an argument is out of range or the correspondence does not fit.
    """
    checked_spectrum(spectrum_1, name="spectrum_1")
    checked_spectrum(spectrum_2, name="spectrum_2")
    most = min(len(spectrum_1.eigenvalues), len(spectrum_2.eigenvalues))
    if isinstance(initial, FunctionalMap):
        found = initial
    else:
        start = min(count_in("start", start, 1, 1_000_000), most)
        found = FunctionalMap.from_matches(spectrum_1, spectrum_2, initial, count=start)
    count_in("step", step, 1, 100_000)
    stop = min(count_in("stop", stop, 1, 1_000_000), most)
    size = min(found.map_12.shape)
    if stop < size:
        raise ParameterError(f"stop must be at least {size}, the size of the map to start with, but it is {stop}.")
    rows = None if samples is None else sampled_by_area(spectrum_2, samples, seed)
    if rows is not None and len(rows) == np.count_nonzero(spectrum_2.mass > 0):
        rows = None
    while size < stop:
        size = min(size + step, stop)
        chosen = rows if size < stop else None
        match_21 = _matches(found, chosen)
        found = FunctionalMap(_grown(found, match_21, chosen, size), spectrum_1, spectrum_2)
    return found


def sampled_by_area(spectrum: Spectrum, samples: int, seed: int) -> IntArray:
    """(samples,) vertices, ascending, or all that have mass if there are no more.

    Drawn by their share of the area, so that finely meshed hands and faces do not outvote the rest.
    """
    massive = np.flatnonzero(spectrum.mass > 0)
    if count_in("samples", samples, 1, 10**9) >= len(massive):
        return massive
    shares = spectrum.mass[massive] / spectrum.mass[massive].sum()
    drawn = np.random.default_rng(seed).choice(massive, size=samples, replace=False, p=shares)
    return np.sort(drawn)


def _matches(found: FunctionalMap, rows: IntArray | None) -> IntArray:
    if rows is None:
        return found.match_21
    k2, k1 = found.map_12.shape
    images = found.spectrum_1.eigenfunctions[:, :k1] @ found.map_12.T
    return nearest_matches(found.spectrum_2.eigenfunctions[rows, :k2], images)


def _grown(found: FunctionalMap, match_21: IntArray, rows: IntArray | None, size: int) -> FloatArray:
    pulled = found.spectrum_1.eigenfunctions[match_21, :size]
    functions = found.spectrum_2.eigenfunctions[:, :size]
    if rows is None:
        return np.asarray(functions.T @ (found.spectrum_2.mass[:, None] * pulled), dtype=np.float64)
    if len(rows) < 2 * size:  # too few equations to be trusted: shares of the area instead of least squares
        return np.asarray(functions[rows].T @ pulled * (found.spectrum_2.mass.sum() / len(rows)), dtype=np.float64)
    return np.asarray(np.linalg.lstsq(functions[rows], pulled, rcond=None)[0], dtype=np.float64)
