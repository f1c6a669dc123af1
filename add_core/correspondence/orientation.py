"""Which way a map turns the surface: what tells a shape from its mirror image."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from .._check import FloatArray, IntArray, index_array, instance_of
from ..geometry import PointCloud, TriangleMesh
from ..geometry.neighbours import nearest_neighbours
from ..spectra import Spectrum


def turning_operator(mesh: TriangleMesh, field: FloatArray) -> csr_array:
    r"""Weak form of g ↦ n̂ · (∇f × ∇g), the rate at which g grows to the left of f's gradient: (n, n).

    field : (n,), f at the vertices. Row i is the integral against hat function i; divide by the mass for values.
    On a face n̂ · (∇f × ∇g) · 2 area = (f_b − f_a)(g_c − g_a) − (f_c − f_a)(g_b − g_a): no length enters. Its sign
    changes with the orientation of the faces.
    """
    corners = mesh.faces[mesh.has_area]
    values = field[corners]
    steps = np.roll(values, -1, axis=1) - np.roll(values, 1, axis=1)  # coefficient of g at each corner: f_next − f_last
    rows = np.repeat(corners, 3, axis=1).ravel()
    columns = np.tile(corners, (1, 3)).ravel()
    # A third of the face's integral goes to each of its corners; sum of −(f_next − f_last) g over the corners.
    entries = np.tile(-steps / 6.0, (1, 3)).ravel()
    n = mesh.vertex_count
    return csr_array((entries, (rows, columns)), shape=(n, n))


def orientation_operators(
    meshes: tuple[TriangleMesh, TriangleMesh],
    signals: tuple[FloatArray, FloatArray],
    spectra: tuple[Spectrum, Spectrum],
    counts: tuple[int, int],
) -> list[tuple[FloatArray, FloatArray]]:
    """Turning against each descriptor's gradient in the bases of both meshes: Ω = Φᵀ (turning operator) Φ (Ren et al.
    2018).

    signals : (n1, d) and (n2, d). Returns d pairs of (k1, k1) and (k2, k2).
    """
    pairs = []
    for one, two in zip(signals[0].T, signals[1].T, strict=True):
        matrices = [
            spectrum.eigenfunctions[:, :count].T @ (turning_operator(mesh, column) @ spectrum.eigenfunctions[:, :count])
            for mesh, spectrum, column, count in zip(meshes, spectra, (one, two), counts, strict=True)
        ]
        pairs.append((matrices[0], matrices[1]))
    return pairs


def preserved_orientation(
    shape_2: TriangleMesh | PointCloud, shape_1: TriangleMesh | PointCloud, match_21: ArrayLike
) -> float:
    """Share of shape 2's area whose faces a map of points lays down on shape 1 facing outward: 1 for a map that keeps
    orientation, 0 for a mirror image.

    match_21 : (n2,), the vertex of shape_1 for each of shape_2. On a cloud, triangles of neighbouring points stand in
        for faces, each counting alike. Faces that collapse say nothing and are left out.
    """
    for name, shape in (("shape_2", shape_2), ("shape_1", shape_1)):
        instance_of(name, shape, TriangleMesh, PointCloud)
    match = index_array("match_21", match_21, shape_1.vertex_count, count=shape_2.vertex_count)
    faces = outward_triangles(shape_2)
    weights = shape_2.face_areas if isinstance(shape_2, TriangleMesh) else np.ones(len(faces))
    return orientation_kept(shape_1, match[faces], weights)


def outward_triangles(shape: TriangleMesh | PointCloud) -> IntArray:
    """(m, 3), counter-clockwise from outside: a mesh's faces; a triangle of neighbouring points around each of a
    cloud."""
    if isinstance(shape, TriangleMesh):
        return shape.faces
    first = shape.distinct.first  # points in one place span no triangle
    points, normals = shape.points[first], shape.outward_normals[first]
    near = nearest_neighbours(points, 8).indices
    if near.shape[1] < 2:
        return np.empty((0, 3), dtype=np.int64)
    one = near[:, 0]
    ways = points[near] - points[:, None, :]
    across = np.cross(ways[:, :1], ways)  # (n, 8, 3): twice the area vectors of the triangles to be chosen from
    chosen = np.linalg.norm(across, axis=2).argmax(axis=1)
    row = np.arange(len(points))
    outward = (across[row, chosen] * normals).sum(axis=1) > 0
    other = near[row, chosen]
    return np.asarray(first[np.stack([row, np.where(outward, one, other), np.where(outward, other, one)], axis=1)])


def outward_normals(shape: TriangleMesh | PointCloud) -> FloatArray:
    """(n, 3): vertex normals of a mesh, or a cloud's own, or estimated ones."""
    return shape.vertex_normals if isinstance(shape, TriangleMesh) else shape.outward_normals


def orientation_kept(shape: TriangleMesh | PointCloud, images: IntArray, weights: FloatArray) -> float:
    """Share of triangles, by `weights` (m,), whose images (m, 3), vertices of `shape`, face outward there."""
    places, normals = shape.vertices[images], outward_normals(shape)[images].sum(axis=1)
    laid = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    facing = (laid * normals).sum(axis=1)
    weight = weights * (np.abs(facing) > 1e-12 * np.linalg.norm(laid, axis=1))
    return float((weight * (facing > 0)).sum() / weight.sum()) if weight.sum() > 0 else 0.5
