"""Curvature tensors of meshes, after Cohen-Steiner and Morvan (2003)."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from .._check import FloatArray, IntArray
from .mesh import TriangleMesh

SMOOTHING_ROUNDS = 2
AT_BOUNDARY = 1e-3
"""Weight of faces that lack the bend of an edge, so that whole faces decide where there are any."""


def face_curvature_tensors(mesh: TriangleMesh, *, rounds: int = SMOOTHING_ROUNDS) -> FloatArray:
    r"""Curvature tensor on every face: at the vertices first, averaged over their neighbourhoods, then over each
    face's corners.

    :math:`T(B) = \frac{1}{|B|}\sum_{e} \beta(e)\,|e \cap B|\;\bar e \bar e^\top` with β the signed angle between
    the two faces of the edge e and ē its unit direction. B is the faces around a vertex (an edge's length is shared
    by its two faces), then `rounds` times the mean over faces' corners and back. Dividing by the area makes it a
    curvature, in 1/length. *Tensors* are averaged, never direction vectors: those would cancel where they happen to
    point opposite ways.

    Returns (m, 3, 3), symmetric. An edge bends *across* itself, so the eigenvector of the largest |eigenvalue| is
    the direction of MINIMUM curvature. Positive where the surface is convex (bends away from its normal).
    Edges with one face, with more than two, or between faces of opposite orientation have no angle and add nothing;
    the faces beside them take their curvature from whole faces nearby.
    """
    density = _over(_face_measures(mesh), mesh.face_areas)
    means, share = vertex_means(mesh.faces, mesh.vertex_count, density, _face_weights(mesh), rounds=rounds)
    return np.asarray(np.einsum("fc,fcij->fij", share, means[mesh.faces]))


def vertex_means(
    triangles: IntArray, count: int, density: FloatArray, weight: FloatArray, *, rounds: int
) -> tuple[FloatArray, FloatArray]:
    """Means at the vertices (count, 3, 3) of `density` (t, 9) on the triangles around them, by `weight` (t,), smoothed:
    `rounds` times the mean over triangles' corners and back. And the corners' shares of a triangle, (t, 3)."""
    columns = np.repeat(np.arange(len(triangles)), 3)
    around = csr_array((np.ones(triangles.size), (triangles.ravel(), columns)), shape=(count, len(triangles)))
    total = np.asarray(around @ weight)
    share = _over(total[triangles], total[triangles].sum(axis=1))
    means = _over(np.asarray(around @ (weight[:, None] * density)), total)
    for _ in range(rounds):
        density = np.einsum("tc,tci->ti", share, means[triangles])
        means = _over(np.asarray(around @ (weight[:, None] * density)), total)
    return means.reshape(-1, 3, 3), share


def dihedral_angles(mesh: TriangleMesh) -> FloatArray:
    """Signed angles (e,) between the faces at `mesh.inner_edges`, in radians; positive where convex."""
    hinge = mesh.inner_edges
    left, right = mesh.face_normals[hinge.faces[:, 0]], mesh.face_normals[hinge.faces[:, 1]]
    direction = _unit(mesh.vertices[hinge.vertices[:, 1]] - mesh.vertices[hinge.vertices[:, 0]])
    sine = np.einsum("ei,ei->e", direction, np.cross(left, right))
    return np.asarray(np.arctan2(sine, np.einsum("ei,ei->e", left, right)))


def _face_measures(mesh: TriangleMesh) -> FloatArray:
    """(m, 9): ½ Σ β |e| ē ēᵀ over each face's edges: its half of what bends there, not yet divided by area."""
    hinge = mesh.inner_edges
    vector = mesh.vertices[hinge.vertices[:, 1]] - mesh.vertices[hinge.vertices[:, 0]]
    half = np.einsum("e,ei,ej->eij", dihedral_angles(mesh) / 2, vector, _unit(vector)).reshape(-1, 9)
    columns = np.repeat(np.arange(len(half)), 2)
    sides = csr_array((np.ones(len(columns)), (hinge.faces.ravel(), columns)), shape=(len(mesh.faces), len(half)))
    return np.asarray(sides @ half)


def _face_weights(mesh: TriangleMesh) -> FloatArray:
    inner = np.bincount(mesh.inner_edges.faces.ravel(), minlength=len(mesh.faces))
    area = np.where(mesh.has_area, mesh.face_areas, 0.0)
    return np.asarray(np.where(inner == 3, area, AT_BOUNDARY * area))


def _over(total: FloatArray, area: FloatArray) -> FloatArray:
    return np.asarray(np.divide(total, area[:, None], out=np.zeros_like(total), where=area[:, None] > 0))


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), np.finfo(float).tiny))
