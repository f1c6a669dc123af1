"""The paper's three protocols, symmetric and asymmetric, and the share of points on the right side."""

from .baselines import describe_with, functional_map_matches, isotropic, refined_matches
from .cmc import CumulativeMatch, cmc
from .princeton import PrincetonCurve, match_errors, princeton, princeton_curve, surface_area
from .report import save_report, table
from .right_side import RightSide, right_side
from .roc import ReceiverOperator, roc
from .scores import Scores, averaged, descriptor_scores, match_scores
from .truth import SurfacePoints

__all__ = [
    "CumulativeMatch",
    "PrincetonCurve",
    "ReceiverOperator",
    "RightSide",
    "Scores",
    "SurfacePoints",
    "averaged",
    "cmc",
    "describe_with",
    "descriptor_scores",
    "functional_map_matches",
    "isotropic",
    "match_errors",
    "match_scores",
    "princeton",
    "princeton_curve",
    "refined_matches",
    "right_side",
    "roc",
    "save_report",
    "surface_area",
    "table",
]
