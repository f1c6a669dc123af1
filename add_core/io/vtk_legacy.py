"""Legacy VTK files, ASCII and binary, versions 1 to 5: polygons, or an unstructured grid of polygons.

Read here and not through VTK or PyVista: on damaged files their reader ends the whole process, unsaved work with it;
trimesh knows no VTK files.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from .._check import IntArray
from ..errors import ShapeFileError
from .contents import Fields, FileContents, fan_triangles, indices
from .text import excerpt

_TYPES = {
    "char": "i1",
    "unsigned_char": "u1",
    "short": "i2",
    "unsigned_short": "u2",
    "int": "i4",
    "unsigned_int": "u4",
    "long": "i8",
    "unsigned_long": "u8",
    "float": "f4",
    "double": "f8",
    "vtkidtype": "i4",
    "vtktypeint64": "i8",
    "vtktypeuint64": "u8",
    "vtktypeint32": "i4",
    "vtktypeuint32": "u4",
}
_CELLS = ("VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS", "CELLS")
_COMPONENTS = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6, "GLOBAL_IDS": 1, "PEDIGREE_IDS": 1}
_SURFACE_CELLS = (5, 7, 9)
"""VTK's numbers for triangle, polygon and quad."""


def read(data: bytes) -> FileContents:
    """The points, polygons and point data of the file, in its order."""
    rows = _Rows(data)
    rows.line()
    rows.line()
    encoding = rows.line()[:1]
    if encoding not in (["ASCII"], ["BINARY"]):
        raise ShapeFileError(f"should say ASCII or BINARY on its third line, but says {excerpt(encoding)}.")
    rows.is_binary = encoding == ["BINARY"]
    parts = _Parts()
    while not rows.at_end:
        words = rows.line()
        if words:
            _read_section(words, rows, parts)
    if parts.points is None or not len(parts.points):
        raise ShapeFileError("holds no points.")
    return FileContents(parts.points, parts.triangles(), parts.normals, parts.fields)


@dataclass
class _Parts:
    """What has been read so far."""

    kind: str = ""
    points: NDArray[np.float64] | None = None
    cells: dict[str, tuple[IntArray, IntArray]] = field(default_factory=dict)
    cell_types: NDArray[np.float64] | None = None
    normals: NDArray[np.float64] | None = None
    fields: Fields = field(default_factory=dict)
    rows: int = 0
    at_points: bool = False

    def keep(self, name: str, values: NDArray[np.number], width: int, *, is_normal: bool = False) -> None:
        if not self.at_points:
            return
        array = values.astype(np.float64).reshape(-1, width)
        if self.points is None or len(array) != len(self.points):
            raise ShapeFileError(f"has point data {name} of {len(array)} rows, but another number of points.")
        if is_normal:
            self.normals = array
        else:
            self.fields[name] = array[:, 0] if width == 1 else array

    def triangles(self) -> IntArray | None:
        if "TRIANGLE_STRIPS" in self.cells:
            raise ShapeFileError("holds triangle strips. Export it with triangles.")
        if "CELLS" in self.cells and (self.cell_types is None or not np.isin(self.cell_types, _SURFACE_CELLS).all()):
            raise ShapeFileError(
                "holds an unstructured grid with other cells than polygons. Extract its surface first."
            )
        corners = self.cells.get("POLYGONS") or self.cells.get("CELLS")
        return None if corners is None else fan_triangles(*corners)


class _Rows:
    """The file as lines of words and blocks of numbers, read from the start."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0
        self.is_binary = False

    @property
    def at_end(self) -> bool:
        return self._at >= len(self._data)

    def line(self) -> list[str]:
        end = self._data.find(b"\n", self._at)
        end = len(self._data) if end < 0 else end
        words = self._data[self._at : end].decode("ascii", "replace").split()
        self._at = end + 1
        return words

    def peek(self) -> list[str]:
        at = self._at
        words = self.line()
        self._at = at
        return words

    def numbers(self, count: int, kind: str) -> NDArray[np.number]:
        """The next `count` numbers, of one of VTK's types."""
        if kind.lower() not in _TYPES:
            raise ShapeFileError(f"holds numbers of the unknown type {excerpt([kind])}.")
        dtype = np.dtype(">" + _TYPES[kind.lower()])
        left = len(self._data) - self._at
        if count * (dtype.itemsize if self.is_binary else 1) > left:
            raise ShapeFileError(f"claims {count} numbers, but only {max(left, 0)} bytes follow. Is it cut off?")
        if self.is_binary:
            values = np.frombuffer(self._data, dtype, count, self._at)
            self._at += count * dtype.itemsize
            self._skip_newline()
            return values
        words = self._data[self._at :].split(None, count)
        if len(words) < count:
            raise ShapeFileError(f"claims {count} numbers, but only {len(words)} follow. Is it cut off?")
        self._at = len(self._data) - (len(words[count]) if len(words) > count else 0)
        try:
            return np.array([float(word) for word in words[:count]])
        except ValueError as error:
            raise ShapeFileError(f"should hold {count} numbers, but {excerpt(str(error).split())}.") from None

    def _skip_newline(self) -> None:
        if self._data[self._at : self._at + 1] == b"\n":
            self._at += 1


def _read_section(words: list[str], rows: _Rows, parts: _Parts) -> None:
    keyword, *rest = [words[0].upper(), *words[1:]]
    try:
        match keyword:
            case "DATASET":
                parts.kind = rest[0].upper()
                if parts.kind not in ("POLYDATA", "UNSTRUCTURED_GRID"):
                    raise ShapeFileError(f"holds a data set of kind {excerpt(rest)}, not a surface or points.")
            case "POINTS":
                parts.points = rows.numbers(3 * _count(rest[0]), rest[1]).astype(np.float64).reshape(-1, 3)
            case _ if keyword in _CELLS:
                parts.cells[keyword] = _cells(_count(rest[0]), _count(rest[1]), rows)
            case "CELL_TYPES":
                parts.cell_types = rows.numbers(_count(rest[0]), "int").astype(np.float64)
            case "POINT_DATA" | "CELL_DATA":
                parts.rows, parts.at_points = _count(rest[0]), keyword == "POINT_DATA"
            case "METADATA":
                while rows.line():
                    pass  # it ends with an empty line
            case "FIELD":
                _read_field_arrays(_count(rest[1]), rows, parts)
            case _:
                _read_attribute(keyword, rest, rows, parts)
    except IndexError:
        raise ShapeFileError(f"has an incomplete line: {excerpt(words)}.") from None


def _read_attribute(keyword: str, rest: list[str], rows: _Rows, parts: _Parts) -> None:
    name = unquote(rest[0]) if rest else ""
    if keyword in _COMPONENTS:
        width = _COMPONENTS[keyword]
        parts.keep(name, rows.numbers(width * parts.rows, rest[1]), width, is_normal=keyword == "NORMALS")
    elif keyword == "SCALARS":
        width = _count(rest[2]) if len(rest) > 2 else 1
        if rows.peek()[:1] == ["LOOKUP_TABLE"]:
            rows.line()
        parts.keep(name, rows.numbers(width * parts.rows, rest[1]), max(width, 1))
    elif keyword == "TEXTURE_COORDINATES":
        width = max(_count(rest[1]), 1)
        parts.keep(name, rows.numbers(width * parts.rows, rest[2]), width)
    elif keyword == "COLOR_SCALARS":
        width = max(_count(rest[1]), 1)
        parts.keep(name, rows.numbers(width * parts.rows, "unsigned_char"), width)
    elif keyword == "LOOKUP_TABLE":
        rows.numbers(4 * _count(rest[1]), "unsigned_char")
    else:
        raise ShapeFileError(f"has a line that no VTK file has: {excerpt([keyword, *rest])}.")


def _read_field_arrays(count: int, rows: _Rows, parts: _Parts) -> None:
    for _ in range(count):
        words: list[str] = []
        while not words:
            if rows.at_end:
                raise ShapeFileError(f"claims {count} field arrays, but ends before. Is it cut off?")
            words = rows.line()
            if words[:1] == ["METADATA"]:
                while rows.line():
                    pass
                words = []
        width, tuples = _count(words[1]), _count(words[2])
        parts.keep(unquote(words[0]), rows.numbers(width * tuples, words[3]), max(width, 1))


def _cells(first: int, second: int, rows: _Rows) -> tuple[IntArray, IntArray]:
    """Corners of all cells, one after another, and how many each cell has."""
    if rows.peek()[:1] == ["OFFSETS"]:
        offsets = indices(rows.numbers(first, rows.line()[1]))
        while not (words := rows.line()) and not rows.at_end:
            pass
        if words[:1] != ["CONNECTIVITY"]:
            raise ShapeFileError("has offsets of cells without their corners. Is it damaged?")
        corners = indices(rows.numbers(second, words[1]))
        return split_at_offsets(corners, offsets)
    table = indices(rows.numbers(second, "int")).tolist()
    counts: list[int] = []
    corners_seen: list[int] = []
    at = 0
    for _ in range(first):
        if at >= len(table) or not 0 <= table[at] < len(table) - at:
            raise ShapeFileError("has cells whose sizes do not fit their number. Is it damaged?")
        counts.append(table[at])
        corners_seen += table[at + 1 : at + 1 + table[at]]
        at += 1 + table[at]
    return np.array(corners_seen, dtype=np.int64), np.array(counts, dtype=np.int64)


def split_at_offsets(corners: IntArray, offsets: IntArray) -> tuple[IntArray, IntArray]:
    """`corners`, and how many each cell has, from where each starts: 0, ascending, and last their number."""
    counts = np.diff(offsets)
    if len(offsets) and (offsets[0] != 0 or (counts < 0).any() or offsets[-1] != len(corners)):
        raise ShapeFileError("has polygons whose offsets do not fit their corners. Is it damaged?")
    return corners, counts


def _count(word: str) -> int:
    if not (word.isascii() and word.isdigit()) or len(word) > 18:
        raise ShapeFileError(f"should hold a count, but it reads {excerpt([word])}.")
    return int(word)
