"""OFF: counts, vertices, polygons. Colours are ignored; normals (NOFF) are kept for points without faces.

Numbers are read by trimesh, from lines without what it stumbles over: comments, which make it read lines twice, and
polygons, of which it fails on five corners beside triangles and passes over one or two. Written here, because trimesh
rounds coordinates.
"""

from __future__ import annotations

import re
from io import StringIO
from itertools import pairwise

import numpy as np

from .._check import faces_array
from ..errors import ShapeFileError
from ..geometry import PointCloud
from .complaints import complaints_about
from .contents import Fields, FileContents, Shape, check_corner_counts
from .text import excerpt, lines_of

_HEADER = re.compile(r"(?:ST)?C?(N?)(4?n?)OFF\s*(.*)")
_COUNTS = re.compile(r"(\d{1,18})\s+(\d{1,18})(\s|$)")


def read(data: bytes) -> FileContents:
    """The vertices and faces of an OFF file, in its order, 0-based."""
    from trimesh.exchange.off import load_off

    lines = [" ".join(words) for _, words in lines_of(data)]
    if not lines:
        raise ShapeFileError("holds only comments.")
    header = _HEADER.match(lines[0])
    if header is None:
        raise ShapeFileError(f"an OFF file starts with the word OFF, but this one starts with {excerpt([lines[0]])}.")
    if header[2]:
        raise ShapeFileError("holds points of another dimension than three.")
    claims, rows = (header[3], lines[1:]) if header[3] else ("".join(lines[1:2]), lines[2:])
    vertex_count, face_count = _counts(claims)
    if vertex_count + face_count > len(rows):
        raise ShapeFileError(
            f"claims {vertex_count} vertices and {face_count} faces, but only {len(rows)} lines follow. Is it cut off?"
        )
    points, polygons = rows[:vertex_count], rows[vertex_count : vertex_count + face_count]
    with complaints_about("OFF"):
        triangles, triangle_count = _fans(polygons)
        if triangles:  # trimesh would not say that the corners look 1-based
            faces_array(np.loadtxt(triangles, usecols=(1, 2, 3), dtype=np.int64, ndmin=2), vertex_count)
        loaded = load_off(StringIO("\n".join(["OFF", f"{vertex_count} {triangle_count} 0", *points, *triangles])))
        normals = np.loadtxt(points, usecols=(3, 4, 5), ndmin=2) if header[1] and not face_count else None
    if len(loaded["faces"]) != triangle_count:
        raise ShapeFileError("has faces with fewer corners than they claim. Is it damaged?")
    return FileContents(loaded["vertices"], loaded["faces"] if face_count else None, normals)


def write(shape: Shape, fields: Fields) -> bytes:
    """An OFF file; coordinates are written so that reading returns the same bits."""
    faces = [] if isinstance(shape, PointCloud) else shape.faces.tolist()
    lines = ["OFF", f"{shape.vertex_count} {len(faces)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in shape.vertices.tolist()]
    lines += [f"3 {i} {j} {k}" for i, j, k in faces]
    return ("\n".join(lines) + "\n").encode()


def _counts(claims: str) -> tuple[int, int]:
    """How many vertices and faces the file claims."""
    if not claims:
        raise ShapeFileError("ends before the numbers of vertices and faces.")
    counts = _COUNTS.match(claims)
    if counts is None:
        raise ShapeFileError(
            f"should hold the numbers of vertices and faces, but instead it reads {excerpt([claims])}."
        )
    return int(counts[1]), int(counts[2])


def _fans(polygons: list[str]) -> tuple[list[str], int]:
    """The lines of faces as triangles, each polygon a fan around its first corner, and how many there should be."""
    counts = np.array([int(line.partition(" ")[0]) for line in polygons], dtype=np.int64)
    check_corner_counts(counts)
    if (counts == 3).all():
        return polygons, len(polygons)
    triangles = []
    for line, count in zip(polygons, counts, strict=True):
        corners = line.split()[1 : count + 1]
        triangles += [f"3 {corners[0]} {second} {third}" for second, third in pairwise(corners[1:])]
    return triangles, int((counts - 2).sum())
