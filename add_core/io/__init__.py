"""Shapes in files and in collections."""

from .collection import Collection
from .shipped import dogs, humans, poses

__all__ = ["Collection", "dogs", "humans", "poses"]
