"""NumPy archives: vertices, faces or normals, and every other array with one row a vertex as a field."""

from __future__ import annotations

import io
import zipfile
import zlib

import numpy as np

from ..errors import ShapeFileError
from ..geometry import PointCloud
from .contents import Fields, FileContents, Shape

_OWN = ("vertices", "faces", "normals")


def read(data: bytes) -> FileContents:
    """The arrays `vertices` (n, 3), `faces` (m, 3) and `normals` (n, 3), of which the first must be there.

    Nothing is unpickled: an archive with Python objects is refused.
    """
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            arrays = {name: np.asarray(archive[name]) for name in archive.files}
    except (
        ValueError,
        OSError,
        EOFError,
        KeyError,
        MemoryError,
        zipfile.BadZipFile,
        zlib.error,
        NotImplementedError,
        RuntimeError,  # encrypted, or said to be
    ) as error:
        raise ShapeFileError(
            f"is not a readable NPZ archive ({' '.join(str(error).split())[:120].rstrip('.')})."
        ) from None
    if "vertices" not in arrays:
        raise ShapeFileError(f"has no array named vertices (only {', '.join(arrays) or 'nothing'}).")
    vertices = arrays["vertices"]
    rows = len(vertices) if vertices.ndim else 0
    fields = {
        name: array.astype(np.float64)
        for name, array in arrays.items()
        if name not in _OWN and array.dtype.kind in "fiub" and array.ndim in (1, 2) and len(array) == rows
    }
    return FileContents(vertices, arrays.get("faces"), arrays.get("normals"), fields)


def write(shape: Shape, fields: Fields) -> bytes:
    """A compressed archive of the shape's arrays and `fields`."""
    arrays: dict[str, np.ndarray] = {"vertices": shape.vertices}
    if not isinstance(shape, PointCloud):
        arrays["faces"] = shape.faces
    elif shape.normals is not None:
        arrays["normals"] = shape.normals
    taken = [name for name in fields if name in _OWN or "/" in name or name in ("file", "allow_pickle")]
    if taken:
        raise ShapeFileError(f"an NPZ archive cannot hold a field named {taken[0]!r}. Rename the field.")
    buffer = io.BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **arrays, **fields)
    return buffer.getvalue()
