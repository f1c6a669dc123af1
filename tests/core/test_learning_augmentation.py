"""Variations keep what they promise: places, size, orientation, and nothing else."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ParameterError
from add_core.geometry.shapes import ellipsoid, sphere
from add_core.learning.augmentation import bend, blur, remesh, roughen


@pytest.fixture(scope="module")
def ball():
    return sphere(3)


def test_a_twin_lies_on_the_surface_with_a_connectivity_of_its_own(ball):
    twin = remesh(ball, 300, seed=3)
    mesh = twin.mesh
    assert mesh.vertex_count == 300
    assert (mesh.edge_face_counts == 2).all()
    assert mesh.vertex_count - len(mesh.edges) + len(mesh.faces) == 2
    assert_allclose(mesh.area, 4 * np.pi, rtol=0.05)
    assert ((mesh.face_normals * mesh.vertices[mesh.faces].mean(axis=1)).sum(axis=1) > 0).all()


def test_a_twin_knows_which_old_vertices_it_kept(ball):
    twin = remesh(ball, 400, seed=0)
    kept = twin.indices >= 0
    assert 20 < kept.sum() < 400
    assert_array_equal(twin.mesh.vertices[kept], ball.vertices[twin.indices[kept]])


def test_another_seed_is_another_meshing(ball):
    one, same, other = (remesh(ball, 200, seed=seed).mesh for seed in (1, 1, 2))
    assert_array_equal(one.faces, same.faces)
    assert not np.array_equal(one.vertices, other.vertices)


def test_roughness_has_the_size_asked_for_and_runs_along_normals():
    mesh = ellipsoid(1.0, 0.8, 0.6, subdivisions=4)
    edge = np.linalg.norm(np.diff(mesh.vertices[mesh.edges], axis=1), axis=2).mean()
    step = roughen(mesh, amplitude=0.1, smoothing=2, seed=0).vertices - mesh.vertices
    assert_allclose(np.sqrt((step**2).sum(axis=1).mean()), 0.1 * edge, rtol=0.05)
    assert_allclose(np.cross(step, mesh.vertex_normals), 0, atol=1e-12)


def test_bending_has_the_size_asked_for_and_is_smooth(ball):
    size = np.linalg.norm(np.ptp(ball.vertices, axis=0))
    sizes = []
    for seed in range(20):
        step = bend(ball, amplitude=0.01, wavelength=0.5, seed=seed).vertices - ball.vertices
        sizes.append((step**2).sum(axis=1).mean() / size**2)
        difference = np.linalg.norm(np.diff(step[ball.edges], axis=1), axis=2).max()
        assert difference < 0.5 * np.linalg.norm(step, axis=1).max()
    assert_allclose(np.sqrt(np.mean(sizes)), 0.01, rtol=0.25)


def test_blurring_takes_noise_away_and_keeps_the_size(ball):
    rough = roughen(ball, amplitude=0.2, smoothing=0, seed=0)
    smooth = blur(rough, steps=5)
    before, after = (np.linalg.norm(mesh.vertices, axis=1) for mesh in (rough, smooth))
    assert after.std() < 0.5 * before.std()
    assert_allclose(after.mean(), before.mean(), rtol=0.01)


def test_counts_out_of_range_are_explained(ball):
    with pytest.raises(ParameterError, match="count must be from 4"):
        remesh(ball, 3, seed=0)
