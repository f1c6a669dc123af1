"""Shapes in files and in collections."""

from .arrays import save_arrays
from .collection import Collection
from .files import load_fields, load_shape, save_shape
from .formats import extensions
from .shipped import dogs, humans, poses

__all__ = [
    "Collection",
    "dogs",
    "extensions",
    "humans",
    "load_fields",
    "load_shape",
    "poses",
    "save_arrays",
    "save_shape",
]
