"""Variations of a shape: what scanners, other meshings and other bodies do to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from .._check import FloatArray, IntArray, at_least_zero, count_in, positive, read_only
from ..geometry import PointCloud, TriangleMesh, farthest_points

WAVES = 12
"""Random plane waves in one smooth deformation: enough that no direction is special."""


@dataclass(frozen=True, eq=False)
class RemeshedTwin:
    """A shape meshed anew. mesh : the twin, of n vertices, each an old vertex or the middle of an old edge.

    origin : (n,), the number of the old vertex, or that of the edge in `edges` of the old mesh plus its vertices.
    old_count : vertices of the old mesh.
    """

    mesh: TriangleMesh
    origin: IntArray
    old_count: int

    @property
    def indices(self) -> IntArray:
        """(n,): the vertex of the old mesh that each vertex is, −1 where it lies between old vertices."""
        return read_only(np.where(self.origin < self.old_count, self.origin, -1))


@dataclass(frozen=True, eq=False)
class Scatter:
    """Points taken from a mesh. cloud : of n points. origin : (n,), as for `RemeshedTwin`."""

    cloud: PointCloud
    origin: IntArray


def bend(mesh: TriangleMesh, *, amplitude: float, wavelength: float, seed: int) -> TriangleMesh:
    """The mesh in a space that waves smoothly: another body rather than another skin.

    amplitude : root mean square displacement, wavelength : shortest wave, both as shares of the bounding box's
    diagonal.
    """
    size = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    draw = np.random.default_rng(seed)
    directions = draw.normal(size=(WAVES, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    shortest = positive("wavelength", wavelength) * size
    waves = directions * (2 * np.pi / (shortest * draw.uniform(1.0, 3.0, size=(WAVES, 1))))
    phases = mesh.vertices @ waves.T + draw.uniform(0, 2 * np.pi, WAVES)
    moved = np.cos(phases) @ draw.normal(size=(WAVES, 3)) * np.sqrt(2 / (3 * WAVES))
    return _with_vertices(mesh, mesh.vertices + at_least_zero("amplitude", amplitude) * size * moved)


def roughen(mesh: TriangleMesh, *, amplitude: float, smoothing: int, seed: int) -> TriangleMesh:
    """Noise along the normals, as scanners leave it.

    amplitude : its root mean square as a share of the mean edge length. smoothing : steps of averaging over neighbours
        before it is brought to that size; 0 leaves every vertex on its own.
    """
    averaging = _averaging(mesh)
    noise = np.random.default_rng(seed).normal(size=mesh.vertex_count)
    for _ in range(count_in("smoothing", smoothing, 0, 1000)):
        noise = averaging @ noise
    noise *= at_least_zero("amplitude", amplitude) * _mean_edge(mesh) / max(float(noise.std()), 1e-300)
    return _with_vertices(mesh, mesh.vertices + noise[:, None] * mesh.vertex_normals)


def blur(mesh: TriangleMesh, *, steps: int) -> TriangleMesh:
    """Every vertex halfway to the mean of its neighbours, `steps` times, with Taubin's step back against shrinking."""
    averaging, vertices = _averaging(mesh), mesh.vertices
    for _ in range(count_in("steps", steps, 0, 1000)):
        vertices = vertices + 0.5 * (averaging @ vertices - vertices)
        vertices = vertices - 0.53 * (averaging @ vertices - vertices)
    return _with_vertices(mesh, vertices)


def remesh(mesh: TriangleMesh, count: int, *, seed: int, unevenness: float = 0.0) -> RemeshedTwin:
    """A mesh of about `count` vertices on the same surface, with a connectivity of its own.

    Vertices are farthest points among the old vertices and the middles of old edges, from a random start; faces are
    dual to their geodesic Voronoi cells. Vertices that no face uses are left out. Cells that are no discs (on parts
    thinner than the new edges) leave holes or edges of three faces, as careless meshings do.
    unevenness : about the standard deviation of the logarithm of the edges' length, which then differs from place to
        place.

    Raises ParameterError if `count` is out of range.
    """
    coarse = _subdivided(mesh)
    fine = _subdivided(coarse)
    seeds = _scattered(coarse, count, seed=seed, unevenness=unevenness)
    count = len(seeds)
    edges = fine.edges
    lengths = np.linalg.norm(fine.vertices[edges[:, 0]] - fine.vertices[edges[:, 1]], axis=1)
    graph = csr_array((lengths, (edges[:, 0], edges[:, 1])), shape=(fine.vertex_count, fine.vertex_count))
    _, _, owner = dijkstra(graph, directed=False, indices=seeds, min_only=True, return_predecessors=True)
    number = np.full(fine.vertex_count, -1)
    number[seeds] = np.arange(count)
    corners = number[owner[fine.faces]] if (owner >= 0).all() else number[np.maximum(owner, 0)[fine.faces]]
    cells = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    first = cells.argmin(axis=1)
    cells = np.unique(np.take_along_axis(cells, (first[:, None] + np.arange(3)) % 3, axis=1), axis=0)
    kept, faces = np.unique(cells, return_inverse=True)
    twin = TriangleMesh(coarse.vertices[seeds[kept]], faces.reshape(-1, 3), name=mesh.name)
    return RemeshedTwin(twin, read_only(seeds[kept]), mesh.vertex_count)


def scatter(
    mesh: TriangleMesh, count: int, *, seed: int, unevenness: float = 0.0, with_normals: bool = True
) -> Scatter:
    """A cloud of `count` points among the old vertices and the middles of old edges, as evenly as those of `remesh`.

    with_normals : with the mesh's normals at these points, unless one of them has none.
    Raises ParameterError if `count` is out of range.
    """
    coarse = _subdivided(mesh)
    chosen = _scattered(coarse, count, seed=seed, unevenness=unevenness)
    normals = coarse.vertex_normals[chosen]
    known = with_normals and bool(normals.any(axis=1).all())
    return Scatter(PointCloud(coarse.vertices[chosen], normals if known else None, mesh.name), read_only(chosen))


def _scattered(mesh: TriangleMesh, count: int, *, seed: int, unevenness: float) -> IntArray:
    """(count,): farthest points of the mesh as it would be in a space that is wider in some places than in others."""
    start = int(np.random.default_rng(seed).choice(np.flatnonzero(mesh.is_referenced)))
    count_in("count", count, 4, mesh.vertex_count)
    amplitude = 0.25 * at_least_zero("unevenness", unevenness)  # found by trial on people
    warped = bend(mesh, amplitude=amplitude, wavelength=0.2, seed=seed)
    return farthest_points(warped, count, start=start)


def _subdivided(mesh: TriangleMesh) -> TriangleMesh:
    """Every face split into four at the middles of its edges; old vertices keep their numbers."""
    edges, n = mesh.edges, mesh.vertex_count
    order = np.sort(mesh.faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    key = edges.min(axis=1) * n + edges.max(axis=1)
    sorting = np.argsort(key)
    ab, bc, ca = n + sorting[np.searchsorted(key[sorting], order[..., 0] * n + order[..., 1])].T
    a, b, c = mesh.faces.T
    faces = np.stack([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]).transpose(0, 2, 1).reshape(-1, 3)
    middles = 0.5 * (mesh.vertices[edges[:, 0]] + mesh.vertices[edges[:, 1]])
    return TriangleMesh(np.concatenate([mesh.vertices, middles]), faces, name=mesh.name)


def _averaging(mesh: TriangleMesh) -> csr_array:
    i, j = mesh.edges.T
    ones = np.ones(2 * len(i))
    n = mesh.vertex_count
    adjacency = csr_array((ones, (np.concatenate([i, j]), np.concatenate([j, i]))), shape=(n, n))
    count = np.maximum(adjacency.sum(axis=1), 1.0)
    alone = csr_array((1.0 * (adjacency.sum(axis=1) == 0), (np.arange(n), np.arange(n))), shape=(n, n))
    return csr_array(adjacency.multiply(1 / count[:, None])) + alone


def _mean_edge(mesh: TriangleMesh) -> float:
    i, j = mesh.edges.T
    return float(np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1).mean())


def _with_vertices(mesh: TriangleMesh, vertices: FloatArray) -> TriangleMesh:
    return TriangleMesh(vertices, mesh.faces, name=mesh.name)
