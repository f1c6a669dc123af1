"""The family of anisotropic Laplacians of a shape."""

from .anisotropic import AnisotropicLaplacian, Conductivity
from .elements import Elements
from .pattern import SparsityPattern

__all__ = ["AnisotropicLaplacian", "Conductivity", "Elements", "SparsityPattern"]
