"""From which side a shape is seen. Orthographic: equal lengths stay equal, so shapes beside each other compare."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np

from .._check import FloatArray, one_of, read_only

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_SIGNED = tuple(f"{sign}{axis}" for sign in "+-" for axis in _AXES)


@dataclass(frozen=True, eq=False)
class Camera:
    """A direction of view. axes : (3, 3), rows are the picture's right, its up, and the way to the eye; a rotation."""

    axes: FloatArray

    @classmethod
    def facing(cls, up: str, front: str, *, azimuth: float = 0.0, elevation: float = 0.0) -> Camera:
        """Look a shape in the face whose axes point `up` and to its `front`, e.g. "+z" and "-y".

        azimuth : degrees; positive shows the shape's left side, 180 its back. elevation : degrees; positive shows its
            top. The horizon stays level. Raises ParameterError for an axis that is none.
        """
        above, ahead = _axis("up", up), _axis("front", front)
        around, raised = radians(azimuth), radians(elevation)
        level = cos(around) * ahead + sin(around) * np.cross(above, ahead)
        eye = cos(raised) * level + sin(raised) * above
        right = np.cross(above, level)
        return cls(read_only(np.stack([right, np.cross(eye, right), eye])))

    def seen(self, points: FloatArray) -> FloatArray:
        """(…, 3): how far right, how far up, and how near the eye points (…, 3) lie, in the points' unit."""
        return np.asarray(points @ self.axes.T)


def _axis(name: str, written: str) -> FloatArray:
    one_of(name, written, _SIGNED)
    return np.array(_AXES[written[1]]) * (-1.0 if written[0] == "-" else 1.0)
