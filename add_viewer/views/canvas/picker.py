"""Which vertex lies under the cursor."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

FloatArray = NDArray[np.float64]

POINT_REACH = 12.0
"""How far from the cursor, in device-independent pixels, a cloud's point may lie and still be meant."""


class MeshPicker:
    """Shoots a ray at the surface; the nearest corner of the triangle it meets first is meant."""

    def __init__(self, dataset: pv.PolyData) -> None:
        self._points, self._faces = np.asarray(dataset.points), dataset.regular_faces
        self._locator = vtkStaticCellLocator()
        self._locator.SetDataSet(dataset)
        self._locator.BuildLocator()

    def vertex_at(self, near: FloatArray, far: FloatArray) -> int | None:
        """The vertex for a ray between two points in the shape's space."""
        at, place, barycentric = mutable(0.0), [0.0] * 3, [0.0] * 3
        part, cell = mutable(0), mutable(0)
        hit = self._locator.IntersectWithLine
        if not hit(near, far, 0.0, at, place, barycentric, part, cell):  # type: ignore[call-overload]
            return None
        corners = self._faces[int(cell)]
        return int(corners[np.argmin(((self._points[corners] - place) ** 2).sum(axis=1))])


class CloudPicker:
    """Looks for the frontmost of the points close to the cursor."""

    def __init__(self, dataset: pv.PolyData) -> None:
        self._points = np.asarray(dataset.points, dtype=np.float64)

    def vertex_near(self, to_screen: FloatArray, x: float, y: float, reach: float) -> int | None:
        """The vertex within `reach` of (x, y), all in device pixels; `to_screen` (4, 4) maps points to x, y, depth."""
        seen = np.c_[self._points, np.ones(len(self._points))] @ to_screen.T
        seen = seen[:, :3] / seen[:, 3:]
        away = np.hypot(seen[:, 0] - x, seen[:, 1] - y)
        close = np.flatnonzero(away <= reach)
        if len(close) == 0:
            return None
        front = seen[close, 2] <= seen[close, 2].min() + 1e-3
        candidates = close[front]
        return int(candidates[np.argmin(away[candidates])])
