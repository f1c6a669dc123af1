"""MATLAB files of versions 5 to 7: numeric arrays and structures of them; everything else in a file is passed over.

Read here and not through SciPy: on damaged files its reader ends the whole process.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ShapeFileError

_NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_MATRIX, _COMPRESSED = 14, 15
_STRUCTURE = 2
_NUMERIC_CLASSES = range(6, 16)
_COMPLEX = 0x800
_HEADER = 128
_DEEPEST = 8

Variables = dict[str, Any]
"""By name: an array, Fortran-ordered as MATLAB has it, or for a structure again Variables."""


def read_variables(data: bytes) -> Variables:
    """The numeric arrays and the single structures of a MATLAB file. Nothing in it can run.

    Raises ShapeFileError if it is cut off, damaged or of version 7.3.
    """
    if data.startswith(b"MATLAB 7.3"):
        raise ShapeFileError("is a MATLAB file of version 7.3. Save it again with -v7.")
    if len(data) < _HEADER or data[126:128] not in (b"IM", b"MI"):
        raise ShapeFileError("has no complete MATLAB header. Is it cut off?")
    order = "<" if data[126:128] == b"IM" else ">"
    variables: Variables = {}
    rows = _Elements(data[_HEADER:], order)
    while not rows.at_end:
        element = rows.next()
        if element.kind == _COMPRESSED:
            element = _Elements(_inflated(element.data), order).next()
        if element.kind == _MATRIX:
            name, value = _matrix(element.data, order, 0)
            if value is not None:
                variables[name] = value
    return variables


@dataclass(frozen=True)
class _Element:
    kind: int
    data: bytes


class _Elements:
    """The elements of a file or matrix, one after another: a type, a size, and so many bytes."""

    def __init__(self, data: bytes, order: str) -> None:
        self._data = data
        self._order = order
        self._at = 0

    @property
    def at_end(self) -> bool:
        return self._at >= len(self._data)

    def next(self) -> _Element:
        head = self._data[self._at : self._at + 8]
        if len(head) < 8:
            raise ShapeFileError("ends within an array. Is it cut off?")
        kind, size = (int(word) for word in np.frombuffer(head, self._order + "u4"))
        if kind >> 16:  # up to four bytes are stored in place of the size
            kind, size = kind & 0xFFFF, kind >> 16
            self._at += 8
            return _Element(kind, head[4 : 4 + min(size, 4)])
        start = self._at + 8
        if start + size > len(self._data):
            raise ShapeFileError(
                f"claims {size} bytes of numbers, but only {len(self._data) - start} follow. Is it cut off?"
            )
        self._at = start + (size if kind == _COMPRESSED else -(-size // 8) * 8)
        return _Element(kind, self._data[start : start + size])

    def numbers(self) -> NDArray[np.number]:
        element = self.next()
        if element.kind not in _NUMBERS:
            raise ShapeFileError(f"holds numbers of the unknown type {element.kind}. Is it damaged?")
        dtype = np.dtype(self._order + _NUMBERS[element.kind])
        return np.frombuffer(element.data, dtype, len(element.data) // dtype.itemsize)


def _matrix(data: bytes, order: str, depth: int) -> tuple[str, NDArray[np.number] | Variables | None]:
    """Name and value; None if it is neither an array of real numbers nor a single structure."""
    parts = _Elements(data, order)
    if parts.at_end or depth > _DEEPEST:
        return "", None  # an empty field of a structure
    flags = parts.numbers()
    dims = tuple(int(size) for size in parts.numbers())
    name = parts.next().data.decode("ascii", "replace")
    word = int(flags[0]) if len(flags) else 0
    if word & 0xFF in _NUMERIC_CLASSES and not word & _COMPLEX:
        values = parts.numbers()
        if min(dims, default=-1) < 0 or np.prod(dims, dtype=object) != len(values):
            sizes = " × ".join(map(str, dims))
            raise ShapeFileError(
                f"claims {sizes} numbers in {name or 'a field'}, but holds {len(values)}. Is it damaged?"
            )
        return name, values.reshape(dims, order="F")
    if word & 0xFF == _STRUCTURE and dims == (1, 1):
        return name, _fields(parts, order, depth)
    return name, None


def _fields(parts: _Elements, order: str, depth: int) -> Variables:
    lengths, names = parts.numbers(), parts.next().data
    width = int(lengths[0]) if len(lengths) else 0
    if width <= 0:
        raise ShapeFileError("has a structure without names of fields. Is it damaged?")
    fields: Variables = {}
    for start in range(0, len(names), width):
        element = parts.next()
        value = _matrix(element.data, order, depth + 1)[1] if element.kind == _MATRIX else None
        if value is not None:
            fields[names[start : start + width].split(b"\0")[0].decode("ascii", "replace")] = value
    return fields


def _inflated(data: bytes) -> bytes:
    try:
        return zlib.decompressobj().decompress(data)
    except zlib.error as error:
        raise ShapeFileError(f"has numbers that cannot be unpacked ({error}). Is it damaged?") from None
