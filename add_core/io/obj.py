"""Wavefront OBJ: the `v` and `f` lines, whatever groups, objects, materials and texture coordinates stand between.

Corners such as 7/2/5 also number a texture coordinate and a normal. Readers for rendering split vertices where those
differ; here a vertex is a `v` line, and its number is the line's place among them. trimesh, too, drops vertices where
there are texture coordinates, and counts negative numbers from the end of the file; its writer rounds.
"""

from __future__ import annotations

import numpy as np

from ..errors import ShapeFileError
from ..geometry import PointCloud
from .contents import Fields, FileContents, Shape, fan_triangles
from .text import Line, float_rows, lines_of, whole


def read(data: bytes) -> FileContents:
    """The vertices and faces of an OBJ file, in its order; the file's 1-based numbers become 0-based."""
    lines = lines_of(data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" "))
    vertices: list[Line] = []
    normals: list[Line] = []
    corners: list[int] = []
    counts: list[int] = []
    for number, (keyword, *words) in lines:
        if keyword == "v":
            vertices.append((number, words))
        elif keyword == "vn":
            normals.append((number, words))
        elif keyword == "f":
            counts.append(len(words))
            corners += [_corner(word, number, len(vertices)) for word in words]
    if not vertices:
        raise ShapeFileError("holds no vertices (lines that start with v).")
    points = float_rows(vertices, 3, "a vertex of 3 numbers")
    if corners:
        _check_corners(corners, counts, len(points))
        return FileContents(points, fan_triangles(np.array(corners, dtype=np.int64), np.array(counts, dtype=np.int64)))
    directions = float_rows(normals, 3, "a normal of 3 numbers") if len(normals) == len(vertices) else None
    return FileContents(points, None, directions)


def write(shape: Shape, fields: Fields) -> bytes:
    """An OBJ file; coordinates are written so that reading returns the same bits."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in shape.vertices.tolist()]
    if isinstance(shape, PointCloud):
        lines += [] if shape.normals is None else [f"vn {x!r} {y!r} {z!r}" for x, y, z in shape.normals.tolist()]
    else:
        lines += [f"f {i} {j} {k}" for i, j, k in (shape.faces + 1).tolist()]
    return ("\n".join(lines) + "\n").encode()


def _corner(word: str, number: int, vertices_so_far: int) -> int:
    """0-based: 7 is the seventh vertex of the file, -1 the latest one before this line."""
    index = whole(word.partition("/")[0], number, "a face")
    if index == 0:
        raise ShapeFileError(f"line {number} holds a face with vertex 0, but OBJ files count from 1.")
    if index < -vertices_so_far:
        raise ShapeFileError(
            f"line {number} holds a face with vertex {index}, but only {vertices_so_far} come before it."
        )
    return index - 1 if index > 0 else vertices_so_far + index


def _check_corners(corners: list[int], counts: list[int], vertex_count: int) -> None:
    """The shape would complain as well, but in 0-based numbers that stand nowhere in the file."""
    highest = max(corners)
    if highest >= vertex_count:
        face = int(np.searchsorted(np.cumsum(counts), corners.index(highest), side="right"))
        raise ShapeFileError(
            f"face {face} uses vertex {highest + 1}, but the file holds {vertex_count}. Is it cut off?"
        )
