"""The symmetry of a shape in a neutral pose: a plane in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray, instance_of, positive, read_only
from ..geometry import PointCloud, TriangleMesh
from ..geometry.mirror import mirror_map

ROUNDS = 20
SAME_PLANE = 5.0
"""Tolerances by which an exact map of the triangles may miss the plane's, on average, to be of the same symmetry."""


@dataclass(frozen=True, eq=False)
class MirrorSymmetry:
    """The plane in which a shape mirrors itself best.

    found : whether the shape is symmetric about it, within the tolerance asked for.
    candidate : (n,), the vertex nearest to the mirror image of each vertex, exact where the triangles are symmetric
        too.
    normal : (3,), unit. offset : normal · x = offset on the plane, length.
    residual : mean distance from mirror images to the nearest vertices, ÷ the root mean square extent of the shape.
    """

    found: bool
    candidate: IntArray
    normal: FloatArray
    offset: float
    residual: float

    @property
    def eta(self) -> IntArray | None:
        """(n,): the mirror image of every vertex; None if the shape is not symmetric."""
        return self.candidate if self.found else None


def mirror_symmetry(shape: TriangleMesh | PointCloud, *, tolerance: float = 0.03) -> MirrorSymmetry:
    """Find the mirror plane of a shape in a neutral pose; for posed shapes there is `intrinsic_symmetry`.

    Planes across the principal axes and the coordinate axes are fitted to the shape and its image in turn, and the best
    is kept. tolerance : greatest `residual` at which the shape counts as symmetric; it has to exceed the distance
    between neighbouring vertices unless the vertices themselves are symmetric.
    Returns the plane and η (n,). Raises ParameterError if the tolerance is not positive.
    """
    instance_of("shape", shape, TriangleMesh, PointCloud)
    tolerance = positive("tolerance", tolerance)
    points = shape.vertices
    weights = shape.vertex_areas if isinstance(shape, TriangleMesh) and shape.has_mass.any() else np.ones(len(points))
    weights = weights / weights.sum()
    middle = weights @ points
    scatter = ((points - middle) * weights[:, None]).T @ (points - middle)
    extent = float(np.sqrt(np.trace(scatter))) or 1.0
    tree = KDTree(points)
    fits = [
        _fitted(points, weights, tree, normal, float(normal @ middle))
        for normal in np.concatenate([np.linalg.eigh(scatter)[1].T, np.eye(3)])
    ]
    residual, normal, offset, images = min(fits, key=lambda fit: fit[0])
    residual /= extent
    found = bool(residual <= tolerance)
    exact = mirror_map(shape) if found and isinstance(shape, TriangleMesh) else None
    if exact is not None and _places_agree(points, exact, normal, offset, SAME_PLANE * tolerance * extent):
        images = exact
    return MirrorSymmetry(found, read_only(images), read_only(normal), offset, residual)


def _fitted(
    points: FloatArray, weights: FloatArray, tree: KDTree, normal: FloatArray, offset: float
) -> tuple[float, FloatArray, float, IntArray]:
    """Mean distance, normal, offset and nearest vertices of the plane that ends the iteration begun at one."""
    for _ in range(ROUNDS):
        distance, nearest = tree.query(_reflected(points, normal, offset))
        ways = points - points[nearest]
        centre = 0.5 * (points + points[nearest])
        # A plane mirrors pairs best whose ways are all along its normal and whose middles all lie in it.
        spread = (centre - weights @ centre) * weights[:, None]
        quality = (ways * weights[:, None]).T @ ways - 4.0 * spread.T @ (centre - weights @ centre)
        turned = np.linalg.eigh(quality)[1][:, -1]
        turned = turned if turned @ normal >= 0 else -turned
        shifted = float(turned @ (weights @ centre))
        if np.allclose(turned, normal, atol=1e-12) and np.isclose(shifted, offset, atol=1e-12 * np.abs(points).max()):
            break
        normal, offset = turned, shifted
    distance, nearest = tree.query(_reflected(points, normal, offset))
    return float(weights @ distance), normal, offset, np.asarray(nearest, dtype=np.int64)


def _reflected(points: FloatArray, normal: FloatArray, offset: float) -> FloatArray:
    return np.asarray(points - 2.0 * np.outer(points @ normal - offset, normal))


def _places_agree(points: FloatArray, images: IntArray, normal: FloatArray, offset: float, reach: float) -> bool:
    return bool(np.linalg.norm(points[images] - _reflected(points, normal, offset), axis=1).mean() <= reach)
