"""Shapes in files and in collections."""

from .arrays import save_arrays
from .collection import Collection, Landmarks
from .files import LoadedShape, load_fields, load_shape, load_shape_and_fields, save_shape
from .folders import open_collection
from .formats import extensions
from .models import shipped_models
from .shipped import dogs, humans, poses
from .shipped_places import SHIPPED, ShippedPlace, known_matches, shipped_place
from .shipped_variants import clouds, remeshed

__all__ = [
    "SHIPPED",
    "Collection",
    "Landmarks",
    "LoadedShape",
    "ShippedPlace",
    "clouds",
    "dogs",
    "extensions",
    "humans",
    "known_matches",
    "load_fields",
    "load_shape",
    "load_shape_and_fields",
    "open_collection",
    "poses",
    "remeshed",
    "save_arrays",
    "save_shape",
    "shipped_models",
    "shipped_place",
]
