"""Curvature and operator on point clouds against closed forms, and against the mesh that the points were taken
from."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.linalg import eigh

from add_core.errors import AddError, GeometryError
from add_core.geometry import PointCloud, PrincipalFrames, principal_curvatures, subsample
from add_core.geometry.shapes import cylinder, rectangle, sphere, torus
from add_core.io import humans, poses
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import compute_spectrum

UP = np.array([0.0, 0.0, 1.0])


def unit(degrees):
    return np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0])


def angle_between_axes(a, b):
    return np.degrees(np.arccos(np.clip(np.abs(np.einsum("ni,ni->n", a, b)), 0, 1)))


def dense_eigenvalues(laplacian, theta=0.0, count=30):
    return eigh(laplacian.stiffness(theta).toarray(), np.diag(laplacian.mass), eigvals_only=True)[:count]


@pytest.mark.parametrize("given", [True, False])
def test_a_cylinder_bends_around_and_not_along(given):
    shape = cylinder(radius=0.5, height=2.0)
    frames = principal_curvatures(PointCloud(shape.vertices, shape.vertex_normals if given else None))
    inner = np.abs(shape.vertices[:, 2]) < 0.8
    around = np.cross(UP, shape.vertices * [1, 1, 0]) / 0.5
    assert angle_between_axes(frames.max_direction, around)[inner].max() < 0.5
    assert_allclose(frames.max_curvature[inner], 2.0, rtol=0.01)
    assert_allclose(frames.min_curvature[inner], 0.0, atol=0.02)


def test_directions_survive_an_uneven_spread_of_points():
    rng = np.random.default_rng(0)
    angle, z = 2 * np.pi * rng.random(3000), rng.uniform(-1, 1, 3000)
    points = np.stack([0.5 * np.cos(angle), 0.5 * np.sin(angle), z], axis=1)
    frames = principal_curvatures(PointCloud(points))
    around = np.stack([-np.sin(angle), np.cos(angle), 0 * z], axis=1)
    assert np.median(angle_between_axes(frames.max_direction, around)) < 2.0


def test_the_inner_side_of_a_torus_is_a_saddle_and_the_outer_side_is_convex():
    shape = torus(around=90, through=40)
    frames = principal_curvatures(PointCloud(shape.vertices))
    distance = np.linalg.norm(shape.vertices[:, :2], axis=1)
    around = np.cross(UP, shape.vertices * [1, 1, 0]) / distance[:, None]
    assert angle_between_axes(frames.min_direction, around).max() < 1.0
    assert_allclose(frames.max_curvature, 2.5, rtol=0.03)
    assert_allclose(frames.min_curvature, (distance - 1) / 0.4 / distance, atol=0.1)


def test_curvature_is_that_of_a_ball_and_flips_with_its_normals():
    ball = subsample(sphere(4, radius=2.0), 1000).cloud
    assert_allclose(principal_curvatures(ball).max_curvature, 0.5, rtol=0.02)
    assert_allclose(principal_curvatures(PointCloud(ball.points, -ball.normals)).max_curvature, -0.5, rtol=0.02)


def test_frames_of_a_cloud_are_orthonormal_and_right_handed():
    frames = principal_curvatures(subsample(torus(), 600).cloud)
    assert_allclose(np.cross(frames.max_direction, frames.min_direction), frames.normals, atol=1e-12)
    assert (np.abs(frames.max_curvature) >= np.abs(frames.min_curvature)).all()


@pytest.mark.parametrize("degrees", [0, 30, 137])
@pytest.mark.parametrize("theta", [0.0, 0.4, 2.9])
@pytest.mark.parametrize("conductivity", ["curvature", "constant"])
def test_energy_of_a_linear_function_on_a_flat_cloud_is_exact(degrees, theta, conductivity):
    """The fans of a flat grid agree, so u = g·x has energy area (a (g·t)² + b (g·s)²) as on a mesh."""
    points = rectangle(2.0, 3.0, n=5).vertices
    cloud = PointCloud(points, np.tile(UP, (len(points), 1)))
    rows = [np.tile(v, (len(points), 1)) for v in (unit(degrees), unit(degrees + 90), UP)]
    n = len(points)
    frames = PrincipalFrames(*rows, np.full(n, -0.7), np.full(n, 0.2), np.ones(n))
    laplacian = AnisotropicLaplacian(cloud, alpha=3.0, conductivity=conductivity, frames=frames)
    along, across = (1 / (1 + 3 * 0.2), 1 / (1 + 3 * 0.7)) if conductivity == "curvature" else (1.0, 1 / (1 + 3.0))
    g = np.array([0.8, -0.3, 0.0])
    t, s = unit(degrees + np.degrees(theta)), unit(degrees + np.degrees(theta) + 90)
    u = points @ g
    expected = 6.0 * (along * (g @ t) ** 2 + across * (g @ s) ** 2)
    assert_allclose(u @ laplacian.stiffness(theta) @ u, expected, rtol=1e-10)


@pytest.mark.parametrize("theta", [0.0, 0.5, np.pi / 2])
def test_heat_on_a_half_cylinder_runs_where_the_model_says(theta):
    """Unrolled, a helix is a straight line: u = cos β · rφ + sin β · z has the energy of a linear function."""
    radius, alpha, beta = 0.5, 4.0, 0.6
    whole = cylinder(radius=radius, height=1.0, around=128, along=40)
    half = whole.vertices[:, 0] > -1e-9
    points, normals = whole.vertices[half], whole.vertex_normals[half]
    cloud = PointCloud(points, normals)
    phi = np.arctan2(points[:, 1], points[:, 0])
    u = np.cos(beta) * radius * phi + np.sin(beta) * points[:, 2]
    laplacian = AnisotropicLaplacian(cloud, alpha=alpha)
    along, across = 1.0, 1 / (1 + alpha / radius)  # ψ(κ_m), ψ(κ_M)
    turned = beta - theta  # u_M runs around, so θ turns from rφ towards z
    expected = np.pi * radius * (along * np.cos(turned) ** 2 + across * np.sin(turned) ** 2)
    assert_allclose(u @ laplacian.stiffness(theta) @ u, expected, rtol=0.01)


@pytest.mark.parametrize("given", [True, False])
def test_the_sphere_has_its_eigenvalues_with_their_multiplicities(given):
    cloud = subsample(sphere(5), 2500).cloud
    cloud = cloud if given else PointCloud(cloud.points)
    spectrum = compute_spectrum(AnisotropicLaplacian(cloud, alpha=0.0), count=49)
    expected = np.repeat([level * (level + 1) for level in range(7)], [2 * level + 1 for level in range(7)])
    assert_allclose(spectrum.eigenvalues, expected, rtol=0.03, atol=1e-9)


def errors_of(cloud, mesh, count):
    """(count − 1,): by how much each eigenvalue of the cloud is off that of the mesh, relatively."""
    of_mesh, of_cloud = (
        compute_spectrum(AnisotropicLaplacian(shape, alpha=0.0), count=count).eigenvalues[1:] for shape in (mesh, cloud)
    )
    return np.abs(of_cloud / of_mesh - 1)


@pytest.mark.parametrize("given", [True, False])
def test_the_spectrum_of_a_person_survives_the_loss_of_the_faces(given):
    mesh = humans()[0]
    cloud = subsample(mesh, 4000).cloud
    cloud = cloud if given else PointCloud(cloud.points)
    assert errors_of(cloud, mesh, 50).max() < 0.05
    assert cloud.area == pytest.approx(mesh.area, rel=0.02)


def test_hands_on_thighs_do_not_grow_together():
    """The hands of a person who sits are one or two point distances above the thighs; joined, λ₁ would all but
    double."""
    mesh = humans()[45]
    assert errors_of(subsample(mesh, 4000).cloud, mesh, 30).max() < 0.12


@pytest.mark.parametrize(
    ("shapes", "number", "count", "most"),
    [
        pytest.param(humans, 0, 50, 0.05, id="armpits torn at the bottom of the fold, λ₄ would lose 7 %"),
        pytest.param(humans, 73, 15, 0.05, id="a hand grown together with the hip it sinks into, λ₁₁ would gain 10 %"),
        pytest.param(poses, 1, 46, 0.03, id="dense hands torn where fingers part, their modes would lose 6 %"),
    ],
)
def test_parts_that_touch_are_neither_torn_nor_grown_together(shapes, number, count, most):
    mesh = shapes()[number]
    assert errors_of(PointCloud(mesh.vertices, mesh.vertex_normals), mesh, count).max() < most


@pytest.mark.parametrize(
    "number",
    [
        pytest.param(24, id="planes fitted across two thighs would cost 10 % of λ₆"),
        pytest.param(74, id="edges from a hand into the hip that it sinks into would add 12 % to λ₄"),
    ],
)
def test_parts_that_touch_are_told_apart_without_normals(number):
    mesh = humans()[number]
    assert errors_of(PointCloud(mesh.vertices), mesh, 50).max() < 0.05


@pytest.mark.parametrize("around", [12, 20, 40])
def test_the_fans_of_a_coarse_grid_keep_its_area(around):
    shape = torus(around=2 * around, through=around)
    cloud = PointCloud(shape.vertices, shape.vertex_normals)
    assert cloud.area == pytest.approx(4 * np.pi**2 * 0.4, rel=0.1)


@pytest.mark.parametrize("conductivity", ["curvature", "constant"])
def test_the_matrix_is_symmetric_positive_semidefinite_with_constants_in_its_kernel(conductivity):
    cloud = PointCloud(subsample(humans()[3], 700).cloud.points)
    laplacian = AnisotropicLaplacian(cloud, alpha=50.0, conductivity=conductivity)
    stiffness = laplacian.stiffness(1.1).toarray()
    largest = np.abs(stiffness).max()
    assert_allclose(stiffness, stiffness.T, atol=1e-14 * largest)
    assert_allclose(stiffness.sum(axis=1), 0, atol=1e-12 * largest)
    assert np.linalg.eigvalsh(stiffness)[0] > -1e-12 * largest
    assert (laplacian.mass > 0).all()


def test_mass_adds_up_to_the_area():
    cloud = subsample(torus(), 900).cloud
    assert AnisotropicLaplacian(cloud).mass.sum() == pytest.approx(cloud.area, rel=1e-12)


def test_the_operator_follows_the_order_of_the_points_and_rigid_motion():
    points = subsample(torus(), 500).cloud.points
    order = np.random.default_rng(1).permutation(500)
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    one = AnisotropicLaplacian(PointCloud(points), alpha=5.0).stiffness(0.7).toarray()
    other = AnisotropicLaplacian(PointCloud((points @ turn.T + 3.0)[order]), alpha=5.0).stiffness(0.7).toarray()
    assert_allclose(other, one[np.ix_(order, order)], atol=1e-5 * np.abs(one).max())


@pytest.mark.parametrize("unit_of_length", [1e-6, 1e6])
def test_eigenvalues_scale_with_the_unit_of_length(unit_of_length):
    points = subsample(torus(), 400).cloud.points
    one = dense_eigenvalues(AnisotropicLaplacian(PointCloud(points), alpha=5.0))
    other = dense_eigenvalues(AnisotropicLaplacian(PointCloud(unit_of_length * points), alpha=5.0 * unit_of_length))
    assert_allclose(other[1:] * unit_of_length**2, one[1:], rtol=1e-6)


def test_two_pieces_have_two_zero_eigenvalues():
    points = np.vstack([sphere(2).vertices, sphere(2).vertices + 6.0])
    values = dense_eigenvalues(AnisotropicLaplacian(PointCloud(points), alpha=0.0), count=3)
    assert_allclose(values[:2], 0, atol=1e-9)
    assert values[2] > 1.0


def test_points_in_one_place_leave_the_low_eigenvalues_as_they_are():
    ball = sphere(3).vertices
    twice = AnisotropicLaplacian(PointCloud(np.vstack([ball, ball[::7]])), alpha=0.0)
    once = AnisotropicLaplacian(PointCloud(ball), alpha=0.0)
    assert (twice.mass > 0).all()
    assert_allclose(dense_eigenvalues(twice, count=9), dense_eigenvalues(once, count=9), rtol=0.03, atol=1e-9)


@pytest.mark.parametrize("points", [np.ones((10, 3)), np.outer(np.arange(10.0), [1.0, 2.0, 3.0]), np.zeros((1, 3))])
def test_a_cloud_without_area_is_refused(points):
    with pytest.raises(GeometryError, match="has no area, so no heat can run on it"):
        AnisotropicLaplacian(PointCloud(points))


@st.composite
def clouds(draw):
    """Points on anything or nothing: scattered, flat, straight, doubled, far from the origin, in any unit."""
    rng = np.random.default_rng(draw(st.integers(0, 2**31)))
    points = rng.normal(size=(draw(st.integers(1, 60)), 3))
    points *= draw(st.sampled_from([(1, 1, 1), (1, 1, 0), (1, 0, 0), (1, 1, 1e-9), (0, 0, 0)]))
    if draw(st.booleans()):
        points = np.round(points, 0)
    if draw(st.booleans()):
        points = np.vstack([points, points[:: draw(st.integers(1, 3))]])
    points = points + draw(st.sampled_from([0.0, 10.0, 1000.0]))
    return points * draw(st.sampled_from([1e-6, 1.0, 1e6]))


@settings(max_examples=150, deadline=None)
@given(points=clouds(), theta=st.floats(-7, 7), alpha=st.floats(0, 100))
def test_any_cloud_has_a_sound_operator_or_an_explanation(points, theta, alpha):
    try:
        laplacian = AnisotropicLaplacian(PointCloud(points), alpha=alpha)
    except AddError:
        return
    stiffness = laplacian.stiffness(theta).toarray()
    largest = np.abs(stiffness).max()
    assert np.isfinite(stiffness).all()
    assert np.isfinite(laplacian.mass).all()
    assert_allclose(stiffness, stiffness.T, atol=1e-12 * largest)
    assert np.linalg.eigvalsh(stiffness)[0] >= -1e-10 * largest
    isolated = np.isin(np.arange(len(points)), laplacian.shape.fans.isolated)
    assert ((laplacian.mass > 0) == ~isolated).all()
    frames = laplacian.frames
    assert np.isfinite([frames.max_curvature, frames.min_curvature, frames.confidence]).all()


def test_a_neighbour_straight_above_a_point_has_no_direction_in_its_plane():
    """In a unit of 1e6 its length over that of its shadow overflowed, and the shadow times that was NaN."""
    sheet = 1e6 * rectangle(n=6).vertices
    cloud = PointCloud(np.vstack([sheet, sheet + np.array([0, 0, 3e5])]), np.tile([0.0, 0.0, 1.0], (2 * len(sheet), 1)))
    assert np.isfinite(cloud.tangent_planes.plane).all()
    assert cloud.area == pytest.approx(2e12, rel=1e-9)
