"""PLY, ascii or binary of either byte order: vertices, faces, normals, and any other number at the vertices as a field.

A field of k > 1 components is stored as properties name_0 to name_{k-1}; on reading, such properties are joined again.
MeshLab knows one field, by the name "quality", so the first field of one component is written under that name, too.

Read and written here: trimesh refuses binary files that mix triangles with other polygons, takes text that is cut off
for a smaller shape, and writes coordinates in single precision.
"""

from __future__ import annotations

import re

import numpy as np

from ..errors import ShapeFileError
from ..geometry import PointCloud
from .contents import Fields, FileContents, Shape, fan_triangles, indices
from .ply_header import PlyElement, read_header
from .ply_rows import BinaryRows, Column, TextRows

_POSITION = ("x", "y", "z")
_NORMAL = ("nx", "ny", "nz")
_CORNERS = ("vertex_indices", "vertex_index")
_REPEATED = b"comment quality repeats"


def read(data: bytes) -> FileContents:
    """The vertices, faces and vertex fields of a PLY file, in its order. Edges and other tables are left out."""
    header = read_header(data)
    rows = TextRows(data[header.size :]) if header.ascii else BinaryRows(data, header.size)
    tables: dict[str, dict[str, Column]] = {}
    for element in header.elements:
        tables[element.name] = rows.read(element)
        if {"vertex", "face"} <= tables.keys():
            break  # what follows may be in any state
    if "tristrips" in tables:
        raise ShapeFileError("holds triangle strips. Export it with a list of faces.")
    vertices = dict(tables.get("vertex", {}))
    if _REPEATED in data[: header.size]:
        vertices.pop("quality", None)
    if not set(_POSITION) <= vertices.keys():
        raise ShapeFileError("has no vertices with x, y and z.")
    return FileContents(
        _stacked(vertices, _POSITION),
        _triangles(header.elements, tables.get("face")),
        _stacked(vertices, _NORMAL) if set(_NORMAL) <= vertices.keys() else None,
        _fields(vertices),
    )


def write(shape: Shape, fields: Fields) -> bytes:
    """A binary little-endian PLY file in double precision, with `fields` as further properties of the vertices."""
    columns: dict[str, np.ndarray] = dict(zip(_POSITION, shape.vertices.T, strict=True))
    if isinstance(shape, PointCloud) and shape.normals is not None:
        columns |= zip(_NORMAL, shape.normals.T, strict=True)
    shown = None if "quality" in fields else next((name for name, field in fields.items() if field.ndim == 1), None)
    if shown is not None:
        columns["quality"] = fields[shown]
    for name, field in fields.items():
        word = _property_name(name)
        new = {word: field} if field.ndim == 1 else {f"{word}_{k}": part for k, part in enumerate(field.T)}
        if columns.keys() & new.keys():
            raise ShapeFileError(
                f"a PLY file cannot hold two properties {sorted(columns.keys() & new.keys())[0]!r}. Rename the field."
            )
        columns |= new
    table = np.empty(shape.vertex_count, dtype=[(name, "<f8") for name in columns])
    for name, column in columns.items():
        table[name] = column
    header = ["ply", "format binary_little_endian 1.0"]
    header += [] if shown is None else [f"{_REPEATED.decode()} {_property_name(shown)}"]
    header += [f"element vertex {shape.vertex_count}"]
    header += [f"property double {name}" for name in columns]
    faces = b""
    if not isinstance(shape, PointCloud):
        header += [f"element face {len(shape.faces)}", "property list uchar int vertex_indices"]
        triangles = np.empty(len(shape.faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
        triangles["count"], triangles["corners"] = 3, shape.faces
        faces = triangles.tobytes()
    return ("\n".join(header) + "\nend_header\n").encode() + table.tobytes() + faces


def _stacked(table: dict[str, Column], names: tuple[str, ...]) -> np.ndarray:
    return np.stack([table[name].numbers(name) for name in names], axis=1)


def _triangles(elements: tuple[PlyElement, ...], table: dict[str, Column] | None) -> np.ndarray | None:
    if not table or next(element.count for element in elements if element.name == "face") == 0:
        return None
    for name in _CORNERS:
        if name in table:
            corners = table[name]
            if corners.counts is None:
                raise ShapeFileError(f"has faces whose {name} is no list.")
            return fan_triangles(indices(corners.values), corners.counts)
    raise ShapeFileError(f"has faces without the list {_CORNERS[0]}.")


def _fields(table: dict[str, Column]) -> Fields:
    """The numbers at the vertices besides position and normal; name_0, name_1 … joined where none is missing."""
    scalars = {
        name: column.numbers(name)
        for name, column in table.items()
        if column.counts is None and name not in _POSITION + _NORMAL
    }
    fields: Fields = {}
    for name, column in scalars.items():
        part = re.fullmatch(r"(.+)_(\d+)", name)
        stem = part[1] if part else name
        size = next(k for k in range(len(scalars) + 1) if f"{stem}_{k}" not in scalars)
        if part and size > 1 and int(part[2]) < size:
            fields.setdefault(stem, np.stack([scalars[f"{stem}_{k}"] for k in range(size)], axis=1))
        else:
            fields[name] = column
    return fields


def _property_name(name: str) -> str:
    """PLY separates words by spaces and knows ASCII alone."""
    return re.sub(r"[^!-~]+", "_", name)
