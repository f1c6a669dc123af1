"""The symmetry that a shape's own descriptors show, rough but enough to turn a map round with."""

from __future__ import annotations

import numpy as np
from scipy.spatial.distance import cdist

from .._check import FloatArray
from ..spectra import Spectrum
from .involution import grown_involution, involution_of_matches
from .zoomout import sampled_by_area

SAMPLES = 1000
SLOWEST = 10
"""Eigenfunctions that say how far apart points are: as ways to spread over the whole shape, not as lengths."""
NEARBY = 0.5
"""Share of the median squared distance within which a point's own likeness is not sought: it is most like itself."""
START = 12


def own_symmetry(spectrum: Spectrum, descriptors: FloatArray, size: int, *, seed: int = 0) -> FloatArray:
    """The symmetric orthogonal map (size, size) of the involution under which descriptors (n, d) look most alike.

    Sampled points are matched to those most like them among the points far away (by the biharmonic distance of Lipman
    et al. 2010), and the map of these matches grows by ZoomOut, an involution at every step. On a shape without
    symmetry it is a map of no meaning: judge what it leads to.
    """
    rows = sampled_by_area(spectrum, SAMPLES, seed)
    values = spectrum.eigenvalues
    slow = np.flatnonzero(values > 1e-8 * values[-1])[:SLOWEST]
    places = spectrum.eigenfunctions[np.ix_(rows, slow)] / values[slow]
    apart = cdist(places, places, "sqeuclidean")
    unlike = cdist(descriptors[rows], descriptors[rows], "sqeuclidean")
    unlike[apart <= NEARBY * np.median(apart)] = np.inf
    start = involution_of_matches(spectrum, rows, rows[unlike.argmin(axis=1)], min(START, size))
    return grown_involution(spectrum, start, rows, size)
