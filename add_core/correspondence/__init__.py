"""The same point on another shape: matches, functional maps and their refinement."""

from .functional_equations import Weights
from .functional_map import FunctionalMap
from .icp import icp
from .nearest import MutualMatches, mutual_matches, nearest_matches
from .orientation import preserved_orientation
from .symmetry import IntrinsicSymmetry, intrinsic_symmetry
from .zoomout import zoomout

__all__ = [
    "FunctionalMap",
    "IntrinsicSymmetry",
    "MutualMatches",
    "Weights",
    "icp",
    "intrinsic_symmetry",
    "mutual_matches",
    "nearest_matches",
    "preserved_orientation",
    "zoomout",
]
