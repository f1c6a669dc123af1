"""The same point on another shape: matches, functional maps and their refinement."""

from .forest import CorrespondenceForest
from .functional_equations import Weights
from .functional_map import FunctionalMap
from .guided_zoomout import guided_zoomout
from .icp import icp
from .mirror import MirrorSymmetry, mirror_symmetry
from .nearest import MutualMatches, mutual_matches, nearest_matches
from .orientation import preserved_orientation
from .symmetry import IntrinsicSymmetry, intrinsic_symmetry
from .transfer import TransferredColors, coordinate_colors, transfer_colors
from .zoomout import zoomout

__all__ = [
    "CorrespondenceForest",
    "FunctionalMap",
    "IntrinsicSymmetry",
    "MirrorSymmetry",
    "MutualMatches",
    "TransferredColors",
    "Weights",
    "coordinate_colors",
    "guided_zoomout",
    "icp",
    "intrinsic_symmetry",
    "mirror_symmetry",
    "mutual_matches",
    "nearest_matches",
    "preserved_orientation",
    "transfer_colors",
    "zoomout",
]
