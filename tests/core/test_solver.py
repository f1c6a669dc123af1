"""Spectra against dense eigensolvers on shapes that try to mislead an iterative one."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.eigensolver import solver
from add_core.eigensolver.solver import PencilSolver
from add_core.errors import ConvergenceError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import cylinder, ellipsoid, rectangle, sphere, torus
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import compute_spectrum


def copies(mesh: TriangleMesh, number: int) -> TriangleMesh:
    n = mesh.vertex_count
    vertices = np.vstack([mesh.vertices + np.array([7.0 * i, 0, 0]) for i in range(number)])
    return TriangleMesh(vertices, np.vstack([mesh.faces + n * i for i in range(number)]))


def with_slivers(mesh: TriangleMesh, share: float) -> TriangleMesh:
    """Every 40th edge shrunk to `share` of its length."""
    vertices = mesh.vertices.copy()
    a, b = mesh.edges[::40].T
    vertices[a] = vertices[b] + share * (vertices[a] - vertices[b])
    return TriangleMesh(vertices, mesh.faces)


def dense_spectrum(laplacian: AnisotropicLaplacian, theta: float) -> np.ndarray:
    massive = laplacian.mass > 0
    root = np.sqrt(laplacian.mass[massive])
    return np.linalg.eigvalsh(laplacian.stiffness(theta).toarray()[massive][:, massive] / np.outer(root, root))


def check(laplacian: AnisotropicLaplacian, *, theta: float = 0.3, count: int) -> None:
    spectrum = compute_spectrum(laplacian, theta=theta, count=count)
    values, phi, mass = spectrum.eigenvalues, spectrum.eigenfunctions, laplacian.mass
    expected = dense_spectrum(laplacian, theta)[:count]
    assert_allclose(values, expected, rtol=1e-8, atol=1e-10 * max(expected[-1], 1.0))
    assert_allclose(phi.T @ (mass[:, None] * phi), np.eye(count), atol=1e-8)
    massive = mass > 0
    defect = (laplacian.stiffness(theta) @ phi - mass[:, None] * phi * values)[massive]
    residual = np.sqrt((defect**2 / mass[massive, None]).sum(axis=0))
    assert (residual <= 1e-6 * np.maximum(values, 1e-4 * max(values[-1], 1.0))).all()


@pytest.mark.parametrize("conductivity", ["curvature", "constant"])
@pytest.mark.parametrize("alpha", [0.0, 1e-6, 3.7, 50.0, 1e5])
def test_any_anisotropy_agrees_with_the_dense_solver(alpha, conductivity):
    laplacian = AnisotropicLaplacian(ellipsoid(1.0, 0.8, 0.5, subdivisions=3), alpha=alpha, conductivity=conductivity)
    check(laplacian, theta=1.1, count=90)


@pytest.mark.parametrize(
    "mesh",
    [sphere(3), torus(around=40, through=20), cylinder(around=40, along=20), rectangle(60.0, 1.0, n=3)],
    ids=["sphere", "torus", "open cylinder", "strip"],
)
def test_multiplicities_boundaries_and_long_shapes_agree_with_the_dense_solver(mesh):
    check(AnisotropicLaplacian(mesh, alpha=20.0, conductivity="constant"), count=100)
    check(AnisotropicLaplacian(mesh, alpha=0.0), count=100)


@pytest.mark.parametrize("count", [1, 2, 3, 50, 400, 641, 642])
def test_any_number_of_pairs_can_be_asked_for(count):
    check(AnisotropicLaplacian(sphere(3), alpha=5.0), count=count)


def test_a_sphere_has_l_l_plus_1_each_2l_plus_1_times():
    values = compute_spectrum(AnisotropicLaplacian(sphere(4), alpha=0.0), count=36).eigenvalues
    expected = np.repeat([k * (k + 1) for k in range(6)], [2 * k + 1 for k in range(6)])
    assert_allclose(values, expected, rtol=0.02, atol=1e-12)


def test_a_triangle_has_three_eigenpairs():
    triangle = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    check(AnisotropicLaplacian(triangle, alpha=2.0, conductivity="constant"), count=3)


@pytest.mark.parametrize("count", [4, 9, 60])
def test_each_component_has_its_constant_exactly(count):
    mesh = copies(sphere(2), 9)  # more components, and so higher multiplicities, than many solvers expect
    laplacian = AnisotropicLaplacian(mesh, alpha=10.0)
    spectrum = compute_spectrum(laplacian, count=count)
    zeros = min(count, 9)
    assert (spectrum.eigenvalues[:zeros] == 0).all()
    for k in range(zeros):
        inside = mesh.component_labels == k
        assert_allclose(spectrum.eigenfunctions[inside, k], 1 / np.sqrt(laplacian.mass[inside].sum()))
        assert not spectrum.eigenfunctions[~inside, k].any()
    if count > 9:
        assert_allclose(spectrum.eigenvalues, dense_spectrum(laplacian, 0.0)[:count], rtol=1e-8, atol=1e-9)


def test_twenty_equal_components_are_not_miscounted():
    """Every eigenvalue twentyfold, more than a block holds: Sylvester's inertia notices what Lanczos missed."""
    laplacian = AnisotropicLaplacian(copies(sphere(1), 20), alpha=0.0)
    values = compute_spectrum(laplacian, count=100).eigenvalues
    assert_allclose(values, dense_spectrum(laplacian, 0.0)[:100], rtol=1e-8, atol=1e-9)


def test_vertices_without_mass_take_no_part():
    ball = sphere(3)
    loose = TriangleMesh(np.vstack([[[9, 9, 9]], ball.vertices, [[5, 5, 5]]]), ball.faces + 1)
    with_loose = compute_spectrum(AnisotropicLaplacian(loose, alpha=10.0), theta=0.2, count=80)
    alone = compute_spectrum(AnisotropicLaplacian(ball, alpha=10.0), theta=0.2, count=80)
    assert not with_loose.eigenfunctions[[0, -1]].any()
    assert_allclose(with_loose.eigenvalues, alone.eigenvalues, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("share", [1e-1, 1e-2, 1e-3])
def test_slivers_do_not_spoil_the_other_pairs(share):
    """A sliver makes W stiff without bound; smooth eigenfunctions hardly notice."""
    mesh = ellipsoid(1.0, 0.7, 0.5, subdivisions=3)
    healthy = compute_spectrum(AnisotropicLaplacian(with_slivers(mesh, 0.2), alpha=0.0), count=30).eigenvalues
    slivers = compute_spectrum(AnisotropicLaplacian(with_slivers(mesh, share), alpha=0.0), count=30).eigenvalues
    assert_allclose(slivers, healthy, rtol=0.05, atol=1e-9)


def test_units_only_scale_eigenvalues():
    mesh = ellipsoid(subdivisions=3)
    metres = AnisotropicLaplacian(mesh, alpha=4.0, conductivity="constant")
    for unit in (1e-6, 1e6):
        scaled = AnisotropicLaplacian(
            TriangleMesh(mesh.vertices * unit, mesh.faces), alpha=4.0, conductivity="constant"
        )
        values = compute_spectrum(scaled, count=60).eigenvalues * unit**2
        assert_allclose(values, compute_spectrum(metres, count=60).eigenvalues, rtol=1e-8, atol=1e-12)


@pytest.mark.parametrize("error", [1e-3, 0.1, 8.0, 300.0])
def test_a_poor_estimate_of_the_largest_eigenvalue_costs_time_only(error):
    laplacian = AnisotropicLaplacian(sphere(3), alpha=5.0)
    pattern = laplacian.pattern
    pairs = PencilSolver(pattern.indptr, pattern.indices, laplacian.mass).eigenpairs(
        laplacian.stiffness_values(0.0), count=60, scale=error * laplacian.weyl_eigenvalue(60)
    )
    assert_allclose(pairs.values, dense_spectrum(laplacian, 0.0)[:60], rtol=1e-8, atol=1e-9)
    assert pairs.fallback == ""


def test_signs_follow_the_documented_rule():
    phi = compute_spectrum(AnisotropicLaplacian(torus(), alpha=3.0), count=50).eigenfunctions
    first = np.argmax(np.abs(phi) > 0.5 * np.abs(phi).max(axis=0), axis=0)
    assert (phi[first, np.arange(50)] > 0).all()


def test_scipy_takes_over_where_lanczos_fails_and_says_so(monkeypatch, caplog):
    def refuse(*_, **__):
        raise ConvergenceError("refused for this test.")

    laplacian = AnisotropicLaplacian(sphere(3), alpha=5.0)
    expected = compute_spectrum(laplacian, count=40).eigenvalues
    monkeypatch.setattr(solver, "shift_invert_lanczos", refuse)
    monkeypatch.setattr(solver, "DENSE_RESCUE", 0)
    assert_allclose(compute_spectrum(laplacian, count=40).eigenvalues, expected, rtol=1e-8, atol=1e-9)
    assert "Using the scipy.sparse.linalg.eigsh instead" in caplog.text
    monkeypatch.setattr(solver, "DENSE_RESCUE", 10_000)
    assert_allclose(compute_spectrum(laplacian, count=40).eigenvalues, expected, rtol=1e-8, atol=1e-9)
    assert "Using the dense eigensolver instead" in caplog.text


def test_a_last_eigenvalue_inside_a_cluster_is_counted_beside_it(caplog):
    """Three equal spheres: λ₁ comes ninefold, and the fifth of those nine can be asked for without any fallback."""
    laplacian = AnisotropicLaplacian(copies(sphere(2), 3), alpha=0.0)
    spectrum = compute_spectrum(laplacian, count=3 + 5)
    assert_allclose(spectrum.eigenvalues, dense_spectrum(laplacian, 0.0)[:8], rtol=1e-8, atol=1e-10)
    assert caplog.text == ""
