"""What a network sees of a point: geometry vectors of every channel, as logarithms of ratios, standardised."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._check import FloatArray, IntArray, count_in, read_only
from ..descriptors import spline_reach
from ..descriptors.splines import splines_at
from ..geometry import PointCloud, TriangleMesh, normalize
from ..operators import Conductivity
from ..spectra import SpectralFamily, compute_spectra
from .architectures import MULTIPLE, channel_count

Inputs = NDArray[np.float32]
Progress = Callable[[int, int], object]

FLOOR = 0.01
"""Where a point holds less than a hundredth of the average, by how much less is rounding and sampling."""
FEWEST_SPLINES = 4
FLAT = 0.05
"""Smallest standard deviation that is scaled up to 1: a spline on which all points agree holds noise only."""


@dataclass(frozen=True)
class InputRecipe:
    """How the inputs of a network come from a shape; part of a model, for another recipe would mean another input.

    alphas, angles : the channels, as for `compute_spectra`. eigenpairs : K. splines : M.
    conductivity : eq. (9) or (10).
    isotropic : give the network the one channel of α = 0, repeated for each of the others: its isotropic twin, which
        has the same layers and as many weights but no sense of direction.
    logarithm : of the ratios; without it inputs are geometry vectors up to one factor a spline, as linear descriptors
        want them.
    """

    alphas: tuple[float, ...] = MULTIPLE
    angles: int = 16
    eigenpairs: int = 300
    splines: int = 96
    conductivity: Conductivity = "curvature"
    isotropic: bool = False
    logarithm: bool = True

    def __post_init__(self) -> None:
        channel_count(self.alphas, self.angles)
        count_in("eigenpairs", self.eigenpairs, 2, 1_000_000)
        count_in("splines", self.splines, FEWEST_SPLINES, 100_000)

    @property
    def channels(self) -> int:
        """C."""
        return channel_count(self.alphas, self.angles)

    @property
    def mirror_channels(self) -> IntArray:
        """(C,): the channel that shows a shape as each channel shows its mirror image.

        A reflection turns θ into −θ, and θ has period π.
        """
        order: list[int] = []
        for alpha in self.alphas:
            first, angles = len(order), self.angles if alpha > 0 else 1
            order += [first + (angles - number) % angles for number in range(angles)]
        return read_only(np.array(order))

    def spectra(
        self,
        shape: TriangleMesh | PointCloud,
        *,
        progress: Progress | None = None,
        workers: int | None = None,
        cache: bool = True,
    ) -> SpectralFamily:
        """Spectra of the shape, brought to unit geodesic diameter first; arguments as of `compute_spectra`.

        A shape of fewer points than `eigenpairs` gives as many eigenpairs as it has points with area.
        """
        return compute_spectra(
            normalize(shape),
            alphas=(0.0,) if self.isotropic else self.alphas,
            angles=self.angles,
            count=min(self.eigenpairs, max(1, int(shape.has_mass.sum()))),
            conductivity=self.conductivity,
            progress=progress,
            workers=workers,
            cache=cache,
            dtype="float32",
        )

    def inputs(self, family: SpectralFamily) -> Inputs:
        """Inputs of every vertex, shape (n, C, M), before standardisation; see `relative_density`."""
        values = relative_density(family, count=self.splines)
        if not self.logarithm:
            np.subtract(np.exp(values, out=values), np.float32(FLOOR), out=values)
        return np.repeat(values, self.channels, axis=1) if self.isotropic else values


def relative_density(family: SpectralFamily, *, count: int) -> Inputs:
    """log(g_m(x) / ḡ_m + 0.01) for geometry vectors g, eq. (13), and their mean ḡ over the surface: (n, C, M), float32.

    By orthonormality ḡ_m = Σ_k β_m(λ_k) / area, so a ratio of 1 is what a point would have if all points were alike.
    The splines of each α reach to the 99th percentile of the shape's **own** eigenvalues. Neither size, nor a rough
    surface that slows heat everywhere at large α, then moves the inputs, and no spline is ever empty: with the reach
    of a training set, the rougher skin of a scan shifts every spline.
    """
    reach, area = spline_reach([family]), float(family.mass.sum())
    values = np.empty((len(family.mass), len(family), count), dtype=np.float32)
    for channel, (spectrum, end) in enumerate(zip(family, reach, strict=True)):
        splines = splines_at(spectrum.eigenvalues, count=count, reach=end)
        mean = np.maximum(splines.sum(axis=0), 1e-9) / area
        values[:, channel] = (np.asarray(spectrum.eigenfunctions) ** 2) @ (splines / mean).astype(np.float32)
    np.log(values + np.float32(FLOOR), out=values)
    return values


@dataclass(frozen=True, eq=False)
class Moments:
    """Mean and standard deviation of inputs over a surface, each (C, M) float32."""

    mean: Inputs
    deviation: Inputs

    @classmethod
    def of(cls, values: NDArray[np.floating], mass: FloatArray) -> Moments:
        """Moments over a surface of `values` (n, C, M) at points of area `mass` (n,): dense sampling counts no more."""
        weights = (mass / mass.sum()).astype(np.float32)
        mean = np.tensordot(weights, values, axes=1).astype(np.float32)
        variance = sum(
            np.tensordot(part, (block.astype(np.float32) - mean) ** 2, axes=1)
            for part, block in zip(np.array_split(weights, 16), np.array_split(values, 16), strict=True)
        )
        return cls(read_only(mean), read_only(np.sqrt(variance).astype(np.float32)))

    @classmethod
    def pooled(cls, parts: list[Moments]) -> Moments:
        """Moments of several surfaces together, each counting the same."""
        mean = np.mean([part.mean for part in parts], axis=0)
        square = np.mean([part.deviation**2 + (part.mean - mean) ** 2 for part in parts], axis=0)
        return cls(read_only(mean.astype(np.float32)), read_only(np.sqrt(square).astype(np.float32)))

    def standardise(self, values: NDArray[np.floating]) -> Inputs:
        """`values` of shape (…, C, M) less the mean, over the deviation, as float32."""
        scaled = (values - self.mean) / np.maximum(self.deviation, np.float32(FLAT))
        return np.asarray(scaled, dtype=np.float32)
