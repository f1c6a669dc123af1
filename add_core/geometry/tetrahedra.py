"""The Delaunay tetrahedra between the points of a cloud: balls that hold no point, and the facets where they meet."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import Delaunay, QhullError

from .._check import BoolArray, FloatArray, IntArray

_FACETS = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])  # corners of the facet opposite to each corner
_FLAT = 1e-9  # of the cube of the longest edge: determinant of a tetrahedron without volume


@dataclass(frozen=True, eq=False)
class Tetrahedra:
    """Delaunay tetrahedra of points in different places, and the ball through the corners of each.

    points : (n, 3), their middle at 0, the farthest coordinate at 1. scale : what 1 is in the cloud's own unit.
    corners : (t, 4). neighbours : (t, 4), the tetrahedron
        opposite to each corner, −1 outside the hull.
    centres : (t, 3) and radii : (t,), of the balls; of tetrahedra without volume 0 and 1, which mean nothing.
    solid : (t,), whether a tetrahedron has volume.
    """

    points: FloatArray
    scale: float
    corners: IntArray
    neighbours: IntArray
    centres: FloatArray
    radii: FloatArray
    solid: BoolArray

    @classmethod
    def between(cls, points: FloatArray) -> Tetrahedra | None:
        """The tetrahedra, or None of points that all lie in one plane."""
        if len(points) < 5:
            return None
        points = points - points.mean(axis=0)
        scale = float(np.abs(points).max())
        points = points / scale
        try:
            found = Delaunay(points)
        except QhullError:
            return None
        corners = found.simplices.astype(np.int64)
        edges = points[corners[:, 1:]] - points[corners[:, :1]]
        squares = np.einsum("tij,tij->ti", edges, edges)
        across = np.cross(edges[:, [1, 2, 0]], edges[:, [2, 0, 1]])
        volume = np.einsum("ti,ti->t", edges[:, 0], across[:, 0])
        solid = np.abs(volume) > _FLAT * squares.max(axis=1) ** 1.5
        centres = np.zeros((len(corners), 3))
        offset = np.einsum("ti,tij->tj", squares, across)
        np.divide(offset, 2 * volume[:, None], out=centres, where=solid[:, None])
        radii = np.where(solid, np.linalg.norm(centres, axis=1), 1.0)
        centres[solid] += points[corners[solid, 0]]
        return cls(points, scale, corners, found.neighbors.astype(np.int64), centres, radii, solid)

    @cached_property
    def facets(self) -> Facets:
        """Every facet once."""
        one = np.repeat(np.arange(len(self.corners)), 4)
        other = self.neighbours.ravel()
        once = np.flatnonzero((other < 0) | (one < other))
        one, other, opposite = one[once], other[once], once % 4
        corners = self.corners[one[:, None], _FACETS[opposite]]
        return Facets.between(self, corners, np.stack([one, other], axis=1), self.corners[one, opposite])

    @cached_property
    def directions(self) -> FloatArray:
        """(t, 4, 3), unit: from each corner to the middle of the ball; 0 without volume."""
        offset = self.centres[:, None] - self.points[self.corners]
        return np.asarray(np.where(self.solid[:, None, None], offset / self.radii[:, None, None], 0.0))

    @cached_property
    def shares(self) -> FloatArray:
        """(t, 4): the share of the directions around each corner in which its tetrahedron lies (solid angle / 4π)."""
        place = self.points[self.corners]
        share = np.empty(self.corners.shape)
        for corner, (a, b, c) in enumerate(_FACETS):
            arms = place[:, [a, b, c]] - place[:, [corner]]
            arms /= np.linalg.norm(arms, axis=2, keepdims=True)
            u, v, w = arms[:, 0], arms[:, 1], arms[:, 2]
            volume = np.abs(np.einsum("ti,ti->t", u, np.cross(v, w)))
            cosines = [np.einsum("ti,ti->t", p, q) for p, q in ((u, v), (v, w), (w, u))]
            share[:, corner] = np.arctan2(volume, 1 + sum(cosines)) / (2 * np.pi)
        return share


@dataclass(frozen=True, eq=False)
class Facets:
    """The triangles between tetrahedra.

    corners : (f, 3). sides : (f, 2), the tetrahedra on both sides; the second is −1 on the hull.
    upright : (f, 3), unit, from the first side to the second.
    sinking : (f, 2), how far the middle of the ball on either side lies behind the facet, over the ball's radius:
        1 where a facet is small for the ball and so lies on its skin, 0 where it cuts the ball in halves, below where
        more than half of the ball lies on the other side. 0 without volume and outside the hull.
    angles : (f, 3), radians, at the corners. radii : (f,), of the circle through the corners. areas : (f,).
    """

    corners: IntArray
    sides: IntArray
    upright: FloatArray
    sinking: FloatArray
    angles: FloatArray
    radii: FloatArray
    areas: FloatArray

    @classmethod
    def between(cls, tetrahedra: Tetrahedra, corners: IntArray, sides: IntArray, opposite: IntArray) -> Facets:
        place = tetrahedra.points[corners]
        edges = place[:, [2, 0, 1]] - place[:, [1, 2, 0]]  # opposite to the corners
        upright = np.cross(edges[:, 0], edges[:, 1])
        double = np.linalg.norm(upright, axis=1)
        inward = np.einsum("fi,fi->f", upright, tetrahedra.points[opposite] - place[:, 0]) > 0
        upright *= (np.where(inward, -1.0, 1.0) / np.maximum(double, np.finfo(float).tiny))[:, None]
        lengths = np.linalg.norm(edges, axis=2)
        radii = lengths.prod(axis=1) / np.maximum(2 * double, np.finfo(float).tiny)
        cosines = -np.einsum("fci,fci->fc", edges[:, [1, 2, 0]], edges[:, [2, 0, 1]])
        angles = np.arctan2(double[:, None], cosines)
        sinking = np.zeros(sides.shape)
        for side, sign in ((0, -1.0), (1, 1.0)):
            there = (sides[:, side] >= 0) & tetrahedra.solid[sides[:, side]]
            ball = sides[there, side]
            height = np.einsum("fi,fi->f", tetrahedra.centres[ball] - place[there, 0], upright[there])
            sinking[there, side] = sign * height / tetrahedra.radii[ball]
        return cls(corners, sides, upright, sinking, angles, radii, double / 2)
