"""Eigenfunctions of the operators, and heat without them."""

from .heat_flow import HeatFlow
from .spectrum import Spectrum, compute_spectrum

__all__ = ["HeatFlow", "Spectrum", "compute_spectrum"]
