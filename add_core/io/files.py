"""Reading shapes from files and writing them."""

from __future__ import annotations

import logging
import os
import stat
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from .._check import instance_of
from ..errors import AddError, ParameterError, ShapeFileError
from ..geometry import PointCloud, TriangleMesh
from .atomic import write_atomically
from .contents import Fields, FileContents, Shape
from .formats import FORMATS, extensions
from .sniffing import looks_like

_log = logging.getLogger(__name__)
_PACKED = ("gzip", "bzip2", "xz", "7-Zip")

StrPath = str | os.PathLike[str]


def load_shape(path: StrPath) -> Shape:
    """The shape in a file: a TriangleMesh, or a PointCloud if the file holds points alone; named after the file.

    Reads OFF, OBJ, PLY, STL, VTP, legacy VTK, GLB and glTF, XYZ, NPZ and TOSCA's .mat and .vert. Vertices keep the
    file's order and number, also duplicate and unreferenced ones; STL, which has no vertices, gets one for every
    distinct corner, by first appearance. Polygons of more than three corners are split into fans, which is logged.
    Coordinates keep their unit.

    Raises ShapeFileError or GeometryError, with the file's name, if there is no such file or no shape in it.
    """
    return load_shape_and_fields(path).shape


@dataclass(frozen=True, eq=False)
class LoadedShape:
    """All of a file: the shape, and the quantities at its vertices: name → (n,) or (n, k)."""

    shape: Shape
    fields: Fields


def load_shape_and_fields(path: StrPath) -> LoadedShape:
    """The shape of `load_shape` with the fields of `load_fields`, {} for a format without any; the file is read once.

    Raises as `load_shape` does.
    """
    path = file_path(path)
    try:
        contents = _contents(path)
        return LoadedShape(contents.shape(path.stem), contents.fields)
    except AddError as error:
        raise type(error)(f"{path}: {error}") from None


def load_fields(path: StrPath) -> Fields:
    """The quantities at the vertices of a PLY, VTP, VTK or NPZ file: name → (n,) or (n, k), float64, in vertex order.

    Raises ShapeFileError, with the file's name, if it cannot be read; the result is empty if there are none.
    """
    path = file_path(path)
    try:
        contents = _contents(path)
        if not (known := FORMATS[path.suffix.lower()]).holds_fields:
            raise ShapeFileError(_no_fields(known.name))
        return contents.fields
    except AddError as error:
        raise type(error)(f"{path}: {error}") from None


def save_shape(shape: Shape, path: StrPath, fields: Mapping[str, ArrayLike] | None = None) -> None:
    """Write a shape, and quantities at its vertices, in the format that the extension of `path` names.

    fields : name → (n,) or (n, k). PLY, VTP, VTK and NPZ hold them, in double precision. MeshLab colours a PLY file by
        the field named "quality", or the first one; ParaView shows the fields of VTP and VTK files.
    The file appears whole or not at all: it is written beside its place and then moved there.

    Raises ShapeFileError if the format cannot hold the shape or fields, or the file cannot be written; ParameterError
    if a field does not have one row a vertex.
    """
    path = file_path(path)
    instance_of("shape", shape, TriangleMesh, PointCloud)
    given = {} if fields is None else fields
    instance_of("fields", given, Mapping)
    try:
        known = FORMATS.get(path.suffix.lower())
        if known is None:
            raise ShapeFileError(_unsupported(path, None))
        if known.write is None:
            raise ShapeFileError(
                f"{known.name} files are read, but not written. Choose one of {', '.join(extensions(writable=True))}."
            )
        if given and not known.holds_fields:
            raise ShapeFileError(_no_fields(known.name))
        write_atomically(path, known.write(shape, _checked_fields(given, shape.vertex_count)))
    except AddError as error:
        raise type(error)(f"{path}: {error}") from None


def file_path(path: StrPath) -> Path:
    """`path` as a Path. Raises ParameterError if it is no name at all."""
    try:
        return Path(path)
    except TypeError:
        raise ParameterError(f"path must be the name of a file or folder, but it is {path!r}.") from None


def _contents(path: Path) -> FileContents:
    data = _bytes_of(path)
    looks = looks_like(data)
    known = FORMATS.get(path.suffix.lower())
    if known is None:
        raise ShapeFileError(_unsupported(path, looks))
    if looks is not None and looks not in known.looks:
        raise ShapeFileError(_misnamed(looks, known.name))
    with np.errstate(all="ignore"):  # noise may decode to any number; the shape itself complains about NaN
        return known.read(data, path)


def _bytes_of(path: Path) -> bytes:
    try:
        mode = path.stat().st_mode
        # A pipe or a device may never end.
        data = path.read_bytes() if stat.S_ISREG(mode) else b""
    except FileNotFoundError:
        raise ShapeFileError("there is no such file.") from None
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        raise ShapeFileError(f"cannot be read ({getattr(error, 'strerror', None) or error}).") from None
    if not stat.S_ISREG(mode):
        raise ShapeFileError("is a folder, not a file." if stat.S_ISDIR(mode) else "is not a regular file.")
    if not data.strip(b" \t\r\n\0"):
        raise ShapeFileError("is empty.")
    return data


def _unsupported(path: Path, looks: str | None) -> str:
    if looks in _PACKED:
        return _misnamed(looks, "")
    named = f"the extension {path.suffix!r} is not supported" if path.suffix else "the name has no extension"
    endings = [ext for ext, known in FORMATS.items() if looks == known.looks[0]]
    remedy = f" It looks like {looks}: rename it to end in {endings[0]}." if endings else ""
    return f"{named}. Supported are {', '.join(FORMATS)}.{remedy}"


def _misnamed(looks: str, expected: str) -> str:
    if looks in _PACKED:
        return f"is compressed with {looks}. Unpack it first."
    if looks == "Git LFS pointer":
        return "holds only a Git LFS pointer. Fetch the file itself with git lfs pull."
    article = "an" if looks[0] in "AEIOFHMNSX" and looks not in ("Blender",) else "a"
    endings = [ext for ext, known in FORMATS.items() if looks == known.looks[0]]
    remedy = f" Rename it to end in {endings[0]}." if endings else f" Export the shape as {expected}."
    return f"is named like {expected}, but looks like {article} {looks} file.{remedy}"


def _no_fields(name: str) -> str:
    return f"{name} files hold no fields. Choose one of {', '.join(extensions(holding_fields=True))}."


def _checked_fields(fields: Mapping[str, ArrayLike], vertex_count: int) -> Fields:
    checked: Fields = {}
    for name, values in fields.items():
        try:
            if np.iscomplexobj(values):
                raise TypeError
            array = np.asarray(values, dtype=np.float64)
        except (TypeError, ValueError):
            raise ParameterError(f"field {name!r} must hold real numbers, but it does not.") from None
        if not isinstance(name, str) or not name.strip():
            raise ParameterError(f"a field must have a name, but it is {name!r}.")
        if array.ndim not in (1, 2) or len(array) != vertex_count or array.size == 0:
            raise ParameterError(
                f"field {name!r} must have shape ({vertex_count},) or ({vertex_count}, k), but it has {array.shape}."
            )
        checked[name] = array
    return checked
