"""The mirror map is followed from triangle to triangle: exact where the pose is not, absent where there is none."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from add_core.geometry import TriangleMesh, mirror_map
from add_core.geometry.shapes import rectangle, sphere
from add_core.io import dogs, humans, open_collection, save_shape


@pytest.mark.parametrize("collection", [humans, dogs])
def test_the_known_map_is_found_from_a_neutral_pose_turned_anyhow(collection):
    turn, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    mesh = collection()[0]
    turned = TriangleMesh(mesh.vertices @ turn.T + 7.0, mesh.faces if np.linalg.det(turn) > 0 else mesh.faces[:, ::-1])
    assert_array_equal(mirror_map(turned), collection().symmetry)


def test_a_pose_that_is_not_quite_symmetric_gives_the_exact_map():
    mesh = humans()[0]
    noise = 0.002 * np.random.default_rng(1).normal(size=mesh.vertices.shape)
    assert_array_equal(mirror_map(TriangleMesh(mesh.vertices + noise, mesh.faces)), humans().symmetry)


def test_triangles_without_symmetry_have_no_map():
    mesh = rectangle(2.0, 1.0, n=3)
    assert mirror_map(TriangleMesh(mesh.vertices, mesh.faces[:-1])) is None


def test_pieces_are_exchanged_and_loose_vertices_stay():
    ball = sphere(1)
    potato = ball.vertices + 0.1 * np.random.default_rng(2).normal(size=ball.vertices.shape) + np.array([3, 0, 0])
    n = ball.vertex_count
    vertices = np.concatenate([potato, potato * np.array([-1, 1, 1]), np.zeros((1, 3))])
    pair = TriangleMesh(vertices, np.concatenate([ball.faces, ball.faces[:, ::-1] + n]))
    assert_array_equal(mirror_map(pair), [*range(n, 2 * n), *range(n), 2 * n])


def test_a_collection_finds_its_map_from_a_neutral_shape(tmp_path):
    for number in range(2):
        save_shape(dogs()[number], tmp_path / f"dog{number}.ply")
    assert open_collection(tmp_path).symmetry is None
    assert_array_equal(open_collection(tmp_path, neutral=0).symmetry, dogs().symmetry)


def test_a_mesh_without_area_has_a_mirror_map_or_none_but_no_warning():
    line = TriangleMesh(np.outer(np.arange(5.0), [1, 2, 3]), [[0, 1, 2], [2, 3, 4]])
    found = mirror_map(line)
    assert found is None or (found[found] == np.arange(5)).all()
