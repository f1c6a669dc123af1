"""Descriptors without what changes from each vertex to the next: noise of the meshing, not of the shape."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import diags_array
from scipy.sparse.linalg import splu

from .._check import FloatArray, positive
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh
from ..operators import AnisotropicLaplacian

COLUMNS_AT_ONCE = 64


def smoothed(shape: TriangleMesh | PointCloud, values: NDArray[np.floating], *, strength: float = 4.0) -> FloatArray:
    """Values (n, …) of the vertices of a shape, less what changes over one or two edges.

    Solves (D + s² S D⁻¹ S) x = D y for values y, with the isotropic stiffness S, its diagonal D and the strength s: a
    low-pass filter 1 / (1 + s²μ²) in the eigenvalues μ, 0 to about 2, of S against D. Unlike the mass, D makes it a
    matter of edges and not of lengths, so that finely meshed fingers keep their fingertips. Constants, and vertices
    of no face, stay as they are.

    Raises ParameterError if `values` has not a row for each vertex.
    """
    given = np.asarray(values, dtype=np.float64)
    if given.ndim < 1 or len(given) != shape.vertex_count:
        raise ParameterError(
            f"values must have a row for each of the {shape.vertex_count} vertices, but their shape is {given.shape}."
        )
    rate = positive("strength", strength)
    stiffness = AnisotropicLaplacian(shape, alpha=0.0).stiffness().tocsc()
    diagonal = stiffness.diagonal()
    diagonal = np.where(diagonal > 0, diagonal, 1.0)
    # 1 / (1 + s²μ²) is the real part of 1 / (1 + isμ), whose matrix has no more entries than S.
    factors = splu(
        (diags_array(diagonal.astype(complex)) + 1j * rate * stiffness).tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    flat = given.reshape(len(given), -1)
    found = np.empty_like(flat)
    for low in range(0, flat.shape[1], COLUMNS_AT_ONCE):
        block = slice(low, low + COLUMNS_AT_ONCE)
        found[:, block] = factors.solve((flat[:, block] * diagonal[:, None]).astype(complex)).real
    return found.reshape(given.shape)
