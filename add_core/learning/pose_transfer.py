"""Poses carried from body to body, as Sumner and Popović 2004 do: what each triangle went through is done again."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu
from scipy.spatial.transform import Rotation

from .._check import FloatArray
from ..errors import ParameterError
from ..geometry import TriangleMesh

FARTHEST = 2.6
"""Radians between two poses of a triangle up to which a turn halfway between them is trusted: at π it has no side."""


def deformation(rest: TriangleMesh, posed: TriangleMesh) -> FloatArray:
    """What takes each triangle and its normal from `rest` to `posed`: gradients, shape (f, 3, 3).

    Raises ParameterError if the faces differ.
    """
    if not np.array_equal(rest.faces, posed.faces):
        raise ParameterError("rest and posed must share their faces, but they differ.")
    gradients: FloatArray = _frames(posed) @ np.linalg.inv(_frames(rest))
    return gradients


def between(first: FloatArray, second: FloatArray, share: float) -> FloatArray:
    """Gradients on the way from `first` (share 0) to `second` (1); `first` where a triangle turns too far to tell."""
    (turn, stretch), (other_turn, other_stretch) = _polar(first), _polar(second)
    on_the_way = (turn.inv() * other_turn).as_rotvec()
    if np.linalg.norm(on_the_way, axis=1).max() > FARTHEST:
        return first
    mixed = (turn * Rotation.from_rotvec(share * on_the_way)).as_matrix()
    gradients: FloatArray = mixed @ ((1 - share) * stretch + share * other_stretch)
    return gradients


def deform(mesh: TriangleMesh, gradients: FloatArray) -> TriangleMesh:
    """The mesh whose triangles come nearest, in the sense of Dirichlet's energy, to having these gradients.

    The centre of its vertices stays. The mesh must be in one piece.
    """
    corners = mesh.vertices[mesh.faces]
    start, end = corners[:, [1, 2, 0]], corners[:, [2, 0, 1]]
    edges = end - start
    sides = np.roll(edges, 1, axis=1), np.roll(edges, -1, axis=1)  # the two others that meet opposite to each edge
    doubled = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    weights = -0.5 * np.einsum("fij,fij->fi", *sides) / doubled[:, None]
    rows = np.arange(edges.size // 3)
    ones = np.ones(len(rows))
    i, j = mesh.faces[:, [1, 2, 0]].ravel(), mesh.faces[:, [2, 0, 1]].ravel()
    ends = np.tile(rows, 2), np.concatenate([j, i])
    difference = csc_array((np.concatenate([ones, -ones]), ends), shape=(len(rows), mesh.vertex_count))
    weighted = csc_array(difference.multiply(weights.reshape(-1, 1))).T
    wanted = np.einsum("fab,fib->fia", gradients, edges).reshape(-1, 3)
    stiffness, load = csc_array(weighted @ difference), weighted @ wanted
    moved = np.zeros_like(mesh.vertices)
    moved[1:] = splu(stiffness[1:, 1:]).solve(load[1:])
    return TriangleMesh(moved - moved.mean(axis=0) + mesh.vertices.mean(axis=0), mesh.faces, name=mesh.name)


def _frames(mesh: TriangleMesh) -> FloatArray:
    """(f, 3, 3): two edges and the unit normal of each triangle as columns."""
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    return np.stack([b - a, c - a, normal / np.linalg.norm(normal, axis=1, keepdims=True)], axis=2)


def _polar(gradients: FloatArray) -> tuple[Rotation, FloatArray]:
    """Turns and symmetric stretches: gradients = turn @ stretch."""
    u, s, vt = np.linalg.svd(gradients)
    sign = np.sign(np.linalg.det(u @ vt))
    s[:, 2] *= sign
    u[:, :, 2] *= sign[:, None]
    return Rotation.from_matrix(u @ vt), vt.transpose(0, 2, 1) @ (s[:, :, None] * vt)
