"""The connected pieces of a mesh, each cleaned into a surface on which lengths can be measured."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from .._check import BoolArray, FloatArray, IntArray
from .distinct import sorted_distinct
from .mesh import TriangleMesh
from .pair_distances import edges_and_crossings


@dataclass(frozen=True, eq=False)
class SurfacePiece:
    """One connected piece of a mesh: its vertices, those at one place joined by an edge without length made one node.

    positions : (p, 3), of the nodes, moved and scaled into the unit cube so that units of 1e-6 and 1e6 measure alike.
    faces : (q, 3), nodes of every face once; faces that collapsed into an edge or a point are dropped.
    node_of : (n,), node of each vertex of the mesh; −1 for vertices of other pieces.
    members : the mesh's vertices that belong to this piece, ascending.
    unit : length of the unit cube's side in the mesh's own unit.
    """

    positions: FloatArray
    faces: IntArray
    node_of: IntArray
    members: IntArray
    unit: float

    @property
    def is_manifold(self) -> bool:
        """Whether at most two faces share each edge, and the faces around each node hang together by edges."""
        sides = _sorted_sides(self.faces)
        _, edge, counts = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
        # The corners at one node are joined across the edges with two faces that meet there. There are as many
        # groups of corners as nodes, unless an edge has more than two faces (it joins nothing) or a node alone
        # joins two sheets.
        corner = np.arange(self.faces.size).reshape(-1, 3)[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2)  # of the sides' ends
        corner = np.take_along_axis(corner, np.argsort(_sides(self.faces), axis=1), axis=1)
        order = np.argsort(edge.ravel(), kind="stable")
        shared = counts[edge.ravel()[order]] == 2
        pairs = corner[order[shared]].reshape(-1, 2, 2).transpose(0, 2, 1).reshape(-1, 2)
        return int(_labels(pairs, self.faces.size).max()) + 1 == len(self.positions)

    @cached_property
    def path_lengths(self) -> csr_array:
        """(p, p): lengths of edges and of the straight ways across them, in the mesh's own unit; symmetric."""
        return edges_and_crossings(TriangleMesh(self.positions, self.faces)) * self.unit


def surface_pieces(mesh: TriangleMesh) -> Iterator[SurfacePiece]:
    """The pieces of `mesh` that have any extent, ordered by first vertex; unreferenced vertices belong to none."""
    welded = _weld_edges_without_length(mesh)
    faces = welded[mesh.faces]
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
    if len(faces) == 0:
        return
    _, once = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    faces = faces[np.sort(once)]
    labels = _labels(_sorted_sides(faces), mesh.vertex_count)
    for label in np.unique(labels[faces[:, 0]]):
        yield _piece(mesh, faces[labels[faces[:, 0]] == label], welded, labels == label)


def _piece(mesh: TriangleMesh, faces: IntArray, welded: IntArray, has_label: BoolArray) -> SurfacePiece:
    node_of = np.full(mesh.vertex_count, -1, dtype=np.int64)
    representatives = sorted_distinct(faces)
    node_of[representatives] = np.arange(len(representatives))
    members = np.flatnonzero(has_label[welded] & (node_of[welded] >= 0))
    nodes = node_of[faces]
    node_of[members] = node_of[welded[members]]
    corner = mesh.vertices[representatives].min(axis=0)
    unit = float((mesh.vertices[representatives] - corner).max())
    return SurfacePiece((mesh.vertices[representatives] - corner) / unit, nodes, node_of, members, unit)


def _weld_edges_without_length(mesh: TriangleMesh) -> IntArray:
    """(n,): the first vertex that each vertex coincides with along edges of no length; itself if there is none."""
    i, j = mesh.edges.T
    same = (mesh.vertices[i] == mesh.vertices[j]).all(axis=1)
    labels = _labels(mesh.edges[same], mesh.vertex_count)
    _, first = np.unique(labels, return_index=True)
    return np.asarray(first[labels], dtype=np.int64)


def _labels(pairs: IntArray, count: int) -> IntArray:
    graph = csr_array((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _sides(faces: IntArray) -> IntArray:
    return faces[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2)


def _sorted_sides(faces: IntArray) -> IntArray:
    return np.asarray(np.sort(_sides(faces), axis=1))
