"""Variations keep what they promise: places, size, orientation, and nothing else."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ParameterError
from add_core.geometry.shapes import ellipsoid, sphere
from add_core.learning import TrainingShape
from add_core.learning.augmentation import bend, blur, remesh, roughen, scatter
from add_core.learning.middles import Middles
from add_core.learning.variations import vary


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


def test_vertices_between_old_ones_are_the_middles_of_the_edges_they_name(ball):
    twin = remesh(ball, 400, seed=0)
    between = twin.origin >= ball.vertex_count
    middles = ball.vertices[ball.edges[twin.origin[between] - ball.vertex_count]].mean(axis=1)
    assert_allclose(twin.mesh.vertices[between], middles, atol=1e-15)


def test_unevenness_makes_edges_of_different_lengths_and_changes_no_surface(ball):
    spread = []
    for unevenness in (0.0, 0.8):
        mesh = remesh(ball, 400, seed=1, unevenness=unevenness).mesh
        spread.append(np.log(np.linalg.norm(np.diff(mesh.vertices[mesh.edges], axis=1), axis=2)).std())
        assert_allclose(mesh.area, 4 * np.pi, rtol=0.05)
    assert spread[1] > 1.3 * spread[0]


@pytest.mark.parametrize("with_normals", [True, False])
def test_a_scattered_cloud_lies_on_the_surface_with_normals_if_wanted(ball, with_normals):
    part = scatter(ball, 300, seed=2, with_normals=with_normals)
    assert part.cloud.vertex_count == 300
    old = part.origin < ball.vertex_count
    assert_array_equal(part.cloud.points[old], ball.vertices[part.origin[old]])
    assert (part.cloud.normals is not None) == with_normals
    assert ((part.cloud.outward_normals * part.cloud.points).sum(axis=1) > 0.9).all()


def test_middles_of_edges_are_places_with_mirror_images():
    mesh = ellipsoid(1.0, 0.8, 0.6, subdivisions=1)
    symmetry = np.array([np.abs(mesh.vertices * [1, -1, 1] - v).sum(axis=1).argmin() for v in mesh.vertices])
    middles = Middles.of(mesh, symmetry)
    points = np.concatenate([mesh.vertices, mesh.vertices[mesh.edges].mean(axis=1)])
    assert_array_equal(middles.places, np.arange(len(mesh.vertices), len(points)))
    assert_allclose(points[middles.symmetry], points * [1, -1, 1], atol=1e-12)


def test_variations_put_every_place_where_it_belongs(ball):
    """However a body is varied, its places are still near where they were: at most the bend and the noise away."""
    item, middles = TrainingShape(ball, np.arange(ball.vertex_count)), Middles.of(ball)
    where = np.concatenate([ball.vertices, ball.vertices[ball.edges].mean(axis=1)])
    kinds = set()
    for seed in range(8):
        varied = vary(item, seed=seed, middles=middles.places)
        kinds.add((type(varied.shape).__name__, varied.shape.vertex_count == ball.vertex_count))
        assert (varied.places >= 0).all()
        assert np.linalg.norm(varied.shape.vertices - where[varied.places], axis=1).max() < 0.3
    assert kinds == {("TriangleMesh", True), ("TriangleMesh", False), ("PointCloud", False)}
    assert (vary(item, seed=twin_seed(item)).places < 0).any()


def twin_seed(item):
    return next(s for s in range(20) if vary(item, seed=s).shape.vertex_count != item.shape.vertex_count)


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
