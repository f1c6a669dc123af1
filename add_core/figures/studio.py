"""What every figure works with: shapes at unit size, their spectra, light, and a way to say how far it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from .._check import IntArray
from ..contest import Describer
from ..drawing.camera import Camera
from ..evaluation.samples import Sample, sample
from ..geometry import PointCloud, TriangleMesh, normalize, subsample
from ..io import Collection
from ..operators import AnisotropicLaplacian
from ..spectra import HeatFlow
from .cast import Cast
from .page import blank
from .quality import Quality
from .skies import Skies
from .stage import Stage

Step = Callable[[int, int], object]


@dataclass(frozen=True)
class Workshop:
    """Where networks are trained on request. minutes : for each, after its inputs are made. folder : keeps models."""

    folder: Path
    minutes: float


class Studio:
    """Makes things once and remembers them while figures are drawn."""

    def __init__(self, cast: Cast, quality: Quality, workshop: Workshop | None = None) -> None:
        """`step` may be replaced: it is called as step(done, total) along the way; what it raises ends the work."""
        self.cast, self.quality, self.workshop = cast, quality, workshop
        self.skies, self.describer = Skies(quality.sky), Describer(angles=quality.angles, count=quality.eigenpairs)
        self.step: Step = lambda done, total: None
        self._done = self._total = 0
        self.person = cache(self._person)
        self.flow = cache(self._flow)
        self.sample = cache(self._sample)
        self.unit = cache(self._unit)
        self.cloud = cache(self._cloud)

    def expect(self, steps: int) -> None:
        """Say of how many steps the figure at hand consists."""
        self._done, self._total = 0, steps
        self.step(0, steps)

    def done(self) -> None:
        """Say that a step is done."""
        self._done = min(self._done + 1, self._total)
        self.step(self._done, self._total)

    def listen(self, event: dict[str, Any]) -> None:
        """Hear from a training that it is alive, so that whoever watches can stop it."""
        self.step(self._done, self._total)

    def _person(self, index: int) -> TriangleMesh:
        """A mesh of the cast's collection at unit geodesic diameter."""
        shape = normalize(self.cast.collection[index])
        assert isinstance(shape, TriangleMesh)
        return shape

    def _sample(self, index: int, variant: str) -> Sample:
        """A shape of the cast's collection in one of its variants, in the collection's own unit."""
        return sample(self.cast.collection, index, variant)

    def _unit(self, of: Sample) -> TriangleMesh | PointCloud:
        """A sample's shape at unit geodesic diameter."""
        return normalize(of.shape)

    def _cloud(self, index: int) -> tuple[PointCloud, IntArray]:
        """Farthest points of `person`, and the vertex (n,) that each of them was."""
        mesh = self.person(index)
        part = subsample(mesh, min(self.quality.cloud_points, mesh.vertex_count))
        return part.cloud, part.indices

    def _flow(self, shape: TriangleMesh | PointCloud, alpha: float) -> HeatFlow:
        """Heat on a shape."""
        return HeatFlow(AnisotropicLaplacian(shape, alpha=alpha))

    def camera(self, azimuth: float, elevation: float, *, collection: Collection | None = None) -> Camera:
        """A view of the collection's shapes; azimuth 0 looks them in the face."""
        shown = self.cast.collection if collection is None else collection
        return Camera.facing(shown.up or "+z", shown.front or "-y", azimuth=azimuth, elevation=elevation)

    def stage(
        self, figure: Figure, box: tuple[float, float, float, float], camera: Camera, *, width: float, height: float
    ) -> Stage:
        """A stage in a `box` of inches that spans `width` × `height` diameters, or more."""
        return Stage(blank(figure, box), camera, self.quality, self.skies, width=width, height=height)
