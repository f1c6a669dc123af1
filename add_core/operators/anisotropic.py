"""The anisotropic Laplacian: heat that runs faster in one direction than in another."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from .._check import FloatArray, at_least_zero, finite, instance_of, one_of, read_only
from ..errors import GeometryError, ParameterError
from ..geometry import PointCloud, PrincipalFrames, TriangleMesh, principal_curvatures
from .diffusivity import CONDUCTIVITIES, Conductivity, Diffusivity
from .elements import Elements, directional_parts
from .pattern import SparsityPattern

LARGEST_ALPHA = 1e30
"""Beyond it products of conductivities soon vanish in float64."""


class AnisotropicLaplacian:
    r"""The operator :math:`Δ_{α,θ} f = -\mathrm{div}(R_θ D_α R_θ^\top ∇f)` of section 4 on one shape, for every
    angle θ.

    shape : TriangleMesh or PointCloud, in its own length unit; nothing is rescaled.
    alpha : degree of anisotropy α ≥ 0; 0 is the isotropic Laplacian exactly (the cotangent formula on a mesh).
        In the unit of length with "curvature", without unit with "constant".
    conductivity : how heat runs along u_M and u_m, the directions of maximum and minimum curvature, at θ = 0.
        "curvature", eq. (9): ψ(κ_m) along u_M and ψ(κ_M) along u_m, ψ(x) = 1/(1 + α|x|);
        "constant", eq. (10): 1 along u_M and 1/(1 + α) along u_m.
    frames : the shape's principal frames if they are known already. `from_directions` and `from_tensors` take
        fields of your own in place of the models.

    The discrete operator is S⁻¹W with `mass` S and `stiffness(theta)` W = W₀ + cos 2θ W_c + sin 2θ W_s: symmetric,
    positive SEMI-definite, with constants in its kernel. θ is in radians, counter-clockwise about the outward
    normal from u_M; everything has period π. Faces without area and vertices of no face take no part: their rows of
    W and S are zero.

    Raises GeometryError if the shape has no area, ParameterError if α or `conductivity` is out of range.
    """

    alpha: float | None
    """α of the model; None for a field of your own."""
    conductivity: Conductivity | None
    """Which model; None for a field of your own."""

    def __init__(
        self,
        shape: TriangleMesh | PointCloud,
        *,
        alpha: float = 50.0,
        conductivity: Conductivity = "curvature",
        frames: PrincipalFrames | None = None,
    ) -> None:
        instance_of("shape", shape, TriangleMesh, PointCloud)
        self.alpha = _degree(alpha)
        self.conductivity = _conductivity(conductivity)
        frames = principal_curvatures(shape) if frames is None else _frames_of(shape, frames)
        self._discretise(shape, frames, Diffusivity.of_model(frames, self.alpha, self.conductivity))

    @classmethod
    def from_directions(
        cls, shape: TriangleMesh | PointCloud, directions: ArrayLike, *, along: ArrayLike, across: ArrayLike
    ) -> AnisotropicLaplacian:
        """The operator with conductivity `along` the axes of your own `directions` and `across` them at θ = 0.

        directions : (m, 3), one per face of a mesh or point of a cloud; only the tangential axis counts.
        along, across : (m,) or one number, > 0, without unit.
        Raises GeometryError for a direction without tangential part, ParameterError for a conductivity not positive.
        """
        frames = principal_curvatures(shape)
        return cls._of(shape, Diffusivity.of_directions(frames, directions, along=along, across=across))

    @classmethod
    def from_tensors(cls, shape: TriangleMesh | PointCloud, tensors: ArrayLike) -> AnisotropicLaplacian:
        """The operator with your own conductivity tensors at θ = 0; θ turns each about its normal.

        tensors : (m, 3, 3), symmetric, one per face of a mesh or point of a cloud; their tangential part counts and
            must be positive definite.
        Raises GeometryError for a wrong shape, ParameterError for a tensor that is not symmetric and positive
        definite.
        """
        return cls._of(shape, Diffusivity.of_tensors(principal_curvatures(shape), tensors))

    @classmethod
    def _of(cls, shape: TriangleMesh | PointCloud, diffusivity: Diffusivity) -> AnisotropicLaplacian:
        other = object.__new__(cls)
        other.alpha = other.conductivity = None
        other._discretise(shape, diffusivity.frames, diffusivity)
        return other

    def _discretise(self, shape: TriangleMesh | PointCloud, frames: PrincipalFrames, diffusivity: Diffusivity) -> None:
        self.shape, self.frames = shape, frames
        self.elements = Elements.of(shape, frames)
        if not len(self.elements.areas):
            raise GeometryError(f"{shape!r} has no area, so no heat can run on it. Check its coordinates.")
        self.pattern = SparsityPattern.of(self.elements.corners, shape.vertex_count)
        self.mass = read_only(self.elements.masses(shape.vertex_count))
        self._assemblies = [self.pattern.assembly(part) for part in directional_parts(self.elements)]
        self._assemble(diffusivity)

    def _assemble(self, diffusivity: Diffusivity) -> None:
        rows = self.elements.frames
        self._along, self._across = diffusivity.along[rows], diffusivity.across[rows]
        mean, half = (self._along + self._across) / 2, (self._along - self._across) / 2
        isotropic, cosine, sine = self._assemblies
        self._mean, self._cosine, self._sine = isotropic @ mean, cosine @ half, sine @ half

    def with_alpha(self, alpha: float, *, conductivity: Conductivity | None = None) -> AnisotropicLaplacian:
        """The same shape's operator at another α or of the other model; elements and sparsity pattern are shared.

        Raises ParameterError if an argument is out of range or the operator has a field of its own in place of a
        model.
        """
        if self.conductivity is None:
            raise ParameterError("alpha belongs to the two models, but this operator has a field of its own.")
        other = object.__new__(AnisotropicLaplacian)
        other.__dict__.update(self.__dict__)
        other.alpha = _degree(alpha)
        other.conductivity = _conductivity(self.conductivity if conductivity is None else conductivity)
        other._assemble(Diffusivity.of_model(self.frames, other.alpha, other.conductivity))
        return other

    def stiffness_values(self, theta: float) -> FloatArray:
        """Entries (nnz,) of W(θ) on `pattern`."""
        angle = 2 * finite("theta", theta)
        return np.asarray(self._mean + np.cos(angle) * self._cosine + np.sin(angle) * self._sine)

    def stiffness(self, theta: float = 0.0) -> csr_array:
        """Stiffness matrix W(θ) (n, n), without unit: symmetric, positive SEMI-definite, row sums zero; eq. (24).

        theta : radians, counter-clockwise about the outward normal from the direction of maximum curvature; period π.
        """
        return self.pattern.matrix(self.stiffness_values(theta))

    def weyl_eigenvalue(self, index: int) -> float:
        """Weyl's estimate of λ_index, 1/length²: 4π·index / Σ area/√(along·across), the same for every θ."""
        return float(
            4
            * np.pi
            * at_least_zero("index", index)
            / np.sum(self.elements.weighted_areas / np.sqrt(self._along * self._across))
        )


def _degree(alpha: float) -> float:
    if at_least_zero("alpha", alpha) > LARGEST_ALPHA:
        raise ParameterError(f"alpha must be from 0 to {LARGEST_ALPHA:g}, or no heat moves at all, but it is {alpha}.")
    return float(alpha)


def _conductivity(value: Conductivity) -> Conductivity:
    one_of("conductivity", value, CONDUCTIVITIES)
    return value


def _frames_of(shape: TriangleMesh | PointCloud, frames: PrincipalFrames) -> PrincipalFrames:
    instance_of("frames", frames, PrincipalFrames)
    rows = len(shape.faces) if isinstance(shape, TriangleMesh) else shape.vertex_count
    if len(frames.normals) != rows:
        what = "faces" if isinstance(shape, TriangleMesh) else "points"
        raise GeometryError(
            f"frames must have one row for each of the {rows} {what}, but they have {len(frames.normals)}. "
            "Are they another shape's?"
        )
    return frames
