"""XYZ: one point a line, x y z, perhaps followed by its normal.

Read by NumPy and not by trimesh, which takes normals for colours of 8 bits and knows no comments.
"""

from __future__ import annotations

import logging

import numpy as np

from ..errors import ShapeFileError
from ..geometry import TriangleMesh
from .complaints import complaints_about
from .contents import Fields, FileContents, Shape
from .text import lines_of

_log = logging.getLogger(__name__)


def read(data: bytes) -> FileContents:
    """The points of an XYZ file, in its order, separated by spaces, commas or semicolons.

    Columns 4 to 6 are normals if each has about unit length, otherwise something else, such as colours, and left out.
    """
    lines = [" ".join(words) for _, words in lines_of(data.replace(b",", b" ").replace(b";", b" "))]
    if not lines:
        raise ShapeFileError("holds no points.")
    with complaints_about("XYZ"):
        numbers = np.loadtxt(lines, ndmin=2, comments=None)
    width = numbers.shape[1]
    if width < 3:
        raise ShapeFileError(f"holds points of {width} numbers, which should be 3.")
    if width >= 6:
        length = np.linalg.norm(numbers[:, 3:6], axis=1)
        if (np.abs(length - 1.0) < 0.1).all():
            return FileContents(numbers[:, :3], None, numbers[:, 3:6])
    if width > 3:
        _log.info("Columns 4 to %d are not normals of unit length and were left out.", width)
    return FileContents(numbers[:, :3])


def write(shape: Shape, fields: Fields) -> bytes:
    """An XYZ file of a point cloud, with its normals if it has them."""
    if isinstance(shape, TriangleMesh):
        raise ShapeFileError(
            "an XYZ file holds points alone. Save a PointCloud of the mesh's vertices, or choose OFF or PLY."
        )
    rows = shape.points if shape.normals is None else np.hstack([shape.points, shape.normals])
    return ("\n".join(" ".join(map(repr, row)) for row in rows.tolist()) + "\n").encode()
