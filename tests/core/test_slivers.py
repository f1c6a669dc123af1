"""Faces next to flat: correct spectra and heat beside them, or none of their own where rounding made them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import eigh

from add_core.descriptors import geometry_vectors
from add_core.eigensolver import dense
from add_core.errors import ConvergenceError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import ellipsoid, sphere
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import HeatFlow, compute_spectra, compute_spectrum


def with_flap(mesh, height, *, at=0.3, moved=0.0):
    """A vertex on an edge of face 7, lifted by `height` edge lengths, makes one face more."""
    a, b, _ = mesh.faces[7]
    edge = mesh.vertices[b] - mesh.vertices[a]
    place = mesh.vertices[a] + at * edge + height * np.linalg.norm(edge) * mesh.face_normals[7]
    faces = np.vstack([mesh.faces, [[a, mesh.vertex_count, b]]])
    return TriangleMesh(np.vstack([mesh.vertices, [place]]) + moved, faces)


def spectrum(mesh, count, alpha=0.0):
    return compute_spectrum(AnisotropicLaplacian(mesh, alpha=alpha), count=count)


@pytest.mark.parametrize("height", [1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize(("subdivisions", "count"), [(2, 8), (2, 150), (3, 20)])
def test_a_flap_changes_nothing_around_it(height, subdivisions, count):
    mesh = ellipsoid(1.0, 0.8, 0.6, subdivisions=subdivisions)
    expected, found = spectrum(mesh, count), spectrum(with_flap(mesh, height), count)
    assert_allclose(found.eigenvalues, expected.eigenvalues, rtol=1e-5, atol=1e-9)
    functions = found.eigenfunctions
    assert_allclose(functions.T @ (found.mass[:, None] * functions), np.eye(count), atol=1e-7)


def test_a_flap_of_half_an_edge_is_solved_at_any_anisotropy():
    mesh = with_flap(ellipsoid(1.0, 0.8, 0.6, subdivisions=2), 1e-8, at=0.5)
    laplacian = AnisotropicLaplacian(ellipsoid(1.0, 0.8, 0.6, subdivisions=2), alpha=50.0)
    expected = eigh(laplacian.stiffness().toarray(), np.diag(laplacian.mass), eigvals_only=True)[:10]
    assert_allclose(spectrum(mesh, 10, alpha=50.0).eigenvalues[1:], expected[1:], rtol=0.02)


def test_a_face_as_flat_as_the_rounding_of_its_coordinates_has_no_area():
    mesh = ellipsoid(1.0, 0.8, 0.6, subdivisions=3)
    far = with_flap(mesh, 0.0, moved=np.array([100.0, 30.0, 70.0]))
    assert not far.has_area[-1]
    assert far.has_area[:-1].all()
    assert_allclose(spectrum(far, 20).eigenvalues, spectrum(mesh, 20).eigenvalues, rtol=1e-9, atol=1e-9)


def test_a_sliver_of_its_own_does_not_stop_the_heat_elsewhere():
    ball = sphere(2)
    n = ball.vertex_count
    more = TriangleMesh(
        np.vstack([ball.vertices, [[3, 0, 0], [4, 0, 0], [3.5, 1e-11, 0]]]),
        np.vstack([ball.faces, [[n, n + 1, n + 2]]]),
    )
    flow, alone = (HeatFlow(AnisotropicLaplacian(mesh, alpha=0.0)) for mesh in (more, ball))
    for time in (0.1, 1.0, 1e3):
        kernel = flow.kernel(0, theta=0.0, time=time)
        assert_allclose(kernel[:n], alone.kernel(0, theta=0.0, time=time), rtol=1e-4, atol=1e-7)
        assert not kernel[n:].any()
    assert (flow.kernel(n, theta=0.0, time=1.0) @ more.vertex_areas) == pytest.approx(1.0)


def test_no_time_is_too_short_for_heat_to_stay_where_it_is():
    ball = sphere(2)
    kernel = HeatFlow(AnisotropicLaplacian(ball, alpha=0.0)).kernel(0, theta=0.0, time=1e-320)
    assert kernel[0] == pytest.approx(1 / ball.vertex_areas[0])
    assert np.abs(kernel[1:]).max() < 1e-6


def test_pairs_that_miss_their_residual_are_no_answer(monkeypatch):
    monkeypatch.setattr(dense, "failing", lambda matrix, pairs: np.ones(len(pairs.values), dtype=bool))
    with pytest.raises(ConvergenceError, match="7 of 7 eigenpairs miss a residual of 1e-06, for the shape has faces"):
        spectrum(ellipsoid(1.0, 0.8, 0.6, subdivisions=2), 8)


def test_eigenvalues_of_needles_are_not_negative():
    side = np.arange(30.0)
    x, y = np.meshgrid(side, side)
    first = (np.arange(29)[:, None] * 30 + np.arange(29)).ravel()
    faces = np.vstack([np.stack([first, first + 1, first + 31], 1), np.stack([first, first + 31, first + 30], 1)])
    needles = TriangleMesh(np.stack([x.ravel(), 1e-7 * y.ravel(), 0 * x.ravel()], axis=1), faces)
    family = compute_spectra(
        needles, alphas=(0.0, 50.0), angles=4, count=50, conductivity="constant", cache=False, workers=1
    )
    assert family.eigenvalues.min() == 0
    assert np.isfinite(geometry_vectors(family)).all()
