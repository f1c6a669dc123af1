"""Shapes and what can be measured on them."""

from .cloud import PointCloud
from .mesh import TriangleMesh

__all__ = ["PointCloud", "TriangleMesh"]
