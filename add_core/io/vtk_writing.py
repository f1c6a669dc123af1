"""Writing VTK's own formats, legacy .vtk and XML .vtp, with per-vertex fields as point data."""

from __future__ import annotations

import base64
from urllib.parse import quote
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from ..geometry import PointCloud
from .contents import Fields, Shape


def write_legacy(shape: Shape, fields: Fields) -> bytes:
    """A binary legacy VTK file of version 3 in double precision, which every VTK reads."""
    kind, cells = _cells(shape)
    table = np.insert(cells, 0, cells.shape[1], axis=1)  # each cell starts with its number of corners
    parts: list[str | bytes] = [
        f"# vtk DataFile Version 3.0\n{_title(shape)}\nBINARY\nDATASET POLYDATA\nPOINTS {len(shape.vertices)} double\n"
    ]
    parts += [_big_endian(shape.vertices, "f8"), f"{kind} {len(cells)} {table.size}\n", _big_endian(table, "i4")]
    if fields or _normals(shape) is not None:
        parts.append(f"POINT_DATA {len(shape.vertices)}\n")
    if (normals := _normals(shape)) is not None:
        parts += ["NORMALS Normals double\n", _big_endian(normals, "f8")]
    if fields:
        parts.append(f"FIELD FieldData {len(fields)}\n")
    for name, field in fields.items():
        rows = field.reshape(len(field), -1)
        # Words end at spaces, so the names are written as in a web address.
        parts += [f"{quote(name, safe='')} {rows.shape[1]} {len(rows)} double\n", _big_endian(rows, "f8")]
    return b"".join(part if isinstance(part, bytes) else part.encode("ascii", "replace") for part in parts)


def write_xml(shape: Shape, fields: Fields) -> bytes:
    """A VTP file in double precision, numbers in base64."""
    kind, cells = _cells(shape)
    ends = np.arange(1, len(cells) + 1, dtype=np.int64) * cells.shape[1]
    counts = {"Verts": 0, "Lines": 0, "Strips": 0, "Polys": 0} | {_XML_KIND[kind]: len(cells)}
    attributes = " ".join(f'NumberOf{name}="{count}"' for name, count in counts.items())
    normals = _normals(shape)
    data = fields if normals is None else {"Normals": normals, **fields}
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        f'<PolyData><Piece NumberOfPoints="{len(shape.vertices)}" {attributes}>',
        "<Points>",
        _data_array("Points", shape.vertices),
        "</Points>",
        f"<{_XML_KIND[kind]}>",
        _data_array("connectivity", cells.ravel()),
        _data_array("offsets", ends),
        f"</{_XML_KIND[kind]}>",
        "<PointData>" if normals is None else '<PointData Normals="Normals">',
        *(_data_array(name, field) for name, field in data.items()),
        "</PointData>",
        "</Piece></PolyData></VTKFile>",
    ]
    return ("\n".join(lines) + "\n").encode()


_XML_KIND = {"VERTICES": "Verts", "POLYGONS": "Polys"}


def _cells(shape: Shape) -> tuple[str, NDArray[np.int64]]:
    """The triangles; or for points one cell each, because ParaView shows nothing else."""
    if isinstance(shape, PointCloud):
        return "VERTICES", np.arange(shape.vertex_count, dtype=np.int64)[:, None]
    return "POLYGONS", shape.faces


def _normals(shape: Shape) -> NDArray[np.float64] | None:
    return shape.normals if isinstance(shape, PointCloud) else None


def _title(shape: Shape) -> str:
    """One printable line; VTK allows 256 characters."""
    return "".join(letter if letter.isprintable() else " " for letter in shape.name)[:200] or "shape"


def _big_endian(values: NDArray[np.number], kind: str) -> bytes:
    return values.astype(f">{kind}").tobytes() + b"\n"


def _data_array(name: str, values: NDArray[np.number]) -> str:
    kind = "Int64" if values.dtype.kind == "i" else "Float64"
    packed = values.astype("<i8" if kind == "Int64" else "<f8").tobytes()
    text = base64.b64encode(np.uint64(len(packed)).astype("<u8").tobytes() + packed).decode("ascii")
    width = 1 if values.ndim == 1 else values.shape[1]
    head = f'<DataArray type="{kind}" Name={quoteattr(name)} NumberOfComponents="{width}" format="binary">'
    return f"{head}{text}</DataArray>"
