"""Where points truly belong on another shape: at vertices, or anywhere inside its faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, IntArray, array_of, index_array, numbers, read_only
from ..errors import ParameterError

UNKNOWN = -1
"""Truth of a point that has no counterpart: it is left out of every score."""


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points inside the faces of a shape, as truth of shapes that share no vertices (remeshed ones, scans).

    corners : (q, 3), the vertices of the face that holds each point; −1 in all three where there is none.
    weights : (q, 3), barycentric coordinates, ≥ 0, each row summing to 1.

    Raises ParameterError if the arrays do not fit together or weights are not barycentric.
    """

    corners: IntArray
    weights: FloatArray

    def __init__(self, corners: ArrayLike, weights: ArrayLike) -> None:
        vertices, shares = array_of("corners", corners), numbers("weights", weights)
        if vertices.dtype.kind not in "iu":
            raise ParameterError(f"corners must hold integers, but it holds {vertices.dtype}.")
        if vertices.ndim != 2 or vertices.shape[1] != 3 or vertices.shape != shares.shape:
            raise ParameterError(
                f"corners and weights must both have shape (q, 3), but they have {vertices.shape} and {shares.shape}."
            )
        if not (np.isfinite(shares).all() and (shares >= 0).all() and np.allclose(shares.sum(axis=1), 1.0, atol=1e-4)):
            raise ParameterError("weights must be at least 0 and sum to 1 for each point, but they do not.")
        object.__setattr__(self, "corners", read_only(vertices.astype(np.int64)))
        object.__setattr__(self, "weights", read_only(shares / shares.sum(axis=1, keepdims=True)))

    def __len__(self) -> int:
        return len(self.corners)

    @property
    def nearest(self) -> IntArray:
        """(q,): the corner that weighs most, the first of equals."""
        return np.asarray(np.take_along_axis(self.corners, self.weights.argmax(axis=1)[:, None], axis=1)[:, 0])


@dataclass(frozen=True, eq=False)
class Truth:
    """Ground truth of q points, checked against the shape that they are matched to.

    points : where each belongs. vertex : (q,), the target vertex nearest to that. rows : the points whose truth is
        known.
    mirrored : the same for their mirror images, None in the asymmetric setting.
    """

    points: SurfacePoints
    rows: IntArray
    mirrored: SurfacePoints | None

    @classmethod
    def of(cls, truth: ArrayLike | SurfacePoints, symmetry: ArrayLike | None, *, queries: int, targets: int) -> Truth:
        """Check `truth` (q,) and `symmetry` (n,) against the numbers of query and target points.

        Raises ParameterError if they do not fit, or nothing is known about any point.
        """
        if isinstance(truth, SurfacePoints):
            points = truth
            index_array("truth", points.corners.ravel(), targets, count=3 * queries, least=UNKNOWN)
        else:
            vertex = index_array("truth", truth, targets, count=queries, least=UNKNOWN)
            points = SurfacePoints(np.repeat(vertex[:, None], 3, axis=1), np.tile([1.0, 0.0, 0.0], (queries, 1)))
        rows = np.flatnonzero((points.corners >= 0).all(axis=1))
        if not len(rows):
            raise ParameterError("truth must be known for at least one point, but it is -1 for all of them.")
        known = SurfacePoints(points.corners[rows], points.weights[rows])
        mirrored = None
        if symmetry is not None:
            mirror = index_array("symmetry", symmetry, targets, count=targets)
            mirrored = SurfacePoints(mirror[known.corners], known.weights)
        return cls(known, rows, mirrored)

    @property
    def vertex(self) -> IntArray:
        """(r,): the target vertex nearest to the truth of each of `rows`."""
        return self.points.nearest

    @property
    def mirror(self) -> IntArray:
        """(r,): the mirror image of `vertex`; `vertex` itself in the asymmetric setting."""
        return self.vertex if self.mirrored is None else self.mirrored.nearest
