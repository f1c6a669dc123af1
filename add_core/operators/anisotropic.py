"""The anisotropic Laplacian: heat that runs faster in one direction than in another."""

from __future__ import annotations

import logging
from typing import Literal, get_args

import numpy as np
from scipy.sparse import csr_array

from .._check import FloatArray, at_least_zero, finite, one_of, read_only
from ..errors import GeometryError
from ..geometry import PointCloud, PrincipalFrames, TriangleMesh, principal_curvatures
from .elements import Elements, directional_parts
from .pattern import SparsityPattern

Conductivity = Literal["curvature", "constant"]
_log = logging.getLogger(__name__)


class AnisotropicLaplacian:
    r"""The operator :math:`Δ_{α,θ} f = -\mathrm{div}(R_θ D_α R_θ^\top ∇f)` of section 4 on one shape, for every
    angle θ.

    shape : TriangleMesh or PointCloud, in its own length unit; nothing is rescaled.
    alpha : degree of anisotropy α ≥ 0; 0 is the isotropic Laplacian exactly (the cotangent formula on a mesh).
        In the unit of length with "curvature", without unit with "constant".
    conductivity : how heat runs along u_M and u_m, the directions of maximum and minimum curvature, at θ = 0.
        "curvature", eq. (9): ψ(κ_m) along u_M and ψ(κ_M) along u_m, ψ(x) = 1/(1 + α|x|);
        "constant", eq. (10): 1 along u_M and 1/(1 + α) along u_m.
    frames : the shape's principal frames if they are known already, or frames of your own.

    The discrete operator is S⁻¹W with `mass` S and `stiffness(theta)` W = W₀ + cos 2θ W_c + sin 2θ W_s: symmetric,
    positive SEMI-definite, with constants in its kernel. θ is in radians, counter-clockwise about the outward
    normal from u_M; everything has period π. Faces without area and vertices of no face take no part: their rows of
    W and S are zero.

    Raises GeometryError if the shape has no area, ParameterError if α or `conductivity` is out of range.
    """

    def __init__(
        self,
        shape: TriangleMesh | PointCloud,
        *,
        alpha: float = 50.0,
        conductivity: Conductivity = "curvature",
        frames: PrincipalFrames | None = None,
    ) -> None:
        at_least_zero("alpha", alpha)
        one_of("conductivity", conductivity, get_args(Conductivity))
        frames = principal_curvatures(shape) if frames is None else _frames_of(shape, frames)
        elements = Elements.of(shape, frames)
        if not len(elements.areas):
            raise GeometryError(f"{shape!r} has no area, so no heat can run on it. Check its coordinates.")
        pattern = SparsityPattern.of(elements.corners, shape.vertex_count)
        mass = read_only(elements.masses(shape.vertex_count))
        self._settle(shape, float(alpha), conductivity, frames, elements, pattern, mass)

    def _settle(
        self,
        shape: TriangleMesh | PointCloud,
        alpha: float,
        conductivity: Conductivity,
        frames: PrincipalFrames,
        elements: Elements,
        pattern: SparsityPattern,
        mass: FloatArray,
    ) -> None:
        self.shape, self.alpha, self.conductivity = shape, alpha, conductivity
        self.frames, self.elements, self.pattern, self.mass = frames, elements, pattern, mass
        along, across = self.conductivities()
        parts = directional_parts(elements, along=along, across=across)
        self._mean, self._cosine, self._sine = (pattern.gather(part) for part in parts)

    def with_alpha(self, alpha: float, *, conductivity: Conductivity | None = None) -> AnisotropicLaplacian:
        """The same shape's operator at another α or conductivity model; frames and sparsity pattern are shared."""
        conductivity = self.conductivity if conductivity is None else conductivity
        at_least_zero("alpha", alpha)
        one_of("conductivity", conductivity, get_args(Conductivity))
        other = object.__new__(AnisotropicLaplacian)
        other._settle(self.shape, float(alpha), conductivity, self.frames, self.elements, self.pattern, self.mass)
        return other

    def conductivities(self) -> tuple[FloatArray, FloatArray]:
        """Conductivity of each element along and across the turned axis u_M, each (t,), in (0, 1], without unit."""
        rows = self.elements.frames
        if self.conductivity == "constant":
            return np.ones(len(rows)), np.full(len(rows), 1 / (1 + self.alpha))
        along = 1 / (1 + self.alpha * np.abs(self.frames.min_curvature[rows]))
        across = 1 / (1 + self.alpha * np.abs(self.frames.max_curvature[rows]))
        return along, across

    def stiffness_values(self, theta: float) -> FloatArray:
        """Entries (nnz,) of W(θ) on `pattern`."""
        finite("theta", theta)
        if self.alpha == 0:
            return self._mean.copy()
        return np.asarray(self._mean + np.cos(2 * theta) * self._cosine + np.sin(2 * theta) * self._sine)

    def stiffness(self, theta: float = 0.0) -> csr_array:
        """Stiffness matrix W(θ) (n, n), without unit: symmetric, positive SEMI-definite, row sums zero; eq. (24).

        theta : radians, counter-clockwise about the outward normal from the direction of maximum curvature; period π.
        """
        return self.pattern.matrix(self.stiffness_values(theta))

    def weyl_eigenvalue(self, index: int) -> float:
        """Weyl's estimate of λ_index, 1/length²: 4π·index / Σ area/√(along·across), the same for every θ."""
        along, across = self.conductivities()
        return float(4 * np.pi * index / np.sum(self.elements.weighted_areas / np.sqrt(along * across)))


def _frames_of(shape: TriangleMesh | PointCloud, frames: PrincipalFrames) -> PrincipalFrames:
    rows = len(shape.faces) if isinstance(shape, TriangleMesh) else shape.vertex_count
    if len(frames.normals) != rows:
        what = "faces" if isinstance(shape, TriangleMesh) else "points"
        raise GeometryError(
            f"frames must have one row for each of the {rows} {what}, but they have {len(frames.normals)}. "
            "Are they another shape's?"
        )
    return frames
