"""Test shapes with ground truth between any two: as they are, remeshed each on its own, or as clouds of points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray, one_of
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh, subsample
from ..geometry.closest import closest_points
from ..io import Collection, humans
from ..io.shipped_variants import CLOUD_POINTS, remeshed_people, remeshed_person
from .truth import SurfacePoints

VARIANTS = ("mesh", "remeshed", "cloud")


@dataclass(frozen=True, eq=False)
class Sample:
    """One shape as it is evaluated, and where each of its points lies on the collection's own mesh.

    shape : with n points. original : the mesh that it was made from, with N vertices.
    place : (n,) points on the original's faces. symmetry : (n,), the mirror image of each point, or None.
    """

    name: str
    shape: TriangleMesh | PointCloud
    original: TriangleMesh
    place: SurfacePoints
    symmetry: IntArray | None


def sample(collection: Collection, index: int, variant: str = "mesh") -> Sample:
    """Shape number `index` of a collection with one connectivity, in one of three variants.

    variant : "mesh", as it is; "remeshed", a test person with other triangles of its own; "cloud", 4,000 farthest
        points with their normals.
    Raises ParameterError for an unknown variant, or a shape that does not ship remeshed.
    """
    one_of("variant", variant, VARIANTS)
    original = collection[index]
    if not isinstance(original, TriangleMesh):
        raise ParameterError(f"{collection.names[index]} must be a mesh to be evaluated, but it is a cloud of points.")
    shape: TriangleMesh | PointCloud = original
    place = at_vertices(np.arange(original.vertex_count))
    if variant == "cloud":
        # Each cloud starts at another vertex, so that no two share their points.
        part = subsample(original, min(CLOUD_POINTS, original.vertex_count), start=(97 * index) % original.vertex_count)
        shape, place = part.cloud, at_vertices(part.indices)
    if variant == "remeshed":
        shape, place = _remeshed(collection, index)
    symmetry = collection.symmetry
    mirror = None if symmetry is None else _counterparts(symmetry[place.corners], place.weights, original, shape)
    return Sample(f"{collection.names[index]}", shape, original, place, mirror)


def truth_between(source: Sample, target: Sample) -> SurfacePoints:
    """Where the points (q,) of one sample truly lie on another of the same collection.

    Their places on the common connectivity are taken to the other's mesh, and from there to its nearest face, or to the
    nearest point of a cloud.
    """
    if isinstance(target.shape, TriangleMesh) and target.shape is target.original:
        return source.place
    corners, weights = source.place.corners, source.place.weights
    places = np.einsum("qj,qjk->qk", weights, target.original.vertices[corners])
    if isinstance(target.shape, PointCloud):
        return at_vertices(np.asarray(KDTree(target.shape.points).query(places)[1], dtype=np.int64))
    normals = np.einsum("qj,qjk->qk", weights, target.original.vertex_normals[corners])
    found = closest_points(target.shape, places, normals)
    return SurfacePoints(target.shape.faces[found.faces], found.weights)


def at_vertices(vertices: IntArray) -> SurfacePoints:
    """Vertices (q,) as points on a surface."""
    return SurfacePoints(np.repeat(vertices[:, None], 3, axis=1), np.tile([1.0, 0.0, 0.0], (len(vertices), 1)))


def _counterparts(
    corners: IntArray, weights: FloatArray, original: TriangleMesh, shape: TriangleMesh | PointCloud
) -> IntArray:
    """The point of the shape nearest to each place on the original."""
    if shape is original:
        return np.asarray(corners[:, 0])
    places = np.einsum("qj,qjk->qk", weights, original.vertices[corners])
    return np.asarray(KDTree(shape.vertices).query(places)[1], dtype=np.int64)


def _remeshed(collection: Collection, index: int) -> tuple[TriangleMesh, SurfacePoints]:
    if collection.title != humans().title or index not in remeshed_people():
        raise ParameterError(f"{collection.names[index]} does not ship remeshed; only the test people do.")
    person = remeshed_person(remeshed_people().index(index))
    return person.mesh, SurfacePoints(person.corners, person.weights)
