"""Triangle meshes: the shape and what follows from it alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from .._check import BoolArray, FloatArray, IntArray, faces_array, positions_array, read_only
from .distinct import sorted_distinct

FLAT_FACE = 1e-14
"""A face whose area is below this share of its longest edge squared has no usable normal: rounding made it. So it has
where its height is below the rounding of the coordinates."""


@dataclass(frozen=True, eq=False)
class InnerEdges:
    """Edges between two faces that run along them in opposite senses, as on an oriented manifold.

    vertices : (e, 2), in the sense in which the left face runs along the edge, smaller number first.
    faces : (e, 2), the left and the right face.
    """

    vertices: IntArray
    faces: IntArray


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """A surface made of triangles, in the shape's own length unit.

    vertices : (n, 3) float64, kept in the order given.
    faces : (m, 3) int64, 0-based, counter-clockwise when seen from outside.
    name : what to call the shape in messages and windows.

    Arrays are copied and read-only. Defects that have an honest answer (unreferenced vertices, faces without area,
    several components, boundaries) are kept as they are; `add_core.geometry.inspect` reports them.

    Raises GeometryError if an array has the wrong shape, a vertex is not finite or a face points to no vertex.
    """

    vertices: FloatArray
    faces: IntArray
    name: str = ""

    def __init__(self, vertices: ArrayLike, faces: ArrayLike, name: str = "") -> None:
        checked = positions_array("vertices", vertices, least=3)
        object.__setattr__(self, "vertices", checked)
        object.__setattr__(self, "faces", faces_array(faces, len(checked)))
        object.__setattr__(self, "name", str(name))

    def __repr__(self) -> str:
        return f"TriangleMesh({self.name!r}, {self.vertex_count} vertices, {len(self.faces)} faces)"

    @property
    def vertex_count(self) -> int:
        return len(self.vertices)

    @cached_property
    def opposite_edges(self) -> FloatArray:
        """(m, 3, 3): the edge opposite to each corner, as a vector that runs counter-clockwise around its face."""
        corners = self.vertices[self.faces]
        return read_only(corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]])

    @cached_property
    def _area_vectors(self) -> FloatArray:
        edges = self.opposite_edges
        return read_only(0.5 * np.cross(edges[:, 0], edges[:, 1]))  # (m, 3), length = area

    @cached_property
    def face_areas(self) -> FloatArray:
        """(m,), unit length²."""
        return read_only(np.linalg.norm(self._area_vectors, axis=1))

    @cached_property
    def has_area(self) -> BoolArray:
        """(m,): False for faces so thin that their normal is rounding noise."""
        longest = (self.opposite_edges**2).sum(axis=2).max(axis=1)
        rounding = 4.0 * np.finfo(np.float64).eps * np.abs(self.vertices).max() * np.sqrt(longest)
        return read_only(self.face_areas > np.maximum(FLAT_FACE * longest, rounding))

    @cached_property
    def face_normals(self) -> FloatArray:
        """(m, 3), unit, outward for counter-clockwise faces; zero where a face has no area."""
        length = np.where(self.has_area, self.face_areas, np.inf)
        return read_only(self._area_vectors / length[:, None])

    @cached_property
    def vertex_areas(self) -> FloatArray:
        """(n,), unit length²: a third of each adjacent face; 0 for unreferenced vertices. The lumped mass S."""
        share = np.repeat(np.where(self.has_area, self.face_areas, 0.0) / 3.0, 3)
        return read_only(np.bincount(self.faces.ravel(), share, self.vertex_count).astype(np.float64))

    @cached_property
    def has_mass(self) -> BoolArray:
        """(n,): whether a vertex stands for any area. Only these take part in spectra."""
        return read_only(self.vertex_areas > 0)

    @cached_property
    def vertex_normals(self) -> FloatArray:
        """(n, 3), unit, area-weighted mean of the adjacent faces' normals; zero where there is none."""
        total = np.zeros((self.vertex_count, 3))
        np.add.at(total, self.faces.ravel(), np.repeat(self._area_vectors, 3, axis=0))
        length = np.linalg.norm(total, axis=1, keepdims=True)
        return read_only(np.divide(total, length, out=np.zeros_like(total), where=length > 0))

    @cached_property
    def area(self) -> float:
        """Total area, unit length²."""
        return float(self.face_areas.sum())

    @cached_property
    def edges(self) -> IntArray:
        """(e, 2): every edge once, its smaller vertex first, in lexicographic order."""
        return read_only(np.stack(np.divmod(self._edge_keys[0], self.vertex_count), axis=1))

    @cached_property
    def edge_face_counts(self) -> IntArray:
        """(e,): faces that share each of `edges`: 1 on a boundary, 2 inside, more where the mesh is no manifold."""
        return read_only(self._edge_keys[1])

    @cached_property
    def _edge_keys(self) -> tuple[IntArray, IntArray]:
        low, high = np.sort(_half_edges(self.faces), axis=1).T
        keys, counts = np.unique(low * self.vertex_count + high, return_counts=True)
        return keys, counts.astype(np.int64)

    @cached_property
    def boundary_edges(self) -> IntArray:
        """(b, 2): edges with one face only."""
        return read_only(self.edges[self.edge_face_counts == 1])

    @cached_property
    def inner_edges(self) -> InnerEdges:
        """Edges with exactly two faces of one orientation, both with area; the others have no angle."""
        usable = np.flatnonzero(self.has_area)
        half = _half_edges(self.faces[usable])
        face = np.repeat(usable, 3)
        n = self.vertex_count
        keys, index, counts = np.unique(half @ [n, 1], return_index=True, return_counts=True)
        keys, index = keys[counts == 1], index[counts == 1]  # one sense, two faces: not an oriented manifold's edge
        ascending = index[half[index, 0] < half[index, 1]]
        reverse = half[ascending] @ [1, n]
        position = np.minimum(np.searchsorted(keys, reverse), max(len(keys) - 1, 0))
        paired = keys[position] == reverse if len(keys) else np.zeros(0, dtype=bool)
        left, right = ascending[paired], index[position[paired]]
        return InnerEdges(read_only(half[left]), read_only(np.stack([face[left], face[right]], axis=1)))

    @cached_property
    def component_labels(self) -> IntArray:
        """(n,): the connected component of each vertex, numbered by first vertex; unreferenced ones stand alone."""
        i, j = self.edges.T
        n = self.vertex_count
        graph = csr_array((np.ones(len(i), dtype=np.int8), (i, j)), shape=(n, n))
        return read_only(connected_components(graph, directed=False)[1].astype(np.int64))

    @cached_property
    def is_referenced(self) -> BoolArray:
        """(n,): False for vertices that no face uses."""
        used = np.zeros(self.vertex_count, dtype=bool)
        used[self.faces.ravel()] = True
        return read_only(used)

    @cached_property
    def is_oriented(self) -> bool:
        """Whether no two faces with area run along an edge in the same sense, as on an oriented manifold."""
        keys = _half_edges(self.faces[self.has_area]) @ np.array([self.vertex_count, 1])
        return len(sorted_distinct(keys)) == len(keys)


def _half_edges(faces: IntArray) -> IntArray:
    """(3m, 2): the three sides of every face in its own sense, face by face."""
    return faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
