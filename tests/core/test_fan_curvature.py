"""The triangles of a cloud's fans bend as the surface does, and conduct as the faces of a mesh do."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.geometry import PointCloud, principal_curvatures, subsample
from add_core.geometry.curvature import face_curvature_tensors
from add_core.geometry.fan_curvature import fan_curvature_tensors, trust_in_fans
from add_core.geometry.frames import TRUSTED
from add_core.geometry.shapes import ellipsoid, rectangle, sphere, torus
from add_core.io import humans
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import compute_spectrum


@pytest.mark.parametrize("mesh", [ellipsoid(subdivisions=3), torus(), humans()[0]], ids=["ellipsoid", "torus", "human"])
def test_fans_that_are_a_mesh_bend_as_it_does(mesh):
    fans = np.concatenate([np.roll(mesh.faces, -turn, axis=1) for turn in range(3)])
    found = fan_curvature_tensors(mesh.vertices, fans, np.full(len(fans), 1 / 3), rounds=0)
    area = np.bincount(mesh.faces.ravel(), np.repeat(mesh.face_areas, 3), mesh.vertex_count)
    share = area[mesh.faces] / area[mesh.faces].sum(axis=1, keepdims=True)
    wanted = face_curvature_tensors(mesh, rounds=0)
    assert_allclose(np.einsum("tc,tcij->tij", share, found[mesh.faces]), wanted, atol=1e-9 * np.abs(wanted).max())


def test_evenly_spread_points_are_trusted_and_scattered_ones_are_not():
    random = np.random.default_rng(0).normal(size=(3000, 3))
    random /= np.linalg.norm(random, axis=1, keepdims=True)
    scattered, spread = PointCloud(random, random), subsample(humans()[0], 4000).cloud
    assert trust_in_fans(scattered.points, scattered.fans.triangles).mean() < 0.15
    assert trust_in_fans(spread.points, spread.fans.triangles).mean() > 0.7


@pytest.mark.parametrize(("given", "worst"), [(True, 0.1), (False, 0.21)])
def test_fans_of_scattered_points_bend_as_the_cylinder_does(given, worst):
    """On a mesh of such points an arm would bend along itself as well, by the noise of its triangles; estimated normals
    have noise too, which a round of smoothing evens out."""
    random = np.random.default_rng(0)
    angle, z = random.uniform(0, 2 * np.pi, 3000), random.uniform(-1, 1, 3000)
    around = np.stack([np.cos(angle), np.sin(angle), 0 * z], axis=1)
    cloud = PointCloud(0.5 * around + z[:, None] * [0.0, 0.0, 1.0], around if given else None)
    frames = principal_curvatures(cloud).on_fans
    assert len(frames.normals) == len(cloud.fans.triangles)
    assert not given or np.quantile(np.abs(frames.min_curvature), 0.95) < 0.07
    eigenvalues = compute_spectrum(AnisotropicLaplacian(cloud, alpha=5.0), count=13).eigenvalues
    wanted = sorted(4 * k * k + (np.pi * m / 2) ** 2 / 11 for k in range(-3, 4) for m in range(10))[:13]
    assert_allclose(eigenvalues[1:], wanted[1:], rtol=worst)


def test_given_normals_are_not_blurred():
    """With two rounds of smoothing, as points have, nine tenths of the errors are below 0.15, without below 0.10."""
    random = np.random.default_rng(0)
    u, v, chance = random.uniform(0, 2 * np.pi, 8000), random.uniform(0, 2 * np.pi, 8000), random.uniform(0, 1.4, 8000)
    u, v = (angle[chance < 1 + 0.4 * np.cos(v)][:2000] for angle in (u, v))
    outward = np.stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)], axis=1)
    cloud = PointCloud(np.stack([np.cos(u), np.sin(u), 0 * u], axis=1) + 0.4 * outward, outward)
    distance = np.linalg.norm(cloud.points[cloud.fans.triangles].mean(axis=1)[:, :2], axis=1)
    error = principal_curvatures(cloud).on_fans.min_curvature - (distance - 1) / 0.4 / distance
    assert np.quantile(np.abs(error), 0.9) < 0.11


def test_fans_without_a_bend_take_the_directions_of_their_points():
    sheet, along = rectangle(2.0, 1.0, n=12).vertices, np.array([np.cos(0.5), np.sin(0.5), 0.0])
    turned = sheet[:, :1] * along + sheet[:, 1:2] * np.cross([0.0, 0.0, 1.0], along)
    frames = principal_curvatures(PointCloud(turned, np.tile([0.0, 0.0, 1.0], (len(turned), 1))))
    assert (frames.on_fans.confidence < TRUSTED).all()
    assert_allclose(np.abs(frames.max_direction @ along), 1.0)
    assert_allclose(np.abs(frames.on_fans.max_direction @ along), 1.0)


def test_fans_bend_the_other_way_where_normals_point_inward():
    ball = subsample(sphere(4, radius=2.0), 1000).cloud
    assert_allclose(principal_curvatures(ball).on_fans.max_curvature, 0.5, rtol=0.15)
    inward = PointCloud(ball.points, -ball.normals)
    assert_allclose(principal_curvatures(inward).on_fans.max_curvature, -0.5, rtol=0.15)


def test_points_in_one_place_change_nothing():
    shape = torus(around=24, through=12)
    once = principal_curvatures(PointCloud(shape.vertices, shape.vertex_normals)).on_fans
    doubled = PointCloud(np.vstack([shape.vertices] * 2), np.vstack([shape.vertex_normals] * 2))
    twice = principal_curvatures(doubled).on_fans
    assert len(twice.normals) == 2 * len(once.normals)
    assert_allclose(np.unique(twice.max_curvature.round(8)), np.unique(once.max_curvature.round(8)))


def test_heat_runs_on_a_cloud_of_a_person_as_on_the_mesh():
    mesh = humans()[0]
    cloud = PointCloud(mesh.vertices, mesh.vertex_normals)
    of_mesh, of_cloud = AnisotropicLaplacian(mesh, alpha=50.0), AnisotropicLaplacian(cloud, alpha=50.0)
    frames = principal_curvatures(mesh)
    row = {tuple(sorted(face)): number for number, face in enumerate(mesh.faces.tolist())}
    shared = [
        (number, row[key])
        for number, key in enumerate(map(tuple, np.sort(cloud.fans.triangles, axis=1).tolist()))
        if key in row
    ]
    own, faces = np.array(shared).T
    assert len(own) > 0.6 * len(cloud.fans.triangles)
    ratio = of_cloud.frames.on_fans.max_curvature[own] / frames.max_curvature[faces]
    assert np.median(np.abs(np.log(np.abs(ratio)))) < 0.1
    ratio = of_cloud.weyl_eigenvalue(100) / of_mesh.weyl_eigenvalue(100)
    assert ratio == pytest.approx(1.0, abs=0.06)


def test_frames_of_the_fans_are_shared_and_follow_alpha():
    cloud = subsample(torus(), 800).cloud
    laplacian = AnisotropicLaplacian(cloud, alpha=5.0)
    again = AnisotropicLaplacian(cloud, alpha=5.0, frames=laplacian.frames)
    assert (again.stiffness(0.3) != laplacian.stiffness(0.3)).nnz == 0
    other = AnisotropicLaplacian(cloud, alpha=2.0).stiffness(0.3)
    assert_allclose(laplacian.with_alpha(2.0).stiffness(0.3).toarray(), other.toarray(), atol=1e-12)


def test_a_field_of_ones_own_stays_on_the_points():
    cloud = subsample(torus(), 300).cloud
    around = np.cross([0.0, 0.0, 1.0], cloud.points)
    laplacian = AnisotropicLaplacian.from_directions(cloud, around, along=1.0, across=0.1)
    assert laplacian.frames.on_fans is None
    assert len(laplacian.frames.normals) == 300
