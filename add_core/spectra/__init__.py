"""Eigenfunctions of the operators, one or the whole family, and heat without them."""

from .cache import SpectraCache
from .family import SpectralFamily, compute_spectra
from .heat_flow import HeatFlow
from .spectrum import Spectrum, compute_spectrum

__all__ = ["HeatFlow", "SpectraCache", "SpectralFamily", "Spectrum", "compute_spectra", "compute_spectrum"]
