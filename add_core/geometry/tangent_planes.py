"""The tangent plane at every point of a cloud, with the neighbours that lie on the same piece of surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._check import BoolArray, FloatArray
from .direction_field import TangentBasis
from .neighbours import Neighbours, nearest_neighbours
from .normals import reflected_cosines

FAN_NEIGHBOURS = 20
"""Neighbours among which a point's fan is sought: three rings of an even sample."""
FARTHEST = 2.0
"""How far away a neighbour may be, as a multiple of how far its own neighbours reach."""
STEEPEST = 0.8
"""Sine between chord and tangent plane above which a neighbour lies across a limb or a gap, not along the surface."""
LEAST_AGREEMENT = 0.3
"""Least reflected cosine between the normals of neighbours on one surface."""


@dataclass(frozen=True, eq=False)
class TangentPlanes:
    """Neighbours of every point, and how their normals turn, projected onto its tangent plane.

    basis : of the planes.
    nearest : neighbours (n, k) and their distances, in the cloud's own unit.
    plane : (n, k, 2), coordinates of the neighbours in `basis`, the point itself at 0. Each is as far away as in
        space, so that bending draws no neighbour nearer.
    bends : (n, k, 2), normal of the neighbour minus normal of the point in `basis`, as long as in space.
    near : (n, k): the neighbour has neighbours of its own about as far away; nothing is near to an outlier.
    on_surface : (n, k): near, neither end of the chord sees the other steeply above or below, and their normals
        agree.
    """

    basis: TangentBasis
    nearest: Neighbours
    plane: FloatArray
    bends: FloatArray
    near: BoolArray
    on_surface: BoolArray

    @classmethod
    def of(cls, points: FloatArray, normals: FloatArray, *, count: int = FAN_NEIGHBOURS) -> TangentPlanes:
        """Tangent planes of points in different places with unit `normals` (n, 3)."""
        nearest = nearest_neighbours(points, count)
        offset = points[nearest.indices] - points[:, None]
        direction = offset / nearest.distances[:, :, None]
        other = normals[nearest.indices]
        here = np.broadcast_to(normals[:, None], other.shape)
        slope = np.maximum(
            np.abs(np.einsum("nki,nki->nk", direction, here)), np.abs(np.einsum("nki,nki->nk", direction, other))
        )
        agree = reflected_cosines(direction, here, other) > LEAST_AGREEMENT
        reach = nearest.distances[:, -1:].max(axis=1, initial=0.0)
        near = nearest.distances <= FARTHEST * reach[nearest.indices]
        basis = TangentBasis.of(normals, points)
        plane, bends = _laid_down(offset, basis), _laid_down(other - here, basis)
        return cls(basis, nearest, plane, bends, near, near & agree & (slope < STEEPEST))


def _laid_down(vectors: FloatArray, basis: TangentBasis) -> FloatArray:
    """(n, k, 2): vectors (n, k, 3) turned down into the tangent planes of their rows, their lengths kept."""
    along = np.einsum("nki,ni->nk", vectors, basis.first), np.einsum("nki,ni->nk", vectors, basis.second)
    flat = np.stack(along, axis=2)
    shadow = np.maximum(np.linalg.norm(flat, axis=2), np.finfo(float).tiny)
    return np.asarray(flat * (np.linalg.norm(vectors, axis=2) / shadow)[:, :, None])
