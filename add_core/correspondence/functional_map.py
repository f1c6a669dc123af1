"""Functional maps: a correspondence as a small matrix between the eigenfunctions of two shapes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array, issparse

from .._check import FloatArray, IntArray, array_of, count_in, descriptor_array, index_array, numbers, read_only
from ..descriptors.range import checked_spectrum
from ..errors import ParameterError
from ..geometry import TriangleMesh
from ..spectra import Spectrum
from .functional_equations import MapEquations, Weights, reduced_operators, unit_signals
from .nearest import nearest_matches
from .orientation import orientation_operators

SoftMatches = FloatArray | csr_array
"""(n2, n1): row x holds the shares in which point x of shape 2 belongs to the points of shape 1."""


@dataclass(frozen=True, eq=False)
class FunctionalMap:
    """A linear map of functions from shape 1 to shape 2, and the points from 2 to 1 that it stands for.

    map_12 : (k2, k1). Coefficients a of a function on shape 1 become C a on shape 2 (Ovsjanikov et al. 2012).
    spectrum_1, spectrum_2 : eigenfunctions of both; the first k1 and k2 are used.

    f₂ = f₁ ∘ match_21 whenever C comes from `match_21`: functions go forth as points go back.
    Raises ParameterError if C is larger than a spectrum or not finite.
    """

    map_12: FloatArray
    spectrum_1: Spectrum
    spectrum_2: Spectrum

    def __post_init__(self) -> None:
        matrix = np.array(descriptor_array("map_12", self.map_12))
        limit = len(self.spectrum_2.eigenvalues), len(self.spectrum_1.eigenvalues)
        if matrix.shape[0] > limit[0] or matrix.shape[1] > limit[1]:
            raise ParameterError(f"map_12 must be at most {limit} like the spectra, but it is {matrix.shape}.")
        object.__setattr__(self, "map_12", read_only(matrix))

    @classmethod
    def from_matches(
        cls,
        spectrum_1: Spectrum,
        spectrum_2: Spectrum,
        match_21: ArrayLike | SoftMatches,
        *,
        count: int | tuple[int, int] = 50,
    ) -> FunctionalMap:
        """The map of a correspondence: C = Φ₂ᵀ S₂ P Φ₁ with P f₁ = f₁ ∘ match_21.

        match_21 : (n2,), the vertex of shape 1 for each of shape 2; or soft, (n2, n1), rows of shares.
        count : eigenfunctions of both shapes, or (k1, k2).
        Raises ParameterError if the correspondence or the count does not fit the spectra.
        """
        k1, k2 = _counts(spectrum_1, spectrum_2, count)
        pulled = pulled_back(spectrum_1.eigenfunctions[:, :k1], match_21, len(spectrum_2.mass))
        matrix = spectrum_2.eigenfunctions[:, :k2].T @ (spectrum_2.mass[:, None] * pulled)
        return cls(np.asarray(matrix, dtype=np.float64), spectrum_1, spectrum_2)

    @classmethod
    def from_descriptors(
        cls,
        spectrum_1: Spectrum,
        spectrum_2: Spectrum,
        descriptors_1: ArrayLike,
        descriptors_2: ArrayLike,
        *,
        count: int | tuple[int, int] = 30,
        weights: Weights | None = None,
        meshes: tuple[TriangleMesh, TriangleMesh] | None = None,
        reverses: bool = False,
    ) -> FunctionalMap:
        """The map that carries descriptors of shape 1 to those of shape 2 and agrees with the shapes' operators best.

        Least squares over C of: descriptors, ‖C A₁ − A₂‖²; Laplacians, ‖C Λ₁ − Λ₂ C‖² (isometries commute with them);
        products with each descriptor, ‖C X₁ − X₂ C‖² (Nogneng & Ovsjanikov 2017), which make it a map of points;
        turning against each descriptor's gradient, ‖C Ω₁ ∓ Ω₂ C‖² (Ren et al. 2018), which tells left from right.

        descriptors_1 : (n1, d). descriptors_2 : (n2, d); each is scaled to unit length on its shape.
        count : eigenfunctions of both shapes, or (k1, k2). weights : of the four terms.
        meshes : both meshes, for the term of orientation; without them it is left out. reverses : the map turns
            the surface inside out like a mirror, so Ω₁ and −Ω₂ correspond.
        Raises ParameterError if arrays do not fit together or a descriptor is not finite.
        """
        k1, k2 = _counts(spectrum_1, spectrum_2, count)
        one = descriptor_array("descriptors_1", descriptors_1)
        two = descriptor_array("descriptors_2", descriptors_2, width=one.shape[1])
        for name, values, spectrum in (("descriptors_1", one, spectrum_1), ("descriptors_2", two, spectrum_2)):
            if len(values) != len(spectrum.mass):
                raise ParameterError(f"{name} must have {len(spectrum.mass)} rows, but it has {len(values)}.")
        signals = unit_signals(one, spectrum_1), unit_signals(two, spectrum_2)
        chosen = weights if weights is not None else Weights()
        equations = MapEquations.of(spectrum_1, spectrum_2, signals, (k1, k2), chosen)
        if chosen.products > 0:
            equations = equations.commuting(reduced_operators(signals, (spectrum_1, spectrum_2), (k1, k2)), 1.0)
        if meshes is not None and chosen.orientation > 0:
            pairs = orientation_operators(meshes, signals, (spectrum_1, spectrum_2), (k1, k2))
            equations = equations.commuting(pairs, -1.0 if reverses else 1.0, orientation=True)
        return cls(equations.solve(), spectrum_1, spectrum_2)

    @cached_property
    def match_21(self) -> IntArray:
        """(n2,): the vertex of shape 1 for each of shape 2, whose image under C lies nearest in coefficients."""
        k2, k1 = self.map_12.shape
        images = self.spectrum_1.eigenfunctions[:, :k1] @ self.map_12.T
        return read_only(nearest_matches(self.spectrum_2.eigenfunctions[:, :k2], images))

    @cached_property
    def match_12(self) -> IntArray:
        """(n1,): the vertex of shape 2 for each of shape 1, by the same embedding."""
        k2, k1 = self.map_12.shape
        images = self.spectrum_1.eigenfunctions[:, :k1] @ self.map_12.T
        return read_only(nearest_matches(images, self.spectrum_2.eigenfunctions[:, :k2]))

    def transfer(self, field_1: ArrayLike) -> FloatArray:
        """Carry a function (n1,) or several (n1, p) to shape 2: (n2,) or (n2, p), smooth as the eigenfunctions are.

        Φ₂ C Φ₁ᵀ S₁ f. Raises ParameterError if the field has another number of rows or is not finite.
        """
        k2, k1 = self.map_12.shape
        values = numbers("field_1", field_1)
        columns = descriptor_array("field_1", values[:, None] if values.ndim == 1 else values)
        if len(columns) != len(self.spectrum_1.mass):
            raise ParameterError(f"field_1 must have {len(self.spectrum_1.mass)} rows, but it has {len(columns)}.")
        coefficients = self.spectrum_1.eigenfunctions[:, :k1].T @ (self.spectrum_1.mass[:, None] * columns)
        carried = self.spectrum_2.eigenfunctions[:, :k2] @ (self.map_12 @ coefficients)
        return np.asarray(carried[:, 0] if values.ndim == 1 else carried)


def pulled_back(functions_1: FloatArray, match_21: ArrayLike | SoftMatches, n2: int) -> FloatArray:
    """Functions on shape 1, (n1, k), at the matches of shape 2's points: (n2, k).

    Raises ParameterError if the correspondence does not lead from `n2` points to the functions' n1.
    """
    n1 = len(functions_1)
    if not issparse(match_21) and array_of("match_21", match_21).ndim == 1:
        return np.asarray(functions_1[index_array("match_21", match_21, n1, count=n2)])
    soft = match_21 if issparse(match_21) else descriptor_array("match_21", match_21, width=n1)
    if soft.shape != (n2, n1):
        raise ParameterError(f"match_21 must have shape ({n2}, {n1}) or ({n2},), but it has {soft.shape}.")
    return np.asarray(soft @ functions_1)


def _counts(spectrum_1: Spectrum, spectrum_2: Spectrum, count: int | tuple[int, int]) -> tuple[int, int]:
    checked_spectrum(spectrum_1, name="spectrum_1")
    checked_spectrum(spectrum_2, name="spectrum_2")
    k1, k2 = count if isinstance(count, tuple) and len(count) == 2 else (count, count)
    return (
        count_in("count", k1, 1, len(spectrum_1.eigenvalues)),
        count_in("count", k2, 1, len(spectrum_2.eigenvalues)),
    )
