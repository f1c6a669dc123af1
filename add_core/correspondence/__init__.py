"""The same point on another shape: matches, functional maps and their refinement."""

from .functional_equations import Weights
from .functional_map import FunctionalMap
from .icp import icp
from .nearest import MutualMatches, mutual_matches, nearest_matches
from .orientation import preserved_orientation
from .zoomout import zoomout

__all__ = [
    "FunctionalMap",
    "MutualMatches",
    "Weights",
    "icp",
    "mutual_matches",
    "nearest_matches",
    "preserved_orientation",
    "zoomout",
]
