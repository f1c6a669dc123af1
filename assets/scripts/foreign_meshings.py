"""Bodies meshed anew by other programs, on whose meshings a network trained on our own kinds alone is less exact.

Needs pymeshlab (GPL; used by such scripts only, never shipped or imported by the program) beside pyvista. The isotropic
remeshing is the kind that the remeshed test people have, on other bodies; decimation is another kind altogether.
"""

from __future__ import annotations

import numpy as np
import pymeshlab
import pyvista as pv
from numpy.typing import NDArray

from add_core.geometry import TriangleMesh
from add_core.geometry.closest import closest_points
from add_core.learning import TrainingShape
from add_core.learning.training_set import UNKNOWN

ISOTROPIC = 0.6
"""Share of the bodies that are remeshed with nearly equilateral triangles; the others are decimated."""
COUNTS = (2500, 6500)
FARTHEST = 1.0
"""Vertices that lie farther than this from the body that they were made from, in mean edges, have no place on it."""


def foreign(mesh: TriangleMesh, draw: np.random.Generator) -> TrainingShape:
    """The same body as another program would mesh it, each vertex named by the nearest vertex or middle of an edge."""
    count = int(draw.integers(*COUNTS))
    made = isotropic(mesh, count) if draw.random() < ISOTROPIC else _decimated(mesh, count)
    return TrainingShape(made, nearest_places(mesh, made))


def nearest_places(mesh: TriangleMesh, made: TriangleMesh) -> NDArray[np.int64]:
    """(n,): for each vertex of `made` the nearest vertex of `mesh`, or middle of its edges, numbered after those."""
    found = closest_points(mesh, made.vertices, made.vertex_normals)
    faces = mesh.faces[found.faces]
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), axis=2)  # (n, 3, 2)
    keys = mesh.edges @ [mesh.vertex_count, 1]
    order = np.argsort(keys)
    middles = mesh.vertex_count + order[np.searchsorted(keys[order], edges @ [mesh.vertex_count, 1])]
    corners = mesh.vertices[faces]  # (n, 3, 3)
    candidates = np.concatenate([corners, 0.5 * (corners + np.roll(corners, -1, axis=1))], axis=1)
    points = np.einsum("nj,njk->nk", found.weights, corners)
    nearest = np.linalg.norm(candidates - points[:, None], axis=2).argmin(axis=1)
    places = np.concatenate([faces, middles], axis=1)[np.arange(len(points)), nearest]
    ends = mesh.vertices[mesh.edges]
    far = found.distances > FARTHEST * np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).mean()
    return np.where(far, UNKNOWN, places)


def isotropic(mesh: TriangleMesh, count: int) -> TriangleMesh:
    """The same surface with about `count` vertices and nearly equilateral triangles of one size."""
    length = 0.96 * np.sqrt(mesh.area / count * 2 / np.sqrt(3))
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
    meshes.meshing_isotropic_explicit_remeshing(
        iterations=8, targetlen=pymeshlab.PureValue(length), featuredeg=60, checksurfdist=False
    )
    current = meshes.current_mesh()
    return TriangleMesh(current.vertex_matrix(), current.face_matrix(), mesh.name)


def _decimated(mesh: TriangleMesh, count: int) -> TriangleMesh:
    made = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces).decimate(max(0.0, 1 - count / mesh.vertex_count))
    return TriangleMesh(np.asarray(made.points, dtype=np.float64), made.regular_faces, mesh.name)
