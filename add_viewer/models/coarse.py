"""A coarse stand-in for a large shape, which is drawn while the camera moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from add_core.geometry import PointCloud, TriangleMesh

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]

MOST_DRAWN = 60_000
"""Vertices that software draws while it turns without a stand-in."""
_WANTED = 20_000
_BOXES = 100.0
"""Boxes along the diagonal of the first grid."""


@dataclass(frozen=True, eq=False)
class Coarse:
    """shape : fewer vertices, among the original ones. kept : (m,) which of the original vertices they are."""

    shape: TriangleMesh | PointCloud
    kept: IntArray


def coarse_of(shape: TriangleMesh | PointCloud) -> Coarse | None:
    """One vertex for each box of a grid, and the faces between different boxes; None where there are few anyway."""
    if shape.vertex_count <= MOST_DRAWN:
        return None
    kept, box = _one_in_each_box(shape.vertices)
    if isinstance(shape, PointCloud):
        normals = None if shape.normals is None else shape.normals[kept]
        return Coarse(PointCloud(shape.points[kept], normals=normals), kept)
    faces = box[shape.faces]
    apart = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    faces = faces[apart]
    low, middle, high = np.sort(faces, axis=1).T
    _, once = np.unique((low * len(kept) + middle) * len(kept) + high, return_index=True)
    return Coarse(TriangleMesh(shape.vertices[kept], faces[once]), kept) if len(once) else None


def _one_in_each_box(vertices: FloatArray) -> tuple[IntArray, IntArray]:
    """(m,) the first vertex in each box that has any, and (n,) the box of each vertex, numbered like those."""
    low = vertices.min(axis=0)
    size = float(np.linalg.norm(np.ptp(vertices, axis=0))) / _BOXES
    for _ in range(3):  # a surface has as many boxes as their size squared allows
        places = ((vertices - low) / size).astype(np.int64)
        wide = places.max(axis=0) + 1
        keys = (places[:, 0] * wide[1] + places[:, 1]) * wide[2] + places[:, 2]
        _, kept, box = np.unique(keys, return_index=True, return_inverse=True)
        if 0.7 * _WANTED < len(kept) < 1.4 * _WANTED:
            break
        size *= float(np.sqrt(len(kept) / _WANTED))
    return kept, box
