"""The stars of a cloud's points: the Delaunay triangles around each in its tangent plane, closed in steps."""

from __future__ import annotations

import numpy as np

from .._check import BoolArray, FloatArray, IntArray
from .delaunay_stars import delaunay_stars
from .distinct import is_among, sorted_distinct
from .tangent_planes import TangentPlanes

_GAP = 0.05  # radians of a star that do not count as open


def surface_stars(planes: TangentPlanes) -> IntArray:
    """(t, 3): centre and two neighbours as columns of `planes`, counter-clockwise about the centre's normal.

    Neighbours that seem to lie across a limb or a gap are left out of a star at first, and let in by a more lenient
    test if the star stays open without them, or by none if the point would touch no triangle at all.
    """
    if planes.near.shape[1] < 2:
        return np.empty((0, 3), dtype=np.int64)
    stars = delaunay_stars(planes.plane, planes.on_surface, planes.ties)
    stars = _widened(stars, planes, planes.perhaps, _is_open(stars, planes))
    lonely = np.bincount(star_corners(stars, planes)[:, 1:].ravel(), minlength=len(planes.near)) == 0
    lonely[stars[:, 0]] = False
    return _widened(stars, planes, planes.near, lonely)


def closed_stars(stars: IntArray, bridging: BoolArray, planes: TangentPlanes) -> IntArray:
    """`surface_stars` without the triangles that bridge a gap, closed along the bottoms of folds.

    Where a fold is pressed shut, as an armpit is, normals on its two walls face each other and say nothing about who is
    whose neighbour; but points at its bottom are the only ones whose stars stay open from the start. Those are sought
    anew among what sound triangles join them to and one another, whatever their normals, along chords that do not
    stand upright on either and are no bridge's.

    bridging : (t,), which triangles of `stars` bridge.
    """
    if not len(stars):
        return stars
    ends = _is_open(stars, planes)
    sides = _sides(star_corners(stars, planes), len(planes.near))
    sound = sorted_distinct(sides[~bridging])
    bridges = sorted_distinct(sides[bridging])
    bridges = bridges[~is_among(bridges, sound)]
    usable = planes.alongside & ends[planes.nearest.indices] & ~_are_among(bridges, planes)
    usable |= _are_among(sound, planes)
    return _widened(stars[~bridging], planes, usable, ends)


def star_corners(stars: IntArray, planes: TangentPlanes) -> IntArray:
    """(t, 3): the stars as numbers of points."""
    return np.column_stack([stars[:, 0], planes.nearest.indices[stars[:, :1], stars[:, 1:]]])


def _widened(stars: IntArray, planes: TangentPlanes, usable: BoolArray, candidates: BoolArray) -> IntArray:
    """The stars, those of `candidates` replaced by stars among all `usable` neighbours where these leave less
    open."""
    rows = np.flatnonzero(candidates)
    wider = delaunay_stars(planes.plane[rows], usable[rows], planes.ties[rows])
    wider[:, 0] = rows[wider[:, 0]]
    better = _covered_angles(wider, planes) > _covered_angles(stars, planes) + _GAP
    return np.concatenate([stars[~better[stars[:, 0]]], wider[better[wider[:, 0]]]])


def _is_open(stars: IntArray, planes: TangentPlanes) -> BoolArray:
    return np.asarray(_covered_angles(stars, planes) < 2 * np.pi - _GAP)


def _covered_angles(stars: IntArray, planes: TangentPlanes) -> FloatArray:
    """(n,): radians around each point that its star covers."""
    row, first, second = stars.T
    a, b = planes.plane[row, first], planes.plane[row, second]
    angle = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], np.einsum("ti,ti->t", a, b))
    return np.bincount(row, angle, len(planes.near)).astype(np.float64)


def _sides(corners: IntArray, count: int) -> IntArray:
    """(t, 3): the sides of triangles as numbers low · count + high."""
    return np.asarray(np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 3, 2), axis=2) @ np.array([count, 1]))


def _are_among(sides: IntArray, planes: TangentPlanes) -> BoolArray:
    """(n, k): whether the way from each point to its neighbour is one of the `sides`, which are ascending."""
    count = len(planes.near)
    here, there = np.arange(count)[:, None], planes.nearest.indices
    return is_among(np.minimum(here, there) * count + np.maximum(here, there), sides)
