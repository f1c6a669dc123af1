"""Linear finite elements with a direction: the matrices of eq. (24), split by how they depend on θ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._check import FloatArray, IntArray
from ..geometry import PointCloud, PrincipalFrames, TriangleMesh


@dataclass(frozen=True, eq=False)
class Elements:
    """Weighted triangles, each with a principal frame: what a mesh's faces and a cloud's fans have in common.

    corners : (t, 3) vertex indices, counter-clockwise about the normal.
    areas : (t,), unit length², > 0. weights : (t,), 1 for a mesh, 1/3 for a cloud, where each triangle is counted
        about thrice.
    along_max, along_min : (t, 3) parts along u_M and u_m of the edge opposite to each corner, unit length.
    frames : (t,) which row of the shape's principal frames, or of its frames `on_fans`, each element uses.
    """

    corners: IntArray
    areas: FloatArray
    weights: FloatArray
    along_max: FloatArray
    along_min: FloatArray
    frames: IntArray

    @classmethod
    def of(cls, shape: TriangleMesh | PointCloud, frames: PrincipalFrames) -> Elements:
        """A mesh's faces with area (one without carries no heat and is left out), or all triangles of a cloud's
        fans."""
        return _fans(shape, frames) if isinstance(shape, PointCloud) else _faces(shape, frames)

    @property
    def weighted_areas(self) -> FloatArray:
        """(t,), unit length²; sums to the shape's area."""
        return self.weights * self.areas

    def masses(self, vertex_count: int) -> FloatArray:
        """Lumped mass (n,): a third of the area of each adjacent element, unit length²."""
        share = np.repeat(self.weighted_areas / 3, 3)
        return np.bincount(self.corners.ravel(), share, vertex_count).astype(np.float64)


def directional_parts(elements: Elements) -> tuple[FloatArray, FloatArray, FloatArray]:
    r"""Element matrices I, C, S, each (t, 3, 3), of which every conductivity and angle is made.

    area · ∇φ_i · D(θ) ∇φ_j = (a + b)/2 · I + (a − b)/2 · (cos 2θ · C + sin 2θ · S) for D(θ) = a t tᵀ + b s sᵀ,
    where t is u_M turned by θ counter-clockwise about the normal and s = n × t.
    """
    # A hat function's gradient is the opposite edge turned by 90°: ∇φ = (−q u_M + p u_m)/(2A) for an edge
    # p u_M + q u_m. Eq. (24) writes D between the edges themselves, which taken literally exchanges a and b.
    x, y = -elements.along_min, elements.along_max
    scale = (elements.weights / (4 * elements.areas))[:, None, None]
    xx, yy = scale * x[:, :, None] * x[:, None, :], scale * y[:, :, None] * y[:, None, :]
    xy = scale * x[:, :, None] * y[:, None, :]
    return xx + yy, xx - yy, xy + xy.transpose(0, 2, 1)


def _faces(mesh: TriangleMesh, frames: PrincipalFrames) -> Elements:
    kept = np.flatnonzero(mesh.has_area)
    edges = mesh.opposite_edges[kept]
    return Elements(
        corners=mesh.faces[kept],
        areas=mesh.face_areas[kept],
        weights=np.ones(len(kept)),
        along_max=np.einsum("tci,ti->tc", edges, frames.max_direction[kept]),
        along_min=np.einsum("tci,ti->tc", edges, frames.min_direction[kept]),
        frames=kept,
    )


def _fans(cloud: PointCloud, frames: PrincipalFrames) -> Elements:
    fans = cloud.fans
    centre, own = fans.triangles[:, 0], np.arange(len(fans.triangles))
    rows, frames = (centre, frames) if frames.on_fans is None else (own, frames.on_fans)
    normal = np.cross(fans.edges[:, 0], fans.edges[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    # The frame of the centre, or nearly that of the triangle, laid into it: u_M follows, u_m stands across it.
    across = np.cross(normal, frames.max_direction[rows])
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), np.finfo(float).tiny)
    return Elements(
        corners=fans.triangles,
        areas=fans.areas,
        weights=fans.weights,
        along_max=np.einsum("tci,ti->tc", fans.edges, np.cross(across, normal)),
        along_min=np.einsum("tci,ti->tc", fans.edges, across),
        frames=rows,
    )
