"""STL: triangles as three corners each, without any notion of a shared vertex.

Corners with identical coordinates become one vertex, numbered by first appearance: without that, no two triangles
would touch. Corners that differ in the last bit stay apart.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from .._check import IntArray
from ..errors import ShapeFileError
from ..geometry import TriangleMesh
from .contents import Fields, FileContents, Shape

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read(data: bytes) -> FileContents:
    """The triangles of an STL file, binary or ASCII, in its order."""
    corners = _ascii_corners(data) if _is_ascii(data) else _binary_corners(data)
    vertices, faces = merged_corners(corners)
    return FileContents(vertices.astype(np.float64), faces)


def write(shape: Shape, fields: Fields) -> bytes:
    """A binary STL file: single precision, and no vertex numbers."""
    if not isinstance(shape, TriangleMesh):
        raise ShapeFileError("an STL file holds triangles alone, no points. Choose PLY, OFF, XYZ or VTP.")
    records = np.zeros(len(shape.faces), dtype=_RECORD)
    records["normal"] = shape.face_normals
    records["corners"] = shape.vertices[shape.faces]
    return b"binary STL".ljust(80) + np.uint32(len(records)).tobytes() + records.tobytes()


def merged_corners(corners: NDArray[np.floating]) -> tuple[NDArray[np.floating], IntArray]:
    """Vertices (n, 3) in order of first appearance, and faces (m, 3), from corners (3m, 3)."""
    rows = np.ascontiguousarray(corners + 0.0)  # -0.0 becomes 0.0, which has other bits
    keys = rows.view(np.dtype((np.void, rows.dtype.itemsize * 3))).ravel()
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return rows[first[order]], rank[inverse].reshape(-1, 3).astype(np.int64)


def _is_ascii(data: bytes) -> bool:
    """Some binary files start with "solid", too; their length gives them away."""
    return data[:5].lower() == b"solid" and len(data) != 84 + _RECORD.itemsize * _claimed(data)


def _claimed(data: bytes) -> int:
    return int.from_bytes(data[80:84], "little")


def _binary_corners(data: bytes) -> NDArray[np.floating]:
    if len(data) < 84:
        raise ShapeFileError(f"ends after {len(data)} bytes, inside the header of 84. Is it cut off?")
    count, held = _claimed(data), (len(data) - 84) // _RECORD.itemsize
    if count > held:
        raise ShapeFileError(f"claims {count} triangles, but holds {held}. Is it cut off, or not an STL file?")
    if count == 0:
        raise ShapeFileError("holds no triangles.")
    return np.asarray(np.frombuffer(data, _RECORD, count, 84)["corners"].reshape(-1, 3))


def _ascii_corners(data: bytes) -> NDArray[np.floating]:
    try:
        corners = np.array([[float(word) for word in match] for match in _VERTEX.findall(data)]).reshape(-1, 3)
    except ValueError as error:
        raise ShapeFileError(f"has a vertex that is not three numbers ({error}).") from None
    if len(corners) == 0:
        raise ShapeFileError("holds no triangles.")
    if len(corners) % 3 or b"endsolid" not in data.lower():
        raise ShapeFileError(f"ends after {len(corners)} corners, before the word endsolid. Is it cut off?")
    return corners
