"""The header of a PLY file: which elements follow, how many, and the properties of each."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from ..errors import ShapeFileError
from .text import excerpt

_TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "float32": "f4",
    "float64": "f8",
}
_ENCODINGS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_END = re.compile(rb"end_header[ \t]*(\r\n|\n|\r)")


@dataclass(frozen=True)
class PlyProperty:
    """One column: a number, or a list of numbers with a count before it."""

    name: str
    dtype: np.dtype[np.generic]
    count_dtype: np.dtype[np.generic] | None = None


@dataclass(frozen=True)
class PlyElement:
    """One table of the file, such as its vertices."""

    name: str
    count: int
    properties: tuple[PlyProperty, ...]

    @property
    def least_bytes(self) -> int:
        """What one row takes at least; its lists may be empty."""
        return sum((column.count_dtype or column.dtype).itemsize for column in self.properties)


@dataclass(frozen=True)
class PlyHeader:
    """What the data after byte `size` are. `ascii` is True for text."""

    elements: tuple[PlyElement, ...]
    ascii: bool
    size: int


def read_header(data: bytes) -> PlyHeader:
    """Raises ShapeFileError if the header is not one, with the line that is wrong."""
    end = _END.search(data)
    if end is None:
        raise ShapeFileError("has no line end_header. Is it cut off?")
    order: str | None = None
    elements: list[tuple[str, int, list[PlyProperty]]] = []
    for line in data[: end.start()].decode("ascii", errors="replace").splitlines():
        match line.split():
            case ["format", encoding, *_] if encoding in _ENCODINGS:
                order = _ENCODINGS[encoding]
            case ["element", name, count] if count.isascii() and count.isdigit():
                elements.append((name, int(count), []))
            case ["property", "list", count_type, item_type, name] if (
                elements and {count_type, item_type} <= _TYPES.keys()
            ):
                elements[-1][2].append(PlyProperty(name, _dtype(order, item_type), _dtype(order, count_type)))
            case ["property", kind, name] if elements and kind in _TYPES:
                elements[-1][2].append(PlyProperty(name, _dtype(order, kind)))
            case [] | ["ply"] | ["comment" | "obj_info", *_]:
                pass
            case words:
                raise ShapeFileError(f"has a header line that no PLY file has: {excerpt(words)}.")
    if order is None:
        raise ShapeFileError("does not say in its header whether it is ascii or binary.")
    tables = tuple(PlyElement(name, count, tuple(properties)) for name, count, properties in elements)
    return PlyHeader(tables, ascii=order == "", size=end.end())


def _dtype(order: str | None, kind: str) -> np.dtype[np.generic]:
    return np.dtype((order or "") + _TYPES[kind])
