"""Shapes brought to one size: α and t compare between shapes only where lengths do."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from .cloud import PointCloud
from .diameter import geodesic_diameter
from .mesh import TriangleMesh

Shape = TypeVar("Shape", bound=TriangleMesh | PointCloud)


def normalize(shape: Shape) -> Shape:
    """The shape scaled to unit geodesic diameter, as the paper does before anything else.

    Every vertex is divided by `geodesic_diameter(shape)`, about the origin: the shape is not moved to the middle.
    Faces, normals, order and name stay.

    Raises GeometryError if the shape has no extent.
    """
    size = geodesic_diameter(shape)
    if isinstance(shape, PointCloud):
        return replace(shape, points=shape.points / size)
    return replace(shape, vertices=shape.vertices / size)
