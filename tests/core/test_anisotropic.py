"""The anisotropic Laplacian against closed forms, its isotropic limit and its invariances."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import eigh

from add_core.errors import GeometryError, ParameterError
from add_core.geometry import PrincipalFrames, TriangleMesh, principal_curvatures
from add_core.geometry.shapes import cylinder, ellipsoid, rectangle, sphere
from add_core.io import humans
from add_core.operators import AnisotropicLaplacian


def unit(degrees):
    return np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0])


def flat_frames(mesh, degrees, *, max_curvature=0.0, min_curvature=0.0):
    """The same frame on every face of a mesh in the xy plane, u_M at `degrees` from x."""
    m = len(mesh.faces)
    rows = [np.tile(v, (m, 1)) for v in (unit(degrees), unit(degrees + 90), [0.0, 0.0, 1.0])]
    return PrincipalFrames(*rows, np.full(m, max_curvature), np.full(m, min_curvature), np.ones(m))


def dense_eigenvalues(laplacian, theta=0.0, count=30):
    return eigh(laplacian.stiffness(theta).toarray(), np.diag(laplacian.mass), eigvals_only=True)[:count]


def mirrored(mesh):
    return TriangleMesh(mesh.vertices * [-1, 1, 1], mesh.faces[:, ::-1])


@pytest.mark.parametrize("degrees", [0, 30, 90, 137])
@pytest.mark.parametrize("theta", [0.0, 0.4, 1.2, 2.9])
@pytest.mark.parametrize("conductivity", ["curvature", "constant"])
def test_energy_of_a_linear_function_is_exact(degrees, theta, conductivity):
    """u = g·x has a constant gradient, so u'Wu = area (a (g·t)² + b (g·s)²): no mesh size in sight."""
    mesh = rectangle(2.0, 3.0, n=5)
    frames = flat_frames(mesh, degrees, max_curvature=-0.7, min_curvature=0.2)
    laplacian = AnisotropicLaplacian(mesh, alpha=3.0, conductivity=conductivity, frames=frames)
    along, across = (1 / (1 + 3 * 0.2), 1 / (1 + 3 * 0.7)) if conductivity == "curvature" else (1.0, 1 / (1 + 3.0))
    g = np.array([0.8, -0.3, 0.0])
    t, s = unit(degrees + np.degrees(theta)), unit(degrees + np.degrees(theta) + 90)
    u = mesh.vertices @ g
    expected = 6.0 * (along * (g @ t) ** 2 + across * (g @ s) ** 2)
    assert_allclose(u @ laplacian.stiffness(theta) @ u, expected, rtol=1e-12)


@pytest.mark.parametrize("theta", [0.0, 0.3, np.pi / 2, 2.0])
@pytest.mark.parametrize("conductivity", ["curvature", "constant"])
def test_heat_on_a_half_cylinder_runs_where_the_model_says(theta, conductivity):
    """Unrolled, a helix is a straight line: u = cos β · rφ + sin β · z has the energy of a linear function."""
    radius, alpha, beta = 0.5, 4.0, 0.6
    whole = cylinder(radius=radius, height=1.0, around=128, along=40)
    half = whole.vertices[whole.faces][:, :, 0].min(axis=1) > -1e-9
    mesh = TriangleMesh(whole.vertices, whole.faces[half])
    phi = np.arctan2(mesh.vertices[:, 1], mesh.vertices[:, 0])
    u = np.cos(beta) * radius * phi + np.sin(beta) * mesh.vertices[:, 2]
    laplacian = AnisotropicLaplacian(mesh, alpha=alpha, conductivity=conductivity)
    # u_M runs around (+φ when seen from outside, where u_m = n × u_M = +z), κ_M = 1/r, κ_m = 0.
    along, across = (1.0, 1 / (1 + alpha / radius)) if conductivity == "curvature" else (1.0, 1 / (1 + alpha))
    expected = along * np.cos(theta - beta) ** 2 + across * np.sin(theta - beta) ** 2
    used = mesh.vertex_areas > 0
    assert_allclose(u[used] @ (laplacian.stiffness(theta) @ u)[used] / mesh.area, expected, rtol=2e-3)


@pytest.mark.parametrize(("along_x", "theta"), [(True, 0.0), (False, np.pi / 2)])
def test_rectangle_spectrum_converges_at_second_order(along_x, theta):
    """π²(a i²/w² + b j²/h²) for conductivity a along x and b along y."""
    width, height, alpha = 1.0, 1.5, 3.0
    a, b = (1.0, 1 / (1 + alpha)) if along_x else (1 / (1 + alpha), 1.0)
    i, j = np.meshgrid(np.arange(12), np.arange(12))
    exact = np.sort((np.pi**2 * (a * i**2 / width**2 + b * j**2 / height**2)).ravel())[:12]
    errors = []
    for n in (8, 16, 24):
        mesh = rectangle(width, height, n=n)
        laplacian = AnisotropicLaplacian(mesh, alpha=alpha, conductivity="constant", frames=flat_frames(mesh, 0))
        errors.append(np.abs(dense_eigenvalues(laplacian, theta, 12) - exact)[1:] / exact[1:])
    assert errors[-1].max() < 0.03
    order = np.log(errors[0].max() / errors[2].max()) / np.log(3)
    assert order > 1.85


def test_a_sphere_rings_like_a_sphere():
    """Eigenvalues l(l + 1)/r², each 2l + 1 times."""
    values = dense_eigenvalues(AnisotropicLaplacian(sphere(3, radius=2.0), alpha=0.0), count=16)
    expected = np.repeat([k * (k + 1) / 4 for k in range(4)], [2 * k + 1 for k in range(4)])
    assert_allclose(values, expected, rtol=0.02, atol=1e-12)


def test_alpha_zero_is_the_cotangent_laplacian_at_every_angle():
    mesh = ellipsoid(subdivisions=2)
    cotangent = np.zeros((mesh.vertex_count,) * 2)
    for face in mesh.faces:
        for k in range(3):
            o, i, j = np.roll(face, -k)
            p, q = mesh.vertices[i] - mesh.vertices[o], mesh.vertices[j] - mesh.vertices[o]
            weight = 0.5 * (p @ q) / np.linalg.norm(np.cross(p, q))
            cotangent[[i, j], [j, i]] -= weight
            cotangent[[i, j], [i, j]] += weight
    for conductivity in ("curvature", "constant"):
        laplacian = AnisotropicLaplacian(mesh, alpha=0.0, conductivity=conductivity)
        for theta in (0.0, 0.7):
            assert_allclose(laplacian.stiffness(theta).toarray(), cotangent, atol=1e-12)


@pytest.mark.parametrize("conductivity", ["curvature", "constant"])
@pytest.mark.parametrize("alpha", [0.3, 50.0, 1e4])
def test_stiffness_is_symmetric_semidefinite_and_blind_to_constants(conductivity, alpha):
    laplacian = AnisotropicLaplacian(ellipsoid(subdivisions=2), alpha=alpha, conductivity=conductivity)
    stiffness = laplacian.stiffness(0.9).toarray()
    values = np.linalg.eigvalsh(stiffness)
    assert_allclose(stiffness, stiffness.T, atol=1e-15)
    assert_allclose(stiffness.sum(axis=1), 0, atol=1e-12)
    assert values[0] > -1e-12 * values[-1]
    assert values[1] > 1e-9 * values[-1]


def test_everything_has_period_pi_and_one_pattern():
    laplacian = AnisotropicLaplacian(ellipsoid(subdivisions=2), alpha=20.0)
    assert_allclose(laplacian.stiffness_values(0.4), laplacian.stiffness_values(0.4 + np.pi), atol=1e-14)
    assert laplacian.stiffness(0.0).nnz == laplacian.stiffness(0.4).nnz == len(laplacian.pattern.indices)


def test_a_mirror_turns_theta_the_other_way():
    """f_θ∘η = f_{−θ} with η the map to the mirror image: exact, because the frames are mirrored too."""
    mesh = ellipsoid(1.0, 0.8, 0.6, subdivisions=3)
    left, right = AnisotropicLaplacian(mesh, alpha=10.0), AnisotropicLaplacian(mirrored(mesh), alpha=10.0)
    scale = np.abs(left.stiffness_values(0.0)).max()
    assert_allclose(right.stiffness_values(-0.5), left.stiffness_values(0.5), atol=1e-9 * scale)
    assert np.abs(right.stiffness_values(0.5) - left.stiffness_values(0.5)).max() > 1e-2 * scale


def test_a_person_in_neutral_pose_confirms_it():
    """The local energies of a function and of its mirror image agree at θ and −θ, and disagree at θ and θ."""
    people = humans()
    person, eta = people[0], people.symmetry
    laplacian = AnisotropicLaplacian(person, alpha=50.0)

    def diagonal(theta):
        return laplacian.stiffness(theta).diagonal()

    mirrored_error = np.median(np.abs(diagonal(0.5)[eta] - diagonal(-0.5)) / diagonal(-0.5))
    same_error = np.median(np.abs(diagonal(0.5)[eta] - diagonal(0.5)) / diagonal(0.5))
    assert mirrored_error < 0.02
    assert same_error > 5 * mirrored_error


def test_moving_turning_and_renumbering_a_shape_changes_nothing():
    mesh = ellipsoid(subdivisions=2)
    rng = np.random.default_rng(3)
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    rotation *= np.linalg.det(rotation)
    order = rng.permutation(mesh.vertex_count)
    position = np.argsort(order)
    faces = np.roll(position[mesh.faces], 1, axis=1)[rng.permutation(len(mesh.faces))]
    moved = TriangleMesh((mesh.vertices @ rotation.T + [1, 2, 3])[order], faces)
    before = AnisotropicLaplacian(mesh, alpha=5.0).stiffness(0.6).toarray()
    after = AnisotropicLaplacian(moved, alpha=5.0).stiffness(0.6).toarray()
    assert_allclose(after, before[np.ix_(order, order)], atol=1e-9)


def test_with_alpha_scaled_like_a_length_the_unit_does_not_matter():
    """ψ(κ) = 1/(1 + α|κ|) and κ is 1/length: millimetres with α in millimetres give W unchanged and S in mm²."""
    mesh = ellipsoid(subdivisions=2)
    metres = AnisotropicLaplacian(mesh, alpha=0.5)
    millimetres = AnisotropicLaplacian(TriangleMesh(1000 * mesh.vertices, mesh.faces), alpha=500.0)
    assert_allclose(millimetres.stiffness_values(0.6), metres.stiffness_values(0.6), atol=1e-9)
    assert_allclose(millimetres.mass, 1e6 * metres.mass)
    assert_allclose(millimetres.weyl_eigenvalue(9), 1e-6 * metres.weyl_eigenvalue(9))


def test_weyl_estimates_the_high_end_of_a_sphere_at_any_alpha():
    for alpha in (0.0, 8.0):
        laplacian = AnisotropicLaplacian(sphere(3), alpha=alpha)
        value = dense_eigenvalues(laplacian, 0.3, 101)[100]
        assert_allclose(laplacian.weyl_eigenvalue(100), value, rtol=0.12)


def test_with_alpha_is_the_operator_built_anew():
    mesh = ellipsoid(subdivisions=2)
    derived = AnisotropicLaplacian(mesh, alpha=50.0).with_alpha(7.0, conductivity="constant")
    fresh = AnisotropicLaplacian(mesh, alpha=7.0, conductivity="constant")
    assert_allclose(derived.stiffness_values(0.2), fresh.stiffness_values(0.2), rtol=1e-14, atol=1e-15)
    assert derived.alpha == 7.0


def test_unreferenced_vertices_and_faces_without_area_take_no_part():
    mesh = ellipsoid(subdivisions=2)
    n = mesh.vertex_count
    spoiled = TriangleMesh(np.vstack([mesh.vertices, [9.0, 9.0, 9.0]]), np.vstack([mesh.faces, [[0, 1, 1]]]))
    before, after = AnisotropicLaplacian(mesh), AnisotropicLaplacian(spoiled)
    assert_allclose(after.stiffness(0.3).toarray()[:n, :n], before.stiffness(0.3).toarray(), atol=1e-12)
    assert not after.stiffness(0.3).toarray()[n].any()
    assert after.mass[n] == 0


def test_faces_turned_against_their_neighbours_change_nothing_and_are_reported(caplog):
    mesh = ellipsoid(subdivisions=2)
    faces = mesh.faces.copy()
    faces[[3, 50, 51]] = faces[[3, 50, 51]][:, ::-1]
    before = AnisotropicLaplacian(mesh, alpha=5.0).stiffness_values(0.6)
    after = AnisotropicLaplacian(TriangleMesh(mesh.vertices, faces), alpha=5.0).stiffness_values(0.6)
    assert_allclose(after, before, atol=1e-12)
    assert "3 of 320 faces" in caplog.text


def test_frames_of_another_shape_are_refused():
    with pytest.raises(GeometryError, match=r"frames must have one row for each of the 5120 faces, but they have 1280"):
        AnisotropicLaplacian(sphere(4), frames=principal_curvatures(sphere(3)))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"alpha": -1.0}, "alpha must be finite and at least 0, but it is -1.0"),
        ({"alpha": np.nan}, "alpha must be finite and at least 0, but it is nan"),
        ({"conductivity": "eq9"}, "conductivity must be one of 'curvature', 'constant', but it is 'eq9'"),
    ],
)
def test_parameters_out_of_range_are_explained(options, message):
    with pytest.raises(ParameterError, match=message):
        AnisotropicLaplacian(sphere(1), **options)


def test_a_shape_without_area_is_refused():
    with pytest.raises(GeometryError, match="has no area"):
        AnisotropicLaplacian(TriangleMesh(np.zeros((3, 3)), [[0, 1, 2]]))


@pytest.mark.parametrize("theta", [0.0, 0.7])
def test_a_direction_field_of_your_own_takes_the_place_of_the_models(theta):
    """Heat along x on a flat mesh, twice as readily as across; what sticks out of the surface is ignored."""
    mesh = rectangle(2.0, 3.0, n=5)
    directions = np.tile([1.0, 0.0, 5.0], (len(mesh.faces), 1))
    laplacian = AnisotropicLaplacian.from_directions(mesh, directions, along=1.0, across=0.5)
    u = mesh.vertices[:, 0]
    assert_allclose(u @ laplacian.stiffness(theta) @ u, 6 * (np.cos(theta) ** 2 + 0.5 * np.sin(theta) ** 2))


@pytest.mark.parametrize("theta", [0.0, 0.7])
def test_a_tensor_field_of_your_own_takes_the_place_of_the_models(theta):
    mesh = rectangle(2.0, 3.0, n=5)
    tensor = np.array([[0.9, 0.3, 0.2], [0.3, 0.5, 0.1], [0.2, 0.1, 7.0]])
    laplacian = AnisotropicLaplacian.from_tensors(mesh, np.tile(tensor, (len(mesh.faces), 1, 1)))
    turn = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    g = np.array([0.8, -0.3])
    u = mesh.vertices[:, :2] @ g
    assert_allclose(u @ laplacian.stiffness(theta) @ u, 6 * g @ turn @ tensor[:2, :2] @ turn.T @ g)


def test_the_models_are_tensor_fields():
    mesh = ellipsoid(subdivisions=2)
    frames, alpha = principal_curvatures(mesh), 4.0
    along, across = 1 / (1 + alpha * np.abs(frames.min_curvature)), 1 / (1 + alpha * np.abs(frames.max_curvature))
    t, s = frames.max_direction, frames.min_direction
    tensors = along[:, None, None] * t[:, :, None] * t[:, None] + across[:, None, None] * s[:, :, None] * s[:, None]
    own, model = AnisotropicLaplacian.from_tensors(mesh, tensors), AnisotropicLaplacian(mesh, alpha=alpha)
    assert_allclose(own.stiffness_values(0.4), model.stiffness_values(0.4), atol=1e-12)


def upper_triangles(m):
    return np.tile(np.triu(np.ones((3, 3))), (m, 1, 1))


@pytest.mark.parametrize(
    ("field", "options", "error", "message"),
    [
        (lambda m: np.ones((3, 3)), {"along": 1, "across": 1}, GeometryError, "directions must have shape"),
        (lambda m: m.face_normals, {"along": 1, "across": 1}, GeometryError, "a tangential part, but 80 of 80"),
        (lambda m: m.opposite_edges[:, 0], {"along": 0, "across": 1}, ParameterError, "along must be greater than 0"),
        (
            lambda m: -np.tile(np.eye(3), (80, 1, 1)),
            {},
            ParameterError,
            "positive definite in the tangent plane, but 80",
        ),
        (lambda m: upper_triangles(80), {}, ParameterError, "tensors must be symmetric"),
    ],
)
def test_unusable_fields_are_explained(field, options, error, message):
    mesh = sphere(1)
    build = AnisotropicLaplacian.from_directions if options else AnisotropicLaplacian.from_tensors
    with pytest.raises(error, match=message):
        build(mesh, field(mesh), **options)


def test_a_field_of_your_own_has_no_alpha():
    laplacian = AnisotropicLaplacian.from_tensors(sphere(1), np.tile(np.eye(3), (80, 1, 1)))
    with pytest.raises(ParameterError, match="a field of its own"):
        laplacian.with_alpha(3.0)
