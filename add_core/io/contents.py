"""What one file holds, before it becomes a shape."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .._check import FloatArray, IntArray
from ..errors import ShapeFileError
from ..geometry import PointCloud, TriangleMesh

_log = logging.getLogger(__name__)

Shape = TriangleMesh | PointCloud
Fields = dict[str, FloatArray]


@dataclass(frozen=True, eq=False)
class FileContents:
    """Points in the order of the file, with everything else that belongs to them.

    vertices : (n, 3).
    faces : (m, 3), or None if the file holds points alone.
    normals : (n, 3) or None, one a vertex.
    fields : per-vertex quantities by name, each (n,) or (n, k).
    """

    vertices: FloatArray
    faces: IntArray | None = None
    normals: FloatArray | None = None
    fields: Fields = field(default_factory=dict)

    def shape(self, name: str) -> Shape:
        """A mesh if there are faces, otherwise a point cloud; a mesh's normals follow from its faces."""
        if self.faces is not None and np.size(self.faces):
            return TriangleMesh(self.vertices, self.faces, name=name)
        return PointCloud(self.vertices, self.normals, name=name)


def indices(values: NDArray[np.number]) -> IntArray:
    """`values` as int64. Raises ShapeFileError if one is no whole number, or too large to count anything."""
    if values.dtype.kind == "f" and not (np.isfinite(values).all() and (np.abs(values) < 2**53).all()):
        raise ShapeFileError("has vertex numbers that are not finite.")
    whole = values.astype(np.int64)
    if (whole != values).any():
        raise ShapeFileError("has vertex numbers that are not whole.")
    return whole


def fan_triangles(corners: IntArray, counts: IntArray) -> IntArray:
    """Triangles (m, 3) of polygons, in the order of the polygons, each split into a fan around its first corner.

    corners : the vertices of all polygons, one after another; counts : how many of them each polygon has.
    A fan keeps the orientation; it leaves the surface of a polygon that is not convex.

    Raises ShapeFileError if a polygon has fewer than three corners.
    """
    if len(counts) == 0:
        return np.zeros((0, 3), dtype=np.int64)
    check_corner_counts(counts)
    if (counts == 3).all():
        return corners.reshape(-1, 3)
    starts = np.repeat(np.cumsum(counts) - counts, counts - 2)
    ends = np.cumsum(counts - 2)
    step = np.arange(ends[-1]) - np.repeat(ends - (counts - 2), counts - 2)
    triangles: IntArray = np.stack([corners[starts], corners[starts + step + 1], corners[starts + step + 2]], axis=1)
    return triangles


def check_corner_counts(counts: IntArray) -> None:
    """Log that polygons are split, if there are any. Raises ShapeFileError if one has fewer than three corners."""
    if (counts < 3).any():
        first = int(np.argmax(counts < 3))
        raise ShapeFileError(f"face {first} has {counts[first]} corners, but a face needs at least 3.")
    if (counts > 3).any():
        _log.info(
            "%d of %d faces have more than three corners; each was split into a fan.", (counts > 3).sum(), len(counts)
        )
