"""Shapes and what can be measured on them."""

from .cloud import PointCloud
from .frames import PrincipalFrames, principal_curvatures
from .mesh import TriangleMesh

__all__ = ["PointCloud", "PrincipalFrames", "TriangleMesh", "principal_curvatures"]
