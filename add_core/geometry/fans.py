"""Triangle fans: what a point cloud has in place of faces."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np

from .._check import BoolArray, FloatArray, IntArray, read_only
from .arcs import arc_edges
from .bridges import bridging_triangles
from .delaunay_stars import delaunay_stars
from .neighbours import DistinctPoints
from .tangent_planes import TangentPlanes

_log = logging.getLogger(__name__)
FLAT_ENOUGH = 0.8
"""Cosine between a triangle and the tangent planes of its corners above which it surely lies on the surface."""
_GAP = 0.05  # radians of a star that do not count as open
_TIE = 1e-7  # share of the spacing squared by which points on one circle are told apart


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
    points: FloatArray, normals: FloatArray, planes: TangentPlanes, distinct: DistinctPoints, *, estimated: bool = False
) -> Fans:
    """Fans of a cloud from the tangent planes of its distinct points.

    Neighbours that seem to lie across a limb or a gap are left out of a fan at first, and let in by a more lenient
    test if the fan stays open without them, or by none if the point would touch no triangle at all. A point on the
    boundary has an open fan. Triangles that bridge a gap all the same are left out. Points in one place share the
    fans around it: they take their turns as corners.

    estimated : whether the normals are, rather than given.
    """
    stars = _stars(planes)
    first = distinct.first
    flat = _flatness(stars, points[first], normals[first]) > FLAT_ENOUGH
    spacing = planes.nearest.distances[:, :6].sum(axis=1) / 6
    sure = flat & (_holders(stars) >= 3)
    sound = ~bridging_triangles(stars, sure, points[first], normals[first], spacing=spacing, estimated=estimated)
    weights = _weights(stars, flat, len(first))
    triangles, weights = _shared_by_duplicates(stars[sound], weights[sound], distinct)
    touched = np.zeros(len(distinct.place), dtype=bool)
    touched[triangles] = True
    isolated = np.flatnonzero(~touched)
    if 0 < len(isolated) < len(distinct.place):  # with no triangle at all an error follows, which says more
        _log.warning("%d of %d points touch no triangle (first: %d).", len(isolated), len(distinct.place), isolated[0])
    edges = arc_edges(points, normals, triangles)
    areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / 2
    return Fans(*map(read_only, (triangles, weights, edges, areas, isolated)))


def _stars(planes: TangentPlanes) -> IntArray:
    """(t, 3): centre and two neighbours, as numbers of distinct points."""
    n, k = planes.near.shape
    if k < 2:
        return np.empty((0, 3), dtype=np.int64)
    # Points of a grid lie on common circles. A tiny fixed weight per point decides which diagonal all fans around
    # take.
    spacing = float(np.median(planes.nearest.distances[:, :1]))
    weight = _TIE * spacing**2 * np.random.default_rng(0).random(size=(n,))
    ties = weight[planes.nearest.indices] - weight[:, None]
    stars = delaunay_stars(planes.plane, planes.on_surface, ties)
    stars = _widened(stars, planes, ties, planes.perhaps, _covered_angles(stars, planes) < 2 * np.pi - _GAP)
    lonely = np.bincount(planes.nearest.indices[stars[:, :1], stars[:, 1:]].ravel(), minlength=n) == 0
    lonely[stars[:, 0]] = False
    stars = _widened(stars, planes, ties, planes.near, lonely)
    return np.column_stack([stars[:, 0], planes.nearest.indices[stars[:, :1], stars[:, 1:]]])


def _widened(
    stars: IntArray, planes: TangentPlanes, ties: FloatArray, usable: BoolArray, candidates: BoolArray
) -> IntArray:
    """The stars, those of `candidates` replaced by stars among all `usable` neighbours where these leave less
    open."""
    rows = np.flatnonzero(candidates)
    wider = delaunay_stars(planes.plane[rows], usable[rows], ties[rows])
    wider[:, 0] = rows[wider[:, 0]]
    better = _covered_angles(wider, planes) > _covered_angles(stars, planes) + _GAP
    return np.concatenate([stars[~better[stars[:, 0]]], wider[better[wider[:, 0]]]])


def _covered_angles(stars: IntArray, planes: TangentPlanes) -> FloatArray:
    """(n,): radians around each point that its star covers."""
    row, first, second = stars.T
    a, b = planes.plane[row, first], planes.plane[row, second]
    angle = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], np.einsum("ti,ti->t", a, b))
    return np.bincount(row, angle, len(planes.near)).astype(np.float64)


def _flatness(stars: IntArray, points: FloatArray, normals: FloatArray) -> FloatArray:
    """(t,): least cosine between a triangle and the tangent planes of its corners."""
    a, b, c = (points[stars[:, i]] for i in range(3))
    upright = np.cross(b - a, c - a)
    upright /= np.linalg.norm(upright, axis=1, keepdims=True)
    return np.asarray(np.einsum("ti,tci->tc", upright, normals[stars]).min(axis=1, initial=1.0))


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
