"""A place where shapes stand side by side in their own unit, and marks stick to their skin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._check import FloatArray
from ..drawing.camera import Camera
from ..drawing.picture import draw_shape
from ..geometry import PointCloud, TriangleMesh
from .quality import Quality
from .skies import Skies


@dataclass(frozen=True, eq=False)
class Standing:
    """A shape on a stage. shift : (2,), what takes a point from the camera's axes to the stage's."""

    axes: Axes
    camera: Camera
    shape: TriangleMesh | PointCloud
    shift: FloatArray

    def seen(self, points: ArrayLike) -> FloatArray:
        """(…, 2): where points (…, 3) of the shape lie on the stage."""
        return np.asarray(self.camera.seen(np.asarray(points, dtype=np.float64))[..., :2] + self.shift)

    @property
    def box(self) -> tuple[FloatArray, FloatArray]:
        """Lower left and upper right corner (2,) of the shape on the stage."""
        places = self.seen(self.shape.vertices)
        return places.min(axis=0), places.max(axis=0)

    def mark(self, vertex: int, colour: Any = "white", *, ring: bool = False, size: float = 6.0) -> None:
        """A disc with a fine rim at a vertex; a ring for a mirror point, which has its partner's colour."""
        x, y = self.seen(self.shape.vertices[vertex])
        face, edge, width = ("white", colour, 0.3 * size) if ring else (colour, "white", 0.16 * size)
        if not ring and colour == "white":
            edge = "#22252a"
        self.axes.plot(x, y, "o", ms=size, mfc=face, mec=edge, mew=width, zorder=6)


class Stage:
    """Axes whose unit is that of the shapes (one geodesic diameter), drawn at exactly the dots of the file."""

    def __init__(
        self, axes: Axes, camera: Camera, quality: Quality, skies: Skies, *, width: float, height: float
    ) -> None:
        """width, height : what the axes span, in units; one of them grows so that both units are equally long."""
        inches = axes.get_figure().get_size_inches() * axes.get_position().size  # type: ignore[union-attr]
        self.inches_per_unit = float(min(inches[0] / width, inches[1] / height))
        self.width, self.height = inches / self.inches_per_unit
        axes.set(xlim=(0, self.width), ylim=(0, self.height), aspect="auto")
        self.axes, self.camera, self.quality, self._skies = axes, camera, quality, skies

    def stand(
        self,
        shape: TriangleMesh | PointCloud,
        at: Sequence[float],
        *,
        colours: ArrayLike | None = None,
        positions: ArrayLike | None = None,
        colour_map: FloatArray | None = None,
        camera: Camera | None = None,
    ) -> Standing:
        """Draw a shape with the middle of its box above `at` (x, y) and its lowest point there; paint as for
        `draw_shape`.
        """
        camera = self.camera if camera is None else camera
        picture = draw_shape(
            shape,
            camera,
            resolution=self.inches_per_unit * self.quality.dots,
            colours=colours,
            positions=positions,
            colour_map=colour_map,
            sky=self._skies.over(shape),
            oversampling=self.quality.oversampling,
        )
        seen = camera.seen(shape.vertices)[:, :2]
        shift = np.array(at) - (0.5 * (seen[:, 0].min() + seen[:, 0].max()), seen[:, 1].min())
        left, right, bottom, top = picture.extent
        extent = (left + shift[0], right + shift[0], bottom + shift[1], top + shift[1])
        # imshow would fit the axes to each picture.
        limits = self.axes.get_xlim(), self.axes.get_ylim()
        self.axes.imshow(picture.rgba, extent=extent, aspect="auto", interpolation="hanning", zorder=3)
        self.axes.set(xlim=limits[0], ylim=limits[1])
        return Standing(self.axes, camera, shape, shift)
