"""What is drawn of a shape: the triangles of a mesh, or a disc for each point of a cloud."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray
from ..geometry import PointCloud, TriangleMesh

VISIBLE_CORNERS, OPAQUE_CORNERS = 10, 6
"""Of the polygons that stand for discs."""
NEIGHBOURS = 6
VISIBLE_DISC, OPAQUE_DISC = 0.45, 1.1
"""Radii in mean distances to the neighbours: discs that nearly touch, and discs that leave no gap to look through."""
BEND = 0.55


@dataclass(frozen=True, eq=False)
class Facets:
    """Triangles that carry the values of a shape's n vertices.

    places : (p, 3). faces : (m, 3) indices of places. owner : (p,), the vertex whose values a place has. normals :
        (p, 3) unit, outward. hiding : how many of the last faces only hide what lies behind them and are not drawn.
    depth_bias : length by which those are to be moved away from the eye.
    """

    places: FloatArray
    faces: IntArray
    owner: IntArray
    normals: FloatArray
    hiding: int = 0
    depth_bias: float = 0.0

    @classmethod
    def of(cls, shape: TriangleMesh | PointCloud) -> Facets:
        """The triangles of a mesh; for a cloud a disc in the tangent plane of each point, and larger ones that hide
        the far side, so that it does not shine through.
        """
        if isinstance(shape, TriangleMesh):
            return cls(shape.vertices, shape.faces, np.arange(shape.vertex_count), shape.vertex_normals)
        count = shape.vertex_count
        # Not one radius for all: clouds that were mesh vertices lie closer on hands than on shins.
        near = np.asarray(KDTree(shape.points).query(shape.points, k=min(NEIGHBOURS + 1, count))[0])[:, 1:]
        spacing = near.mean(axis=1) if count > 1 else np.ones(count)
        seen = _discs(shape.points, shape.outward_normals, VISIBLE_DISC * spacing, VISIBLE_CORNERS)
        behind = _discs(shape.points, shape.outward_normals, OPAQUE_DISC * spacing, OPAQUE_CORNERS)
        places, faces, bent = (np.concatenate([one, two]) for one, two in zip(seen, behind, strict=True))
        faces[len(seen[1]) :] += len(seen[0])
        owner = np.concatenate([np.repeat(np.arange(count), size + 1) for size in (VISIBLE_CORNERS, OPAQUE_CORNERS)])
        return cls(places, faces, owner, bent, len(behind[1]), 1.5 * float(np.median(spacing)))


def _discs(
    centres: FloatArray, normals: FloatArray, radii: FloatArray, corners: int
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Places, faces and normals of a polygon of radius (n,) about each centre: its middle, then its `corners`.

    Normals lean outward at the rim, so that each disc is told from its neighbours as a bead would be.
    """
    least = np.eye(3)[np.abs(normals).argmin(axis=1)]
    first = np.cross(normals, least)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(normals, first)
    turn = 2 * np.pi * np.arange(corners) / corners
    ring = np.cos(turn)[:, None] * first[:, None] + np.sin(turn)[:, None] * second[:, None]
    ring = np.concatenate([np.zeros((len(centres), 1, 3)), ring], axis=1)
    places = centres[:, None] + radii[:, None, None] * ring
    bent = normals[:, None] + BEND * ring
    bent /= np.linalg.norm(bent, axis=2, keepdims=True)
    rim = np.arange(corners)
    fan = np.stack([np.zeros(corners, int), 1 + rim, 1 + (rim + 1) % corners], axis=1)
    faces = fan[None] + (corners + 1) * np.arange(len(centres))[:, None, None]
    return places.reshape(-1, 3), faces.reshape(-1, 3).astype(np.int64), bent.reshape(-1, 3)
