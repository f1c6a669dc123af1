"""VTP files: VTK's XML for polygons, with numbers as text, base64 or raw bytes, compressed or not.

Read here and not through VTK or PyVista: on damaged files their reader ends the whole process, unsaved work with it;
trimesh knows no VTK files.
"""

from __future__ import annotations

import base64
import binascii
import lzma
import re
import zlib
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from .._check import IntArray
from ..errors import ShapeFileError
from .contents import Fields, FileContents, fan_triangles, indices
from .text import excerpt
from .vtk_legacy import split_at_offsets

_TYPES = {
    f"{kind}{bits}": f"{letter}{bits // 8}"
    for kind, letter in (("Int", "i"), ("UInt", "u"), ("Float", "f"))
    for bits in (8, 16, 32, 64)
    if kind != "Float" or bits >= 32
}
_APPENDED = re.compile(rb"<AppendedData[^>]*?encoding\s*=\s*[\"'](\w+)[\"'][^>]*>\s*_")


def read(data: bytes) -> FileContents:
    """The points, polygons and point data of a VTP file; several pieces are joined in their order."""
    appended = _APPENDED.search(data)
    # Raw bytes behind the underscore are no XML, so the text ends before them.
    text = data if appended is None else data[: appended.start()] + b"</VTKFile>"
    if b"<!DOCTYPE" in text or b"<!ENTITY" in text:
        raise ShapeFileError("defines XML entities, which no VTP file needs.")
    try:
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise ShapeFileError(f"is not well-formed XML ({error}). Is it cut off?") from None
    arrays = _Arrays(
        appended=b"" if appended is None else data[appended.end() :],
        appended_raw=appended is not None and appended[1] == b"raw",
        order=">" if root.get("byte_order") == "BigEndian" else "<",
        header=_TYPES.get(root.get("header_type", "UInt32"), "u4"),
        compressor=root.get("compressor", ""),
    )
    pieces = [_piece(piece, arrays) for piece in root.findall("PolyData/Piece")]
    pieces = [piece for piece in pieces if len(piece.vertices)]
    if not pieces:
        raise ShapeFileError("holds no points.")
    return pieces[0] if len(pieces) == 1 else _joined(pieces)


def _piece(piece: ElementTree.Element, arrays: _Arrays) -> FileContents:
    count = _whole(piece, "NumberOfPoints")
    position = piece.find("Points/DataArray")
    if count == 0 or position is None:
        return FileContents(np.zeros((0, 3)))
    if _whole(piece, "NumberOfStrips"):
        raise ShapeFileError("holds triangle strips. Export it with triangles.")
    points = arrays.rows(position, count)
    if points.shape != (count, 3):
        raise ShapeFileError(f"has points of {points.shape[1]} numbers instead of 3.")
    faces = _triangles(piece, arrays) if _whole(piece, "NumberOfPolys") else None
    data = piece.find("PointData")
    fields: Fields = {}
    normals = None
    for element in [] if data is None else data.findall("DataArray"):
        if element.get("type") in _TYPES:  # the rest are words
            name = element.get("Name", "unnamed")
            array = arrays.rows(element, count)
            if data is not None and name == data.get("Normals") and array.shape[1] == 3:
                normals = array
            else:
                fields[name] = array[:, 0] if array.shape[1] == 1 else array
    return FileContents(points, faces, normals, fields)


def _triangles(piece: ElementTree.Element, arrays: _Arrays) -> IntArray:
    found = {element.get("Name"): element for element in piece.findall("Polys/DataArray")}
    if not {"connectivity", "offsets"} <= found.keys():
        raise ShapeFileError("has polygons without corners. Is it damaged?")
    corners, ends = (indices(arrays.numbers(found[name])) for name in ("connectivity", "offsets"))
    if len(ends) != _whole(piece, "NumberOfPolys"):
        raise ShapeFileError(f"claims {_whole(piece, 'NumberOfPolys')} polygons, but holds {len(ends)}.")
    return fan_triangles(*split_at_offsets(corners, np.concatenate([[0], ends])))


def _joined(pieces: list[FileContents]) -> FileContents:
    starts = np.cumsum([0] + [len(piece.vertices) for piece in pieces])
    faces = [piece.faces + start for piece, start in zip(pieces, starts, strict=False) if piece.faces is not None]
    shared = [name for name in pieces[0].fields if all(name in piece.fields for piece in pieces)]
    normals = [piece.normals for piece in pieces if piece.normals is not None]
    return FileContents(
        np.concatenate([piece.vertices for piece in pieces]),
        np.concatenate(faces) if faces else None,
        np.concatenate(normals) if len(normals) == len(pieces) else None,
        {name: np.concatenate([piece.fields[name] for piece in pieces]) for name in shared},
    )


@dataclass(frozen=True, eq=False)
class _Arrays:
    """Where the file keeps its numbers and how they are packed."""

    appended: bytes
    appended_raw: bool
    order: str
    header: str
    compressor: str

    def rows(self, element: ElementTree.Element, count: int) -> NDArray[np.float64]:
        """(count, k) float64."""
        width = max(_whole(element, "NumberOfComponents", default=1), 1)
        values = self.numbers(element)
        if len(values) != count * width:
            name = element.get("Name", "unnamed")
            raise ShapeFileError(f"claims {count} rows of {name}, but holds {len(values) / width:g}. Is it damaged?")
        return values.astype(np.float64).reshape(count, width)

    def numbers(self, element: ElementTree.Element) -> NDArray[np.number]:
        """All numbers of a DataArray, in one row."""
        kind = _TYPES.get(element.get("type", ""))
        if kind is None:
            raise ShapeFileError(f"holds numbers of the unknown type {element.get('type')}.")
        text = element.text or ""
        try:
            match element.get("format"):
                case "ascii":
                    return np.array([float(word) for word in text.split()])
                case "appended":
                    packed = self.appended[_whole(element, "offset") :]
                    data = self._unpacked(packed) if self.appended_raw else self._decoded(packed)
                case _:
                    data = self._decoded(text.strip().encode("ascii"))
        except (ValueError, zlib.error, lzma.LZMAError, binascii.Error) as error:
            raise ShapeFileError(f"has numbers that cannot be decoded ({excerpt(str(error).split())}).") from None
        dtype = np.dtype(self.order + kind)
        return np.frombuffer(data, dtype, len(data) // dtype.itemsize)

    def _decoded(self, text: bytes) -> bytes:
        """Base64: the header may be a text of its own, ended by padding, or run on into the data."""
        size = np.dtype(self.header).itemsize
        if self.compressor:
            blocks = int(self._header(base64.b64decode(text[: _base64_length(size)]))[0])
            length = _base64_length((3 + blocks) * size)
        else:
            length = _base64_length(size)
            if b"=" not in text[:length]:
                return self._unpacked(_base64(text))
        return self._unpacked(base64.b64decode(text[:length]) + _base64(text[length:]))

    def _unpacked(self, data: bytes) -> bytes:
        """The bytes behind their header, which holds their number, or how they were cut into compressed blocks."""
        size = np.dtype(self.header).itemsize
        if not self.compressor:
            return _exactly(data[size:], int(self._header(data[:size])[0]))
        blocks = int(self._header(data[:size])[0])
        if (3 + blocks) * size > len(data):
            raise ValueError(f"{blocks} blocks claimed in {len(data)} bytes")
        _, whole, last, *packed_sizes = (int(word) for word in self._header(data[: (3 + blocks) * size]))
        at, parts = (3 + blocks) * size, []
        for k, packed in enumerate(packed_sizes):
            expected = last if k == blocks - 1 and last else whole
            parts.append(_exactly(self._decompressed(_exactly(data[at:], packed), expected), expected))
            at += packed
        return b"".join(parts)

    def _header(self, data: bytes) -> NDArray[np.number]:
        words: NDArray[np.number] = np.frombuffer(
            data, self.order + self.header, len(data) // np.dtype(self.header).itemsize
        )
        if len(words) == 0:
            raise ValueError("it ends within a header")
        return words

    def _decompressed(self, data: bytes, size: int) -> bytes:
        # Bounded, so that a few bytes cannot unfold to gigabytes.
        match self.compressor:
            case "vtkZLibDataCompressor":
                return zlib.decompressobj().decompress(data, max_length=min(size, 1100 * len(data)))
            case "vtkLZMADataCompressor":
                return lzma.LZMADecompressor().decompress(data, max_length=size)
            case other:
                raise ShapeFileError(f"is compressed by {excerpt([other])}. Save it with zlib, or uncompressed.")


def _exactly(data: bytes, size: int) -> bytes:
    if len(data) < size:
        raise ValueError(f"{size} bytes claimed, {len(data)} left")
    return data[:size]


def _base64_length(size: int) -> int:
    return 4 * -(-size // 3)


def _base64(text: bytes) -> bytes:
    """Decode up to the first character that is not base64; other arrays may follow."""
    match = re.match(rb"[A-Za-z0-9+/]*={0,2}", text)
    found = match[0] if match else b""
    return base64.b64decode(found[: len(found) // 4 * 4])


def _whole(element: ElementTree.Element, attribute: str, *, default: int = 0) -> int:
    text = element.get(attribute, str(default)).strip()
    if not (text.isascii() and text.isdigit()) or len(text) > 18:
        raise ShapeFileError(f"has {attribute}={excerpt([text])}, which is no count.")
    return int(text)
