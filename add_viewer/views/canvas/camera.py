"""An upright camera that orbits the shape."""

from __future__ import annotations

from math import cos, radians, sin, tan

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

VIEW_ANGLE = 25.0
_MARGIN = 1.12
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def axis_vector(axis: str) -> FloatArray:
    """ "+z" → (0, 0, 1), "-y" → (0, -1, 0)."""
    return np.array(_AXES[axis[-1]]) * (-1.0 if axis.startswith("-") else 1.0)


class OrbitCamera:
    """Where the eye is: angles about the up axis, a focal point and a distance.

    Azimuth 0 looks the shape in the face; positive azimuths show its left side, positive elevations its top. The
    horizon stays level, so that a person never lies on their side by accident.
    """

    def __init__(self) -> None:
        self._up, self._front = axis_vector("+y"), axis_vector("+z")
        self.azimuth = self.elevation = 0.0
        self.focal = np.zeros(3)
        self.distance = 1.0

    def orient(self, up: str, front: str) -> None:
        """Say which axes of the shape point up and forward."""
        self._up, self._front = axis_vector(up), axis_vector(front)

    @property
    def direction(self) -> FloatArray:
        """(3,) unit, from the focal point to the eye."""
        side = np.cross(self._up, self._front)
        around, above = radians(self.azimuth), radians(self.elevation)
        level = cos(around) * self._front + sin(around) * side
        return cos(above) * level + sin(above) * self._up

    @property
    def axes(self) -> FloatArray:
        """(3, 3): rows are the picture's right, its up, and the way to the eye."""
        eye = self.direction
        above = radians(self.elevation)
        right = np.cross(self._up, eye) / max(cos(above), 1e-9)
        return np.stack([right, np.cross(eye, right), eye])

    def fit(self, points: FloatArray, aspect: float, above: float = 0.0, below: float = 0.0) -> None:
        """Move so that all `points` (n, 3) lie in a picture of this width / height, with a margin.

        above, below : shares of the picture's height, at its edges, that stay free.
        """
        seen = points @ self.axes.T
        low, high = seen.min(axis=0), seen.max(axis=0)
        self.focal = 0.5 * (low + high) @ self.axes
        width, height, depth = high - low
        half = 0.5 * _MARGIN * max(height / (1.0 - above - below), width / aspect, 1e-9)
        self.distance = half / tan(radians(VIEW_ANGLE / 2)) + 0.5 * depth
        self.pan(0.0, 0.5 * (below - above))

    def places(self, points: FloatArray, width: float, height: float) -> FloatArray:
        """(n, 2): where points (n, 3) are in a picture of this size, right of and below its upper left corner."""
        x, y, near = ((points - self.focal) @ self.axes.T).T
        scale = height / self.picture_height * self.distance / np.maximum(self.distance - near, 1e-9)
        return np.stack([0.5 * width + scale * x, 0.5 * height - scale * y], axis=1)

    def rotate(self, dx: float, dy: float) -> None:
        """Turn by degrees; the elevation stops short of the poles."""
        self.azimuth = (self.azimuth - dx + 180.0) % 360.0 - 180.0
        self.elevation = min(max(self.elevation + dy, -89.0), 89.0)

    def pan(self, dx: float, dy: float) -> None:
        """Shift the picture by shares of its height, right and up."""
        right, up, _ = self.axes
        self.focal = self.focal - self.picture_height * (dx * right + dy * up)

    def zoom(self, factor: float, x: float = 0.0, y: float = 0.0) -> None:
        """Come closer by `factor`; the place at (x, y), in picture heights from its centre, stays where it is."""
        before = self.picture_height
        self.distance = min(max(self.distance / factor, 1e-3), 1e3)
        right, up, _ = self.axes
        self.focal = self.focal + (before - self.picture_height) * (x * right + y * up)

    def face(self, other: OrbitCamera) -> None:
        """Turn to the angles of another camera."""
        self.azimuth, self.elevation = other.azimuth, other.elevation

    @property
    def picture_height(self) -> float:
        """How much of the shape the picture's height spans, at the focal point."""
        return 2.0 * self.distance * tan(radians(VIEW_ANGLE / 2))
