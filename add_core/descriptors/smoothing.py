"""Descriptors without what changes from each vertex to the next: noise of the meshing, not of the shape."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array, eye_array

from .._check import FloatArray, positive
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh
from ..operators import AnisotropicLaplacian

LARGEST = 3.0
"""Bound of the eigenvalues of S against its diagonal: of each triangle's part they add up to 3, and one is 0."""
ACCURACY = 1e-12
MOST = 1000.0
"""Largest strength: as over so many edges. The series grows with its square root."""
COLUMNS_AT_ONCE = 32
"""So many stay in the cache for one step of the recurrence."""


def smoothed(shape: TriangleMesh | PointCloud, values: NDArray[np.floating], *, strength: float = 4.0) -> FloatArray:
    """Values (n, …) of the vertices of a shape, less what changes over one or two edges.

    Solves (D + s² S D⁻¹ S) x = D y for values y, with the isotropic stiffness S, its diagonal D and the strength s: a
    low-pass filter 1 / (1 + s²μ²) in the eigenvalues μ, 0 to at most 3, of S against D. Unlike the mass, D makes it a
    matter of edges and not of lengths, so that finely meshed fingers keep their fingertips. Constants, and vertices
    of no face, stay as they are. Time and memory grow in proportion to n.

    Raises ParameterError if `values` has not a row for each vertex, or the strength is not from 0 to 1000.
    """
    given = np.asarray(values, dtype=np.float64)
    if given.ndim < 1 or len(given) != shape.vertex_count:
        raise ParameterError(
            f"values must have a row for each of the {shape.vertex_count} vertices, but their shape is {given.shape}."
        )
    rate = positive("strength", strength)
    if rate > MOST:
        raise ParameterError(f"strength must be at most {MOST:g}, but it is {rate:g}.")
    stiffness = AnisotropicLaplacian(shape, alpha=0.0).stiffness()
    diagonal = stiffness.diagonal()
    averaging = csr_array(diags_array(1.0 / np.where(diagonal > 0, diagonal, 1.0)) @ stiffness)
    return _filtered(averaging, given.reshape(len(given), -1), rate).reshape(given.shape)


def _filtered(matrix: csr_array, values: FloatArray, rate: float) -> FloatArray:
    """1 / (1 + (rate · matrix)²) of values (n, d), by Clenshaw's recurrence of its Chebyshev series on 0 to LARGEST."""
    pole = complex(-1.0, 2.0 / (rate * LARGEST))  # the nearest singularity, where that interval is −1 to 1
    growth = abs(pole - np.sqrt(pole**2 - 1))
    degree = int(np.ceil(np.log(ACCURACY) / -np.log(max(growth, 1 / growth))))
    series = Chebyshev.interpolate(lambda μ: 1.0 / (1.0 + (rate * μ) ** 2), degree, [0.0, LARGEST]).coef
    twice = csr_array(matrix * (4.0 / LARGEST) - 2.0 * eye_array(len(values)))
    found = np.empty_like(values)
    for low in range(0, values.shape[1], COLUMNS_AT_ONCE):
        part = np.ascontiguousarray(values[:, low : low + COLUMNS_AT_ONCE])
        newer, older = np.zeros_like(part), np.zeros_like(part)
        for coefficient in series[:0:-1]:
            older *= -1.0
            older += twice @ newer
            older += coefficient * part
            newer, older = older, newer
        found[:, low : low + COLUMNS_AT_ONCE] = series[0] * part + 0.5 * (twice @ newer) - older
    return found
