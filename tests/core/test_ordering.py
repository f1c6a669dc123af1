"""Nested dissection: what may touch what, how well it cuts, and what it depends on."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from add_core.eigensolver.ordering import Dissection, known_dissection, nested_dissection
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import rectangle, sphere
from add_core.operators import SparsityPattern


def pattern_of(mesh: TriangleMesh) -> SparsityPattern:
    return SparsityPattern.of(mesh.faces, mesh.vertex_count)


def complete_graph(n: int) -> tuple[np.ndarray, np.ndarray]:
    return np.arange(n + 1) * n, np.tile(np.arange(n), n)


def two_spheres() -> TriangleMesh:
    ball = sphere(3)
    return TriangleMesh(np.vstack([ball.vertices, ball.vertices + 5]), np.vstack([ball.faces, ball.faces + 642]))


def ancestors(dissection: Dissection) -> list[set[int]]:
    above: list[set[int]] = [set() for _ in dissection.parents]
    for i in range(len(dissection.parents) - 1, -1, -1):
        parent = int(dissection.parents[i])
        if parent >= 0:
            above[i] = above[parent] | {parent}
    return above


@pytest.mark.parametrize("mesh", [sphere(4), rectangle(3.0, 1.0, n=20), two_spheres()], ids=["closed", "open", "two"])
def test_an_edge_never_joins_two_branches_of_the_tree(mesh):
    pattern = pattern_of(mesh)
    dissection = nested_dissection(pattern.indptr, pattern.indices)
    home = np.empty(mesh.vertex_count, dtype=int)
    home[dissection.permutation] = np.repeat(np.arange(len(dissection.parents)), np.diff(dissection.starts))
    above = ancestors(dissection)
    for i, j in np.unique(np.sort(home[mesh.edges], axis=1), axis=0):
        assert i == j or j in above[i], "children come before parents and touch nothing beside them"


@pytest.mark.parametrize("n", [1, 2, 3, 64, 65, 200])
def test_every_vertex_is_eliminated_once_even_where_nothing_can_be_separated(n):
    dissection = nested_dissection(*complete_graph(n))
    assert_array_equal(np.sort(dissection.permutation), np.arange(n))
    assert dissection.starts[-1] == n


def test_vertices_without_edges_are_ordered_too():
    dissection = nested_dissection(np.arange(301), np.arange(300))  # a diagonal matrix
    assert_array_equal(np.sort(dissection.permutation), np.arange(300))


def test_the_root_of_a_long_strip_is_as_short_as_the_strip_is_wide():
    mesh = rectangle(20.0, 1.0, n=8)  # 9 vertices across
    pattern = pattern_of(mesh)
    dissection = nested_dissection(pattern.indptr, pattern.indices)
    assert np.diff(dissection.starts)[-1] <= 10


def test_components_are_parted_before_anything_is_cut():
    pattern = pattern_of(two_spheres())
    dissection = nested_dissection(pattern.indptr, pattern.indices)
    assert np.diff(dissection.starts)[-1] == 0


def test_separators_of_a_sphere_grow_like_the_square_root():
    """Halving a sphere of n vertices costs about a great circle, c √n; a poor cut costs O(n)."""
    mesh = sphere(5)
    pattern = pattern_of(mesh)
    dissection = nested_dissection(pattern.indptr, pattern.indices)
    assert np.diff(dissection.starts)[-1] < 2.2 * np.sqrt(mesh.vertex_count)


def test_poses_of_one_connectivity_share_one_dissection():
    mesh = sphere(3)
    pose = TriangleMesh(mesh.vertices * [1.0, 3.0, 0.2], mesh.faces)
    first, second = pattern_of(mesh), pattern_of(pose)
    assert known_dissection(first.indptr, first.indices) is known_dissection(second.indptr, second.indices)


def test_a_dissection_survives_its_file(tmp_path):
    pattern = pattern_of(sphere(3))
    dissection = nested_dissection(pattern.indptr, pattern.indices)
    dissection.save(tmp_path)
    read = Dissection.load(tmp_path)
    for name in ("permutation", "starts", "parents"):
        assert_array_equal(getattr(read, name), getattr(dissection, name))


def test_renumbered_vertices_are_dissected_as_well_as_before():
    mesh = sphere(4)
    shuffled = np.random.default_rng(0).permutation(mesh.vertex_count)
    other = pattern_of(TriangleMesh(mesh.vertices[np.argsort(shuffled)], shuffled[mesh.faces]))
    sizes = [np.diff(nested_dissection(p.indptr, p.indices).starts)[-1] for p in (pattern_of(mesh), other)]
    assert abs(sizes[0] - sizes[1]) <= 0.2 * sizes[0]
