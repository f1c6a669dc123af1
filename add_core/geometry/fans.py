"""Triangle fans: what a point cloud has in place of faces."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np

from .._check import BoolArray, FloatArray, IntArray, read_only
from .arcs import arc_edges
from .bridges import bridging_triangles
from .neighbours import DistinctPoints
from .normals import EstimatedNormals
from .stars import closed_stars, star_corners, surface_stars
from .tangent_planes import TangentPlanes

_log = logging.getLogger(__name__)
FLAT_ENOUGH = 0.8
"""Cosine between a triangle and the tangent planes of its corners above which it surely lies on the surface."""


@dataclass(frozen=True, eq=False)
class Fans:
    """For every point the triangles around it in the Delaunay triangulation of its neighbours in its tangent plane.

    triangles : (t, 3) point numbers, the centre of the fan first, counter-clockwise about the centre's normal.
    weights : (t,), > 0, how much of the surface each triangle stands for. 1/3 where the fans of all three corners
        hold it, so that they make up one triangle together; where fans disagree, such that together they cover the
        surface once.
    edges : (t, 3, 3), the edge opposite to each corner, counter-clockwise, as long as the arc that it stands for.
    areas : (t,), unit length², > 0, of triangles with these edges.
    isolated : the points that no triangle touches; nothing runs to or from them.
    """

    triangles: IntArray
    weights: FloatArray
    edges: FloatArray
    areas: FloatArray
    isolated: IntArray


def build_fans(
    points: FloatArray,
    normals: FloatArray,
    planes: TangentPlanes,
    distinct: DistinctPoints,
    *,
    estimated: EstimatedNormals | None = None,
) -> Fans:
    """Fans of a cloud from the tangent planes of its distinct points.

    They are the `surface_stars` of the points without triangles that bridge a gap, closed along the bottoms of folds.
    A point on the boundary has an open fan. Points in one place share the fans around it: they take their turns as
    corners.

    estimated : of the distinct points, if their normals are rather than given.
    """
    first = distinct.first
    places, upright = points[first], normals[first]
    stars = surface_stars(planes)
    corners = star_corners(stars, planes)
    spacing = planes.nearest.distances[:, :6].sum(axis=1) / 6
    sure = _is_flat(corners, places, upright) & (_holders(corners) >= 3)
    bridging = bridging_triangles(corners, sure, places, upright, spacing=spacing, estimated=estimated)
    corners = star_corners(closed_stars(stars, bridging, planes), planes)
    weights = _weights(corners, _is_flat(corners, places, upright), len(first))
    triangles, weights = _shared_by_duplicates(corners, weights, distinct)
    touched = np.zeros(len(distinct.place), dtype=bool)
    touched[triangles] = True
    isolated = np.flatnonzero(~touched)
    if 0 < len(isolated) < len(distinct.place):  # with no triangle at all an error follows, which says more
        _log.warning("%d of %d points touch no triangle (first: %d).", len(isolated), len(distinct.place), isolated[0])
    edges = arc_edges(points, normals, triangles)
    areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / 2
    return Fans(*map(read_only, (triangles, weights, edges, areas, isolated)))


def _is_flat(stars: IntArray, points: FloatArray, normals: FloatArray) -> BoolArray:
    """(t,): whether a triangle lies within `FLAT_ENOUGH` in the tangent planes of all its corners."""
    a, b, c = (points[stars[:, i]] for i in range(3))
    upright = np.cross(b - a, c - a)
    upright /= np.linalg.norm(upright, axis=1, keepdims=True)
    return np.asarray(np.einsum("ti,tci->tc", upright, normals[stars]).min(axis=1, initial=1.0) > FLAT_ENOUGH)


def _holders(stars: IntArray) -> IntArray:
    """(t,): how many fans hold each triangle."""
    _, same, counts = np.unique(np.sort(stars, axis=1), axis=0, return_inverse=True, return_counts=True)
    return np.asarray(counts[same.ravel()])


def _weights(stars: IntArray, flat: BoolArray, count: int) -> FloatArray:
    """(t,): one over how many fans cover the same side of an edge of the triangle, the most crowded of its edges.

    1/3 where the fans agree, 1/4 where four points on a circle all choose the diagonals to themselves, 1/2 where
    none does. What fewer than three fans claim counts no more than a third where it is not `flat` on the surface:
    there it may bridge a gap.
    """
    sides = stars[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 3, 2)
    _, edge, fans = np.unique(sides @ np.array([count, 1]), return_inverse=True, return_counts=True)
    cover = fans[edge.reshape(-1, 3)].max(axis=1, initial=1)
    return np.asarray(1.0 / np.where(flat & (cover > 1), cover, np.maximum(cover, 3)))


def _shared_by_duplicates(
    stars: IntArray, weights: FloatArray, distinct: DistinctPoints
) -> tuple[IntArray, FloatArray]:
    """Triangles over all points: as many copies of each as the most crowded of its corners has points, sharing its
    weight."""
    by_place = np.argsort(distinct.place, kind="stable")
    crowd = np.bincount(distinct.place, minlength=len(distinct.first))
    begin = np.cumsum(crowd) - crowd
    copies = crowd[stars].max(axis=1)
    row = np.repeat(np.arange(len(stars)), copies)
    turn = np.arange(len(row)) - np.repeat(np.cumsum(copies) - copies, copies)
    corner = stars[row]
    triangles = by_place[begin[corner] + turn[:, None] % crowd[corner]]
    return triangles, (weights / copies)[row]
