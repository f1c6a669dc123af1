"""The two forms in which TOSCA's shapes are distributed: MATLAB files, and .vert files with .tri files beside them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ShapeFileError
from .contents import FileContents, fan_triangles, indices
from .matlab import Variables, read_variables
from .text import float_rows, lines_of


def read_matlab(data: bytes) -> FileContents:
    """A surface in a MATLAB file of version 5 to 7: a structure, or the file itself, with X, Y, Z or VERT, and TRIV.

    TRIV counts from 1, as MATLAB does. Nothing in such a file can run.
    """
    variables = read_variables(data)
    holders = [variables, *(value for value in variables.values() if isinstance(value, dict))]
    for holder in holders:
        if "TRIV" in holder and ("VERT" in holder or {"X", "Y", "Z"} <= holder.keys()):
            return _surface(holder)
    names = ", ".join(variables)
    raise ShapeFileError(f"holds no surface with VERT (or X, Y, Z) and TRIV, only {names[:60] or 'nothing'}.")


def read_vert(data: bytes, path: Path) -> FileContents:
    """The points of a .vert file, and the triangles of the .tri file beside it, which counts from 1."""
    points = float_rows(lines_of(data), 3, "a point of 3 numbers")
    triangles = path.with_suffix(".tri")
    try:
        lines = lines_of(triangles.read_bytes())
    except OSError as error:
        raise ShapeFileError(f"needs its faces in {triangles.name} beside it ({error.strerror or error}).") from None
    corners = indices(float_rows(lines, 3, f"a face of 3 numbers in {triangles.name}")) - 1
    return FileContents(points, corners)


def _surface(holder: Variables) -> FileContents:
    if "VERT" in holder:
        points = _numbers(holder["VERT"], "VERT").astype(np.float64)
    else:
        columns = [_numbers(holder[axis], axis).ravel() for axis in "XYZ"]
        if len({len(column) for column in columns}) > 1:
            raise ShapeFileError(f"has X, Y and Z of different lengths ({', '.join(str(len(c)) for c in columns)}).")
        points = np.stack(columns, axis=1).astype(np.float64)
    faces = indices(_numbers(holder["TRIV"], "TRIV"))
    if faces.ndim != 2:
        raise ShapeFileError(f"has TRIV of shape {faces.shape} instead of (m, 3).")
    counts = np.full(len(faces), faces.shape[1], dtype=np.int64)
    return FileContents(points, fan_triangles(faces.ravel() - 1, counts))


def _numbers(value: Any, name: str) -> NDArray[np.number]:
    if not isinstance(value, np.ndarray):
        raise ShapeFileError(f"has {name} that is no array of numbers.")
    return value
