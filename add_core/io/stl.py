"""STL: triangles as three corners each, without any notion of a shared vertex. Read and written by trimesh.

Corners with identical coordinates become one vertex, numbered by first appearance: without that, no two triangles
would touch. Corners that differ in the last bit stay apart; trimesh's own merging rounds and sorts them.
"""

from __future__ import annotations

import re
from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from .._check import IntArray
from ..errors import ShapeFileError
from ..geometry import TriangleMesh
from .complaints import complaints_about
from .contents import Fields, FileContents, Shape

_HEADER, _RECORD = 84, 50
"""Bytes before the triangles of a binary file, and of each triangle."""
_UNUSED = re.compile(r"^\s*((?:end)?solid).*|normal", re.IGNORECASE | re.MULTILINE)


def read(data: bytes) -> FileContents:
    """The triangles of an STL file, binary or ASCII, in its order."""
    from trimesh.exchange.stl import load_stl

    prepared = _plain_text(data) if _is_ascii(data) else _claimed_bytes(data)
    with complaints_about("STL"):
        loaded = load_stl(BytesIO(prepared))
        solids = list(loaded.get("geometry", {"": loaded}).values())  # an ASCII file may hold several
        corners = np.concatenate([solid["vertices"] for solid in solids]) if solids else np.zeros((0, 3))
    held = prepared.lower().count(b"vertex") if _is_ascii(data) else len(corners)
    if len(corners) != held:
        raise ShapeFileError(f"holds {held} corners, but only {len(corners)} before the word endsolid. Is it cut off?")
    if len(corners) == 0:
        raise ShapeFileError("holds no triangles.")
    vertices, faces = merged_corners(corners)
    return FileContents(vertices.astype(np.float64), faces)


def write(shape: Shape, fields: Fields) -> bytes:
    """A binary STL file: single precision, and no vertex numbers."""
    if not isinstance(shape, TriangleMesh):
        raise ShapeFileError("an STL file holds triangles alone, no points. Choose PLY, OFF, XYZ or VTP.")
    from trimesh import Trimesh
    from trimesh.exchange.stl import export_stl

    return bytes(export_stl(Trimesh(shape.vertices, shape.faces, process=False)))


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
    return data[:5].lower() == b"solid" and len(data) != _HEADER + _RECORD * _claimed(data)


def _claimed(data: bytes) -> int:
    return int.from_bytes(data[80:84], "little")


def _claimed_bytes(data: bytes) -> bytes:
    """A binary file with an empty title and as many bytes as its triangles take, as trimesh demands."""
    if len(data) < _HEADER:
        raise ShapeFileError(f"ends after {len(data)} bytes, inside the header of {_HEADER}. Is it cut off?")
    count, held = _claimed(data), (len(data) - _HEADER) // _RECORD
    if count > held:
        raise ShapeFileError(f"claims {count} triangles, but holds {held}. Is it cut off, or not an STL file?")
    return bytes(80) + data[80 : _HEADER + _RECORD * count]


def _plain_text(data: bytes) -> bytes:
    """An ASCII file without names, in which trimesh would find its own keywords, and without normals to complain of."""
    text = "\n".join(data.decode("ascii", errors="replace").splitlines())
    return _UNUSED.sub(lambda found: f"{found[1]}\n" if found[1] else "", text).encode()
