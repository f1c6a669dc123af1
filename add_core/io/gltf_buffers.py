"""The description of a glTF file and the arrays that it points to."""

from __future__ import annotations

import base64
import binascii
import json
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from ..errors import ShapeFileError

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC3": 3}
_COMPRESSIONS = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")


@dataclass(frozen=True, eq=False)
class Buffers:
    """tree : the file's JSON. data : its buffers."""

    tree: dict[str, Any]
    data: tuple[bytes, ...]

    def array(self, accessor: int, kind: str) -> NDArray[np.number]:
        """An accessor's numbers, (count,) for "SCALAR", (count, 3) for "VEC3"; normalised integers as fractions."""
        entry = self.tree["accessors"][accessor]
        if entry["type"] != kind:
            raise ShapeFileError(f"has {entry['type']} where {kind} belongs. Is it damaged?")
        count, width = int(entry["count"]), _WIDTHS[kind]
        if "sparse" in entry or "bufferView" not in entry:
            raise ShapeFileError(
                "stores vertices as differences from others, which is not supported. Export it plainly."
            )
        dtype = np.dtype(_COMPONENTS[entry["componentType"]])
        view = self.tree["bufferViews"][entry["bufferView"]]
        data = self.data[view["buffer"]]
        start = int(view.get("byteOffset", 0)) + int(entry.get("byteOffset", 0))
        stride = int(view.get("byteStride", 0)) or dtype.itemsize * width
        end = start + stride * (count - 1) + dtype.itemsize * width if count else start
        if min(count, start, stride) < 0 or end > len(data):
            raise ShapeFileError(f"claims {count} rows of numbers, but has only {len(data)} bytes. Is it cut off?")
        rows = np.ndarray((count, width), dtype, data, start, (stride, dtype.itemsize))
        values: NDArray[np.number] = rows if kind == "VEC3" else rows[:, 0]
        if entry.get("normalized") and dtype.kind in "iu":
            return np.maximum(values.astype(np.float64) / np.iinfo(dtype).max, -1.0)
        return values


def open_gltf(data: bytes, path: Path) -> Buffers:
    """Both kinds: GLB, one binary file, and glTF, JSON with its buffers in it or beside it."""
    text, blob = _chunks(data) if data[:4] == b"glTF" else (data, None)
    try:
        tree = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ShapeFileError(f"has no readable glTF description ({error}). Is it damaged?") from None
    if not isinstance(tree, dict):
        raise ShapeFileError("has no readable glTF description. Is it damaged?")
    packed = [name for name in _COMPRESSIONS if name in tree.get("extensionsRequired", [])]
    if packed:
        raise ShapeFileError(f"is compressed by {packed[0]}. Export it without compression.")
    return Buffers(tree, tuple(_buffer(entry.get("uri"), blob, path.parent) for entry in tree.get("buffers", [])))


def _chunks(data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON and the binary chunk of a GLB file."""
    claimed = int.from_bytes(data[8:12], "little")
    if len(data) < 20 or claimed > len(data):
        raise ShapeFileError(f"claims {claimed} bytes, but has {len(data)}. Is it cut off?")
    if int.from_bytes(data[4:8], "little") != 2:
        raise ShapeFileError("is of another version of glTF than 2.")
    end = 20 + int.from_bytes(data[12:16], "little")
    if data[16:20] != b"JSON" or end > len(data):
        raise ShapeFileError("has no readable glTF description. Is it cut off?")
    size = int.from_bytes(data[end : end + 4], "little")
    return data[20:end], data[end + 8 : end + 8 + size] if data[end + 4 : end + 8] == b"BIN\0" else None


def _buffer(uri: str | None, blob: bytes | None, folder: Path) -> bytes:
    if uri is None:
        return blob or b""
    if uri.startswith("data:"):
        try:
            return base64.b64decode(uri.partition(",")[2], validate=True)
        except binascii.Error:
            raise ShapeFileError("has a buffer that is no base64. Is it damaged?") from None
    name = PurePosixPath(unquote(uri))
    if name.is_absolute() or ".." in name.parts or "://" in uri:
        raise ShapeFileError(f"keeps its numbers outside its own folder, in {uri[:60]!r}. Export it as one GLB file.")
    try:
        return (folder / name).read_bytes()
    except (OSError, ValueError):
        raise ShapeFileError(
            f"keeps its numbers in {uri[:60]!r}, which cannot be read. Put it into the same folder."
        ) from None
