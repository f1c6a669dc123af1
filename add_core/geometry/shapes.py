"""Shapes with closed-form truths: what every operator is tested against, and quick shapes to try things on."""

from __future__ import annotations

import numpy as np

from .._check import FloatArray, IntArray, count_in
from .mesh import TriangleMesh


def sphere(subdivisions: int = 4, *, radius: float = 1.0) -> TriangleMesh:
    """Icosphere with 10·4^s + 2 vertices, normals outward. Laplacian eigenvalues: l(l+1)/r², each 2l+1 times."""
    ball = TriangleMesh(*_icosahedron())
    for _ in range(count_in("subdivisions", subdivisions, 0, 9)):
        ball = split_in_four(ball)
        ball = TriangleMesh(ball.vertices / np.linalg.norm(ball.vertices, axis=1, keepdims=True), ball.faces)
    return TriangleMesh(radius * ball.vertices, ball.faces, "sphere")


def ellipsoid(a: float = 1.0, b: float = 0.8, c: float = 0.6, *, subdivisions: int = 4) -> TriangleMesh:
    """Icosphere stretched to half axes a, b, c along x, y, z."""
    ball = sphere(subdivisions)
    return TriangleMesh(ball.vertices * [a, b, c], ball.faces, "ellipsoid")


def cylinder(*, radius: float = 1.0, height: float = 2.0, around: int = 48, along: int = 24) -> TriangleMesh:
    """Open cylinder about z, normals outward: curvature 1/r around (maximum), 0 along z (minimum)."""
    angle = 2 * np.pi * np.arange(around) / around
    z = np.linspace(-height / 2, height / 2, along + 1)
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    vertices = np.stack([np.tile(x, along + 1), np.tile(y, along + 1), np.repeat(z, around)], axis=1)
    return TriangleMesh(vertices, _grid_faces(along + 1, around, wrap_rows=False, wrap_columns=True), "cylinder")


def torus(*, major: float = 1.0, minor: float = 0.4, around: int = 64, through: int = 32) -> TriangleMesh:
    """Torus about z, normals outward: curvature 1/r through the tube (max), cos φ/(R + r cos φ) around it (min)."""
    u = 2 * np.pi * np.arange(around) / around
    v = 2 * np.pi * np.arange(through) / through
    ring = major + minor * np.cos(v)[None, :]
    x, y = ring * np.cos(u)[:, None], ring * np.sin(u)[:, None]
    z = np.broadcast_to(minor * np.sin(v), x.shape)
    vertices = np.stack([x, y, z], axis=2).reshape(-1, 3)
    faces = _grid_faces(around, through, wrap_rows=True, wrap_columns=True)[:, [0, 2, 1]]
    return TriangleMesh(vertices, faces, "torus")


def rectangle(width: float = 1.0, height: float = 1.0, *, n: int = 16) -> TriangleMesh:
    """Flat width × height rectangle in the xy plane, normal +z, n + 1 vertices along its shorter side, squares
    split alternately.

    Laplacian eigenvalues with free boundary: π²(i²/w² + j²/h²), i, j ≥ 0.
    """
    short = min(width, height) / n
    columns, rows = round(width / short) + 1, round(height / short) + 1
    x, y = np.meshgrid(np.linspace(0, width, columns), np.linspace(0, height, rows))
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    return TriangleMesh(vertices, _grid_faces(rows, columns, wrap_rows=False, wrap_columns=False), "rectangle")


def split_in_four(mesh: TriangleMesh) -> TriangleMesh:
    """The same surface with every face split at its edges' midpoints; the old vertices keep their numbers."""
    edges, inverse = np.unique(
        np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0, return_inverse=True
    )
    ab, bc, ca = (mesh.vertex_count + inverse.reshape(-1, 3)).T
    a, b, c = mesh.faces.T
    corners = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    vertices = np.concatenate([mesh.vertices, mesh.vertices[edges].mean(axis=1)])
    return TriangleMesh(vertices, np.concatenate([np.stack(f, axis=1) for f in corners]), mesh.name)


def _icosahedron() -> tuple[FloatArray, IntArray]:
    g = (1 + np.sqrt(5)) / 2
    vertices = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g)]
    vertices += [(0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6)]
    faces += [(7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10)]
    faces += [(8, 6, 7), (9, 8, 1)]
    return np.array(vertices) / np.sqrt(1 + g * g), np.array(faces)


def _grid_faces(rows: int, columns: int, *, wrap_rows: bool, wrap_columns: bool) -> IntArray:
    """Counter-clockwise triangles of a grid of rows × columns vertices whose columns run along x and rows along y."""
    r, c = np.meshgrid(
        np.arange(rows if wrap_rows else rows - 1), np.arange(columns if wrap_columns else columns - 1), indexing="ij"
    )
    row, column = r.ravel(), c.ravel()
    above, right = (row + 1) % rows, (column + 1) % columns
    a, b = row * columns + column, row * columns + right
    d, e = above * columns + right, above * columns + column
    # Alternating diagonals: a grid of equal diagonals prefers one direction, and its spectrum shows it.
    even = ((row + column) % 2 == 0)[:, None]
    first = np.where(even, np.stack([a, b, d], 1), np.stack([a, b, e], 1))
    second = np.where(even, np.stack([a, d, e], 1), np.stack([b, d, e], 1))
    return np.concatenate([first, second]).astype(np.int64)


def even_directions(count: int) -> FloatArray:
    """(count, 3) unit vectors spread evenly over the sphere, along a spiral of golden angles."""
    height = 1 - (2 * np.arange(count) + 1) / count
    turn = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    radius = np.sqrt(1 - height**2)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=1)
