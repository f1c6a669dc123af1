"""Shapes and what can be measured on them."""

from .cloud import PointCloud
from .diameter import geodesic_diameter
from .frames import PrincipalFrames, principal_curvatures
from .geodesics import geodesic_distances
from .mesh import TriangleMesh
from .sampling import Subsample, farthest_points, subsample
from .scale import normalize

__all__ = [
    "PointCloud",
    "PrincipalFrames",
    "Subsample",
    "TriangleMesh",
    "farthest_points",
    "geodesic_diameter",
    "geodesic_distances",
    "normalize",
    "principal_curvatures",
    "subsample",
]
