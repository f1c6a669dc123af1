"""Shapes in files and in collections."""

from .arrays import save_arrays
from .collection import Collection, Landmarks
from .files import load_fields, load_shape, save_shape
from .folders import open_collection
from .formats import extensions
from .shipped import SHIPPED, ShippedPlace, dogs, humans, poses, shipped_place

__all__ = [
    "SHIPPED",
    "Collection",
    "Landmarks",
    "ShippedPlace",
    "dogs",
    "extensions",
    "humans",
    "load_fields",
    "load_shape",
    "open_collection",
    "poses",
    "save_arrays",
    "save_shape",
    "shipped_place",
]
