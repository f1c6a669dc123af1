"""Point clouds: points, and normals where they are known."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .._check import BoolArray, FloatArray, points_array, positions_array, read_only
from ..errors import GeometryError
from .fans import Fans, build_fans
from .neighbours import DistinctPoints, distinct_points
from .normals import EstimatedNormals, estimate_normals
from .tangent_planes import TangentPlanes


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Points sampled from a surface, in the shape's own length unit.

    points : (n, 3) float64, kept in the order given.
    normals : (n, 3) or None; made unit length, taken as outward. Without them they are estimated where they are
        needed.
    name : what to call the shape in messages and windows.

    Raises GeometryError if an array has the wrong shape or a value is not finite, or a given normal has no length.
    """

    points: FloatArray
    normals: FloatArray | None = None
    name: str = ""

    def __init__(self, points: ArrayLike, normals: ArrayLike | None = None, name: str = "") -> None:
        checked = positions_array("points", points)
        object.__setattr__(self, "points", checked)
        object.__setattr__(self, "normals", None if normals is None else _unit_normals(normals, len(checked)))
        object.__setattr__(self, "name", str(name))

    def __repr__(self) -> str:
        return f"PointCloud({self.name!r}, {self.vertex_count} points)"

    @property
    def vertices(self) -> FloatArray:
        """The points, under the name that meshes use."""
        return self.points

    @property
    def vertex_count(self) -> int:
        return len(self.points)

    @cached_property
    def distinct(self) -> DistinctPoints:
        """The places where points lie; several points may share one."""
        return distinct_points(self.points)

    @cached_property
    def outward_normals(self) -> FloatArray:
        """(n, 3), unit: the normals given, or estimated by total least squares and turned outward."""
        if self.normals is not None:
            return self.normals
        return read_only(self._estimated.normals[self.distinct.place])

    @cached_property
    def _estimated(self) -> EstimatedNormals:
        return estimate_normals(self.points[self.distinct.first])

    @cached_property
    def tangent_planes(self) -> TangentPlanes:
        """Tangent planes and neighbours of the `distinct` points."""
        first = self.distinct.first
        return TangentPlanes.of(self.points[first], self.outward_normals[first], estimated=self.normals is None)

    @cached_property
    def fans(self) -> Fans:
        """The triangles around every point: what a cloud has in place of faces."""
        return build_fans(
            self.points,
            self.outward_normals,
            self.tangent_planes,
            self.distinct,
            estimated=self._estimated if self.normals is None else None,
        )

    @cached_property
    def has_mass(self) -> BoolArray:
        """(n,): whether any fan touches a point, so that it stands for some area. Only these take part in spectra."""
        touched = np.ones(self.vertex_count, dtype=bool)
        touched[self.fans.isolated] = False
        return read_only(touched)

    @property
    def area(self) -> float:
        """Area of the surface that the points were taken from, estimated from the fans; unit length²."""
        return float(self.fans.weights @ self.fans.areas)


def _unit_normals(normals: ArrayLike, count: int) -> FloatArray:
    array = points_array("normals", normals)
    if len(array) != count:
        raise GeometryError(f"normals must have one row for each of the {count} points, but there are {len(array)}.")
    length = np.linalg.norm(array, axis=1, keepdims=True)
    if not length.all():
        raise GeometryError(
            f"normals must have a length, but number {np.argmin(length)} is zero. Leave normals out to estimate them."
        )
    return read_only(array / length)
