"""Eigenfunctions of the operator at hand: computed by a process, since an eigensolver would hold up the window."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from add_core.errors import ShapeFileError
from add_core.geometry import TriangleMesh

from ..models.diffusion import Conductivity, Diffusion
from ..models.shapes import OpenShape, Shape

FloatArray = NDArray[np.float64]

COUNT = 300


@dataclass(frozen=True, eq=False)
class Eigenpairs:
    """eigenvalues : (K,), 1/⌀². eigenfunctions : (n, K), 1/⌀, single precision."""

    eigenvalues: FloatArray
    eigenfunctions: NDArray[np.float32]


@dataclass(frozen=True)
class SpectrumQuestion:
    """The lowest eigenpairs of one operator of a shape. degrees : θ, in steps of half a degree."""

    reference: str
    shape: Shape
    conductivity: Conductivity
    alpha: float
    degrees: float
    shape_name: str = field(compare=False)

    kind = "spectra"
    file_name = "spectrum.npz"

    @classmethod
    def of(cls, shape: OpenShape, diffusion: Diffusion) -> SpectrumQuestion:
        """At α = 0 neither θ nor the model matters."""
        if diffusion.alpha == 0:
            return cls(shape.reference, shape.shape, "curvature", 0.0, 0.0, shape.name)
        angle = round(2 * degrees(diffusion.theta)) / 2
        return cls(shape.reference, shape.shape, diffusion.conductivity, diffusion.alpha, angle, shape.name)

    @property
    def title(self) -> str:
        return f"the eigenfunctions of {self.shape_name}"

    @property
    def count(self) -> int:
        """K: as many as in the paper, or as the shape has."""
        used = int(self.shape.is_referenced.sum()) if isinstance(self.shape, TriangleMesh) else self.shape.vertex_count
        return max(1, min(COUNT, used - 1))

    def arguments(self, output: Path) -> tuple[str, ...]:
        """The isotropic spectrum is kept on disk by the core, those of single angles are not."""
        one = ("--theta", f"{self.degrees:g}") if self.alpha > 0 else ()
        options = ("--alphas", f"{self.alpha:g}", *one, "--count", str(self.count), "--precision", "float64")
        return ("spectra", self.reference, *options, "--conductivity", self.conductivity, "-o", str(output))

    def read(self, output: Path, said: Mapping[str, Any]) -> Eigenpairs:
        """Raises ShapeFileError if the file fits another shape."""
        with np.load(output, allow_pickle=False) as archive:
            values, functions = archive["eigenvalues"][0], archive["eigenfunctions"][0]
        if len(functions) != self.shape.vertex_count:
            raise ShapeFileError(f"{self.reference} has changed since it was opened. Open it again.")
        return Eigenpairs(values, functions.astype(np.float32))
