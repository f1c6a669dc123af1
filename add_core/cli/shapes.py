"""How a command line names shapes: by file, or by a place in a shipped collection."""

from __future__ import annotations

import re
from pathlib import Path

from ..errors import ShapeFileError
from ..geometry import PointCloud, TriangleMesh
from ..io import dogs, humans, load_shape, poses

_SHIPPED = {"humans": humans, "poses": poses, "dogs": dogs}


def open_shape(name: str) -> TriangleMesh | PointCloud:
    """The shape that `name` stands for: a path, or e.g. "humans:3". A file that is there goes first.

    Raises ShapeFileError or GeometryError if there is none.
    """
    shipped = re.fullmatch(r"(humans|poses|dogs):(\d+)", name)
    if shipped is None or Path(name).exists():
        return load_shape(name)
    collection, number = _SHIPPED[shipped[1]](), int(shipped[2])
    if number >= len(collection):
        raise ShapeFileError(f"{shipped[1]} has shapes 0 to {len(collection) - 1}, but {number} was asked for.")
    return collection[number]
