"""Samples of a shape: regular subsets of its vertices, and the point clouds that they make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._check import FloatArray, IntArray, count_in, instance_of, read_only, vertex_index
from ..errors import ParameterError
from .cloud import PointCloud
from .mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class Subsample:
    """A point cloud taken from the vertices of a shape.

    cloud : the points, with the shape's normals where it has any.
    indices : (count,), the vertex of the shape that each point was.
    """

    cloud: PointCloud
    indices: IntArray


def farthest_points(shape: TriangleMesh | PointCloud, count: int, start: int | None = None) -> IntArray:
    """Vertices chosen one after another, each the farthest from all chosen before: (count,) indices, `start` first.

    start : None for the first vertex that any face uses; any point of a cloud may be.
    The distance is Euclidean, straight through space: it differs from geodesic sampling only between parts that
    nearly touch, and 4K of 50K vertices take half a second and one number a vertex of memory.
    Every prefix is a regular sample itself. Vertices that no face uses are never chosen; ties go to the lower index.

    Raises ParameterError if `count` exceeds the number of vertices to choose from, or `start` is not one of them.
    """
    instance_of("shape", shape, TriangleMesh, PointCloud)
    allowed = shape.is_referenced if isinstance(shape, TriangleMesh) else np.ones(shape.vertex_count, dtype=bool)
    count = count_in("count", count, 1, int(allowed.sum()))
    start = int(np.argmax(allowed)) if start is None else vertex_index("start", start, shape.vertex_count)
    if not allowed[start]:
        raise ParameterError(
            f"start must be a vertex of some face, but no face uses {start}. Leave it out to begin with one."
        )
    size = np.ptp(shape.vertices, axis=0).max()
    unit = (shape.vertices - shape.vertices.min(axis=0)) / (
        size if size > 0 else 1.0
    )  # squares of any unit stay finite
    distances = np.where(allowed, np.inf, -1.0)
    return read_only(_farthest_from_chosen(np.ascontiguousarray(unit.T), distances, count, start))


def subsample(shape: TriangleMesh | PointCloud, count: int, *, start: int | None = None) -> Subsample:
    """A cloud of `count` farthest points of the shape, with its (area-weighted vertex) normals and its vertex
    numbers.

    start : the vertex taken first, as for `farthest_points`. Every smaller sample from it is the beginning of a larger
        one.
    Where a chosen vertex of a mesh has no normal (all faces around it are flat), the cloud is left without normals.

    Raises ParameterError as `farthest_points` does.
    """
    indices = farthest_points(shape, count, start)
    normals = shape.vertex_normals if isinstance(shape, TriangleMesh) else shape.normals
    chosen = None if normals is None else normals[indices]
    if chosen is not None and not chosen.any(axis=1).all():
        chosen = None
    return Subsample(PointCloud(shape.vertices[indices], chosen, shape.name), indices)


def _farthest_from_chosen(coordinates: FloatArray, nearest: FloatArray, count: int, start: int) -> IntArray:
    x, y, z = coordinates
    step, part = np.empty_like(x), np.empty_like(x)
    chosen = np.empty(count, dtype=np.int64)
    for k in range(count):
        i = int(np.argmax(nearest)) if k else start
        chosen[k] = i
        np.subtract(x, x[i], out=step)
        np.multiply(step, step, out=step)
        for axis in (y, z):
            np.subtract(axis, axis[i], out=part)
            np.multiply(part, part, out=part)
            np.add(step, part, out=step)
        np.minimum(nearest, step, out=nearest)
        nearest[i] = -1.0  # never again, even where only duplicates of chosen points are left
    return chosen
