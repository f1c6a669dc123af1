"""The paper's three protocols, symmetric and asymmetric, and the share of points on the right side."""

from .cmc import CumulativeMatch, cmc
from .princeton import PrincetonCurve, match_errors, princeton, princeton_curve, surface_area
from .right_side import RightSide, right_side
from .roc import ReceiverOperator, roc
from .truth import SurfacePoints

__all__ = [
    "CumulativeMatch",
    "PrincetonCurve",
    "ReceiverOperator",
    "RightSide",
    "SurfacePoints",
    "cmc",
    "match_errors",
    "princeton",
    "princeton_curve",
    "right_side",
    "roc",
    "surface_area",
]
