"""Shapes and what can be measured on them."""

from .cloud import PointCloud
from .diameter import geodesic_diameter
from .frames import PrincipalFrames, principal_curvatures
from .geodesics import geodesic_distances
from .inspection import Defect, ShapeReport, inspect
from .mesh import TriangleMesh
from .mirror import mirror_map
from .repair import Repair, repair
from .sampling import Subsample, farthest_points, subsample
from .scale import normalize

__all__ = [
    "Defect",
    "PointCloud",
    "PrincipalFrames",
    "Repair",
    "ShapeReport",
    "Subsample",
    "TriangleMesh",
    "farthest_points",
    "geodesic_diameter",
    "geodesic_distances",
    "inspect",
    "mirror_map",
    "normalize",
    "principal_curvatures",
    "repair",
    "subsample",
]
