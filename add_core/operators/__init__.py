"""The family of anisotropic Laplacians of a shape."""

from .anisotropic import AnisotropicLaplacian
from .diffusivity import CONDUCTIVITIES, Conductivity
from .elements import Elements
from .pattern import SparsityPattern

__all__ = ["CONDUCTIVITIES", "AnisotropicLaplacian", "Conductivity", "Elements", "SparsityPattern"]
