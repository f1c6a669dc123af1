"""OFF: counts, vertices, polygons. Colours are ignored; normals (NOFF) are kept for points without faces."""

from __future__ import annotations

import re

import numpy as np

from .._check import IntArray
from ..errors import ShapeFileError
from ..geometry import PointCloud
from .contents import Fields, FileContents, Shape, fan_triangles
from .text import Line, excerpt, float_rows, lines_of, whole

_HEADER = re.compile(r"(ST)?C?(N)?(4)?(n)?OFF")


def read(data: bytes) -> FileContents:
    """The vertices and faces of an OFF file, in its order, 0-based."""
    lines = lines_of(data)
    if not lines:
        raise ShapeFileError("holds only comments.")
    header = _HEADER.match(lines[0][1][0])
    if header is None:
        raise ShapeFileError(f"an OFF file starts with the word OFF, but this one starts with {excerpt(lines[0][1])}.")
    if header[3] or header[4]:
        raise ShapeFileError("holds points of another dimension than three.")
    vertex_count, face_count, rest = _counts(lines, header[0])
    if vertex_count + face_count > len(rest):
        raise ShapeFileError(
            f"claims {vertex_count} vertices and {face_count} faces, but only {len(rest)} lines follow. Is it cut off?"
        )
    width = 6 if header[2] else 3
    numbers = float_rows(rest[:vertex_count], width, f"a vertex of {width} numbers")
    faces = _faces(rest[vertex_count : vertex_count + face_count]) if face_count else None
    return FileContents(numbers[:, :3], faces, numbers[:, 3:] if header[2] else None)


def write(shape: Shape, fields: Fields) -> bytes:
    """An OFF file; coordinates are written so that reading returns the same bits."""
    faces = [] if isinstance(shape, PointCloud) else shape.faces.tolist()
    lines = ["OFF", f"{shape.vertex_count} {len(faces)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in shape.vertices.tolist()]
    lines += [f"3 {i} {j} {k}" for i, j, k in faces]
    return ("\n".join(lines) + "\n").encode()


def _counts(lines: list[Line], header: str) -> tuple[int, int, list[Line]]:
    """Vertices, faces, and the lines after the counts, which stand behind the header or on the next line."""
    number, words = lines[0]
    counts, rest = [words[0].removeprefix(header), *words[1:]], lines[1:]
    counts = [word for word in counts if word]
    if not counts:
        if not rest:
            raise ShapeFileError("ends before the numbers of vertices and faces.")
        (number, counts), rest = rest[0], rest[1:]
    if len(counts) < 2:
        raise ShapeFileError(
            f"line {number} should hold the numbers of vertices and faces, but it reads {excerpt(counts)}."
        )
    vertices, faces = (whole(word, number, "the numbers of vertices and faces") for word in counts[:2])
    if vertices < 0 or faces < 0:
        raise ShapeFileError(f"line {number} claims {vertices} vertices and {faces} faces.")
    return vertices, faces, rest


def _faces(lines: list[Line]) -> IntArray:
    corners: list[int] = []
    counts: list[int] = []
    for number, words in lines:
        count = whole(words[0], number, "a face")
        if not 0 <= count < len(words):
            raise ShapeFileError(
                f"line {number} claims a face of {count} corners, but {len(words) - 1} numbers follow."
            )
        counts.append(count)
        corners += [whole(word, number, "a face") for word in words[1 : count + 1]]
    return fan_triangles(np.array(corners, dtype=np.int64), np.array(counts, dtype=np.int64))
