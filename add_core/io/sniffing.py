"""What a file looks like, whatever it is called."""

from __future__ import annotations

import re

_MAGIC = (
    (b"ply\n", "PLY"),
    (b"ply\r", "PLY"),
    (b"glTF", "GLB"),
    (b"# vtk DataFile", "VTK"),
    (b"PK\x03\x04", "ZIP"),
    (b"\x1f\x8b", "gzip"),
    (b"BZh", "bzip2"),
    (b"\xfd7zXZ", "xz"),
    (b"7z\xbc\xaf", "7-Zip"),
    (b"MATLAB ", "MATLAB"),
    (b"\x89HDF", "HDF5"),
    (b"\x93NUMPY", "NPY"),
    (b"\x89PNG", "PNG"),
    (b"\xff\xd8\xff", "JPEG"),
    (b"%PDF", "PDF"),
    (b"Kaydara FBX", "FBX"),
    (b"BLENDER", "Blender"),
    (b"version https://git-lfs", "Git LFS pointer"),
    (b"\xff\xfe", "UTF-16 text"),
    (b"\xfe\xff", "UTF-16 text"),
)
_WORDS = (
    (rb"\A\s*(#[^\n]*\n\s*)*(ST)?C?N?4?n?OFF\b", "OFF"),
    (rb"\A\s*solid\b[^\0]*\bfacet\b", "STL"),
    (rb"\A\s*(<\?xml[^>]*>\s*)?<VTKFile[^>]*\bPolyData\b", "VTP"),
    (rb"\A\s*(<!doctype\s+html|<html)", "HTML"),
    (rb"\A\s*<(\?xml|\w)", "XML"),
    (rb"\A\s*\{[^\0]*\"asset\"", "glTF"),
    (rb"\A(\s*(#|mtllib|o |g |s |usemtl)[^\n]*\n)*\s*v\s+[-+.\d]", "OBJ"),
)


def looks_like(data: bytes) -> str | None:
    """The name of the format that the first bytes of a file speak for, or None."""
    for magic, name in _MAGIC:
        if data.startswith(magic):
            return name
    head = data[:8192].removeprefix(b"\xef\xbb\xbf")
    for pattern, name in _WORDS:
        if re.search(pattern, head, re.IGNORECASE if name in ("HTML", "STL") else 0):
            return name
    if len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little"):
        return "STL"
    return None
