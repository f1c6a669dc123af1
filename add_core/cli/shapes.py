"""How a command line names shapes: by file, or by a place in a shipped collection."""

from __future__ import annotations

from pathlib import Path

from ..geometry import PointCloud, TriangleMesh
from ..io import load_shape, shipped_place


def open_shape(name: str) -> TriangleMesh | PointCloud:
    """The shape that `name` stands for: a path, or e.g. "humans/3". A file that is there goes first.

    Raises ShapeFileError or GeometryError if there is none.
    """
    place = None if Path(name).exists() else shipped_place(name)
    return load_shape(name) if place is None else place.collection[place.index]
