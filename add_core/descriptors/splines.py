"""Geometry vectors: the spectrum seen through a row of cubic B-splines, from which descriptors are learned."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline

from .._check import FloatArray, count_in, instance_of, positive_array
from ..errors import ParameterError
from ..spectra import SpectralFamily
from .filters import spectral_signature
from .range import checked_family

_DEGREE = 3
COVERED = 99.0
"""Percentile of the eigenvalues up to which the splines reach."""


def geometry_vectors(
    family: SpectralFamily, *, count: int = 150, reach: ArrayLike | None = None, normalize: bool = True
) -> FloatArray:
    """Geometry vectors g_m(x) = Σ_k β_m(λ_k) φ_k(x)², eq. (13), of every vertex and channel: (n, C, M).

    count : M ≥ 4 cubic B-splines on evenly spaced knots from 0 to `reach`; they sum to 1 in between and are 0 beyond.
    reach : (C,), 1/length²: where the last knot lies, of each channel. A network needs the reach of its training
        set (see `spline_reach`); None takes the family's own.
    normalize : scale every vector (the M numbers of one vertex and channel) to length 1, without unit; otherwise
        1/length².
    Vertices without mass have zeros. Raises ParameterError if `count` or `reach` is out of range.
    """
    checked_family(family)
    count = count_in("count", count, _DEGREE + 1, 100_000)
    ends = spline_reach([family]) if reach is None else positive_array("reach", reach)
    if len(ends) != len(family):
        raise ParameterError(
            f"reach must have one number for each of the {len(family)} channels, but it has {len(ends)}."
        )
    vectors = np.empty((len(family.mass), len(family), count))
    for channel, (spectrum, end) in enumerate(zip(family, ends, strict=True)):
        vectors[:, channel] = spectral_signature(spectrum, splines_at(spectrum.eigenvalues, count=count, reach=end))
    if normalize:
        length = np.linalg.norm(vectors, axis=2, keepdims=True)
        np.divide(vectors, length, out=vectors, where=length > 0)
    return vectors


def spline_reach(families: list[SpectralFamily]) -> FloatArray:
    """Where the splines of each channel end, (C,), 1/length²: the 99th percentile of the eigenvalues of its α in
    all `families`.

    Raises ParameterError if the families differ in their channels.
    """
    instance_of("families", families, list, tuple)
    if not families:
        raise ParameterError("families must hold at least one family, but it is empty.")
    first = checked_family(families[0])
    for family in families:
        if not (np.array_equal(family.alphas, first.alphas) and np.array_equal(family.thetas, first.thetas)):
            raise ParameterError("families must share their alphas and thetas, but they differ.")
    reach = np.empty(len(first))
    for alpha in np.unique(first.alphas):
        members = first.alphas == alpha
        reach[members] = np.percentile(np.concatenate([family.eigenvalues[members] for family in families]), COVERED)
    return reach


def splines_at(eigenvalues: FloatArray, *, count: int, reach: float) -> FloatArray:
    """β_m(λ_k): values (K, M) of the `count` cubic B-splines on [0, reach] at `eigenvalues` (K,)."""
    inner = np.linspace(0, reach, count - _DEGREE + 1)
    knots = np.concatenate([np.zeros(_DEGREE), inner, np.full(_DEGREE, reach)])
    values = np.zeros((len(eigenvalues), count))
    inside = eigenvalues <= reach
    if inside.any():
        values[inside] = BSpline.design_matrix(eigenvalues[inside], knots, _DEGREE).toarray()
    return values
