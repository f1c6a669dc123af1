"""The tangent plane at every point of a cloud, with the neighbours that lie on the same piece of surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .._check import BoolArray, FloatArray
from .direction_field import TangentBasis
from .neighbours import Neighbours, nearest_neighbours
from .normals import reflected_cosines

FAN_NEIGHBOURS = 20
"""Neighbours among which a point's fan is sought: three rings of an even sample."""
FARTHEST = 2.0
"""How far away a neighbour may be, as a multiple of how far its own neighbours reach."""


_TIE = 1e-7  # share of the spacing squared by which points on one circle are told apart


@dataclass(frozen=True)
class SurfaceTest:
    """When two neighbours count as lying on one piece of surface.

    steepest : sine between their chord and either tangent plane above which one lies across a limb or a gap from
        the other.
    least_agreement : least reflected cosine between their normals.
    """

    steepest: float
    least_agreement: float


STRICT, LENIENT = SurfaceTest(0.85, 0.3), SurfaceTest(0.95, 0.0)
"""Tests for given normals. The lenient one is for points whose fan does not close otherwise, as in sharp creases."""
STRICT_ESTIMATED, LENIENT_ESTIMATED = SurfaceTest(0.8, 0.6), SurfaceTest(0.9, 0.3)
"""Estimated normals turn gradually wherever they are right."""


@dataclass(frozen=True, eq=False)
class TangentPlanes:
    """Neighbours of every point, and how their normals turn, projected onto its tangent plane.

    basis : of the planes.
    nearest : neighbours (n, k) and their distances, in the cloud's own unit.
    plane : (n, k, 2), coordinates of the neighbours in `basis`, the point itself at 0. Each is as far away as in
        space, so that bending draws no neighbour nearer.
    bends : (n, k, 2), normal of the neighbour minus normal of the point in `basis`, as long as in space.
    near : (n, k): the neighbour has neighbours of its own about as far away; nothing is near to an outlier.
    on_surface : (n, k): near, and on one piece of surface by the strict test. perhaps : by the lenient one.
        alongside : by the slope of the strict test alone, wherever the normals point.
    """

    basis: TangentBasis
    nearest: Neighbours
    plane: FloatArray
    bends: FloatArray
    near: BoolArray
    on_surface: BoolArray
    perhaps: BoolArray
    alongside: BoolArray

    @classmethod
    def of(cls, points: FloatArray, normals: FloatArray, *, estimated: bool = False) -> TangentPlanes:
        """Tangent planes of points in different places with unit `normals` (n, 3)."""
        nearest = nearest_neighbours(points, FAN_NEIGHBOURS)
        offset = points[nearest.indices] - points[:, None]
        other = normals[nearest.indices]
        here = np.broadcast_to(normals[:, None], other.shape)
        reach = nearest.distances[:, -1:].max(axis=1, initial=0.0)
        near = nearest.distances <= FARTHEST * reach[nearest.indices]
        strict, lenient = (STRICT_ESTIMATED, LENIENT_ESTIMATED) if estimated else (STRICT, LENIENT)
        direction = offset / nearest.distances[:, :, None]
        basis = TangentBasis.of(normals, points)
        return cls(
            basis,
            nearest,
            _laid_down(offset, basis),
            _laid_down(other - here, basis),
            near,
            near & _on_one_surface(direction, here, other, strict),
            near & _on_one_surface(direction, here, other, lenient),
            near & (_slopes(direction, here, other) < strict.steepest),
        )

    @cached_property
    def ties(self) -> FloatArray:
        """(n, k), added to squared distances: points of a grid lie on common circles. A tiny fixed weight per point
        decides which diagonal all fans around take."""
        spacing = float(np.median(self.nearest.distances[:, :1]))
        weight = _TIE * spacing**2 * np.random.default_rng(0).random(size=len(self.near))
        return np.asarray(weight[self.nearest.indices] - weight[:, None])


def _on_one_surface(direction: FloatArray, here: FloatArray, other: FloatArray, test: SurfaceTest) -> BoolArray:
    agreement = reflected_cosines(direction, here, other)
    return np.asarray((_slopes(direction, here, other) < test.steepest) & (agreement > test.least_agreement))


def _slopes(direction: FloatArray, here: FloatArray, other: FloatArray) -> FloatArray:
    """(n, k): sine between each chord and the tangent plane of that end on which it stands steeper."""
    heights = np.einsum("nki,nki->nk", direction, here), np.einsum("nki,nki->nk", direction, other)
    return np.asarray(np.maximum(np.abs(heights[0]), np.abs(heights[1])))


def _laid_down(vectors: FloatArray, basis: TangentBasis) -> FloatArray:
    """(n, k, 2): vectors (n, k, 3) turned down into the tangent planes of their rows, their lengths kept."""
    along = np.einsum("nki,ni->nk", vectors, basis.first), np.einsum("nki,ni->nk", vectors, basis.second)
    flat = np.stack(along, axis=2)
    shadow, length = np.linalg.norm(flat, axis=2), np.linalg.norm(vectors, axis=2)
    stretch = np.divide(length, shadow, out=np.zeros_like(length), where=shadow > 1e-100 * length)
    return np.asarray(flat * stretch[:, :, None])  # 0 for what stands upright: it has no direction in the plane
