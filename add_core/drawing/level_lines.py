"""Lines of equal value on the side of a mesh that is seen."""

from __future__ import annotations

import numpy as np

from .._check import FloatArray, IntArray
from ..geometry import TriangleMesh
from .camera import Camera
from .raster import rasterise

RESOLUTION = 900
"""Pixels along the shape's longest side, of the view that decides what is seen."""


def seen_faces(mesh: TriangleMesh, camera: Camera) -> IntArray:
    """(f,): the faces that are seen at least at one of some million pixels, ascending."""
    places = camera.seen(mesh.vertices)
    low, high = places.min(axis=0), places.max(axis=0)
    scale = RESOLUTION / float(max(high[0] - low[0], high[1] - low[1]))
    pixels = np.stack([(places[:, 0] - low[0]) * scale, (high[1] - places[:, 1]) * scale, places[:, 2]], axis=1)
    width, height = (np.ceil((high - low)[:2] * scale).astype(int) + 1).tolist()
    return np.unique(rasterise(pixels, mesh.faces, width, height).faces)


def level_lines(mesh: TriangleMesh, values: FloatArray, level: float, faces: IntArray) -> FloatArray:
    """Segments (s, 2, 3) where `values` (n,), linear inside the `faces` (f,), are equal to `level`."""
    corners = mesh.faces[faces]
    above = values[corners] > level
    crossed = above.any(axis=1) & ~above.all(axis=1)
    corners, above = corners[crossed], above[crossed]
    # One corner is alone on its side; the line cuts the two edges that leave it.
    alone = np.where((above.sum(axis=1) == 1)[:, None], above, ~above).argmax(axis=1)
    rows = np.arange(len(corners))
    start = corners[rows, alone]
    ends = [corners[rows, (alone + step) % 3] for step in (1, 2)]
    return np.stack([_cut(mesh.vertices, values, level, start, end) for end in ends], axis=1)


def _cut(vertices: FloatArray, values: FloatArray, level: float, start: IntArray, end: IntArray) -> FloatArray:
    share = (level - values[start]) / (values[end] - values[start])
    return np.asarray(vertices[start] + share[:, None] * (vertices[end] - vertices[start]))
