"""Live heat kernels against the dense exponential."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import eigh, expm

from add_core.errors import ParameterError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import cylinder, ellipsoid, sphere
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import HeatFlow, heat_factors

THETA = 0.4


@pytest.fixture(scope="module")
def laplacian():
    return AnisotropicLaplacian(ellipsoid(1.0, 0.8, 0.6, subdivisions=3), alpha=50.0)


@pytest.fixture(scope="module")
def modes(laplacian):
    return eigh(laplacian.stiffness(THETA).toarray(), np.diag(laplacian.mass))


def dense_kernel(modes, time):
    values, vectors = modes
    return (vectors * np.exp(-time * np.maximum(values, 0))) @ vectors.T


def mass_norm(laplacian, field):
    return np.sqrt(laplacian.mass @ field**2)


def test_the_dense_reference_is_the_matrix_exponential(laplacian, modes):
    """The eigenvectors' kernel is expm(−t S⁻¹W) S⁻¹ itself."""
    time = 0.3
    generator = -time * laplacian.stiffness(THETA).toarray() / laplacian.mass[:, None]
    assert_allclose(dense_kernel(modes, time), expm(generator) / laplacian.mass, atol=1e-8)


@pytest.mark.parametrize("spread", np.geomspace(0.05, 5000, 11))
def test_kernels_agree_with_the_matrix_exponential(laplacian, modes, spread):
    """t·λ₃₀₀ from a spark to nearly even: the promise is 1e-4, the tolerance 1e-5."""
    time = spread / modes[0][300]
    flow = HeatFlow(laplacian)
    reference = dense_kernel(modes, time)
    for source in (0, 17, 300):
        kernel = flow.kernel(source, theta=THETA, time=time)
        error = mass_norm(laplacian, kernel - reference[source])
        assert error < 2e-5 * mass_norm(laplacian, reference[source])


@pytest.mark.parametrize("time", [1e-4, 1e-2, 1.0, 100.0])
@pytest.mark.parametrize("conductivity", ["curvature", "constant"])
def test_heat_is_conserved_to_rounding(conductivity, time):
    laplacian = AnisotropicLaplacian(cylinder(around=24, along=12), alpha=20.0, conductivity=conductivity)
    kernel = HeatFlow(laplacian).kernel(30, theta=1.1, time=time)
    assert_allclose(laplacian.mass @ kernel, 1, atol=1e-12)


def test_source_and_target_may_be_exchanged(laplacian, modes):
    flow, time = HeatFlow(laplacian), 30 / modes[0][300]
    there, back = flow.kernel(3, theta=THETA, time=time)[77], flow.kernel(77, theta=THETA, time=time)[3]
    assert abs(there - back) < 1e-5 * flow.kernel(3, theta=THETA, time=time).max()


def test_the_signature_is_the_kernel_at_its_source(laplacian, modes):
    thetas, times = [0.0, THETA, 2.0], np.geomspace(0.5, 500, 7) / modes[0][300]
    flow = HeatFlow(laplacian)
    signature = flow.autodiffusion(40, thetas=thetas, times=times)
    assert signature.shape == (3, 7)
    reference = [dense_kernel(modes, t)[40, 40] for t in times]
    assert_allclose(signature[1], reference, rtol=1e-5)
    assert_allclose(signature[2, 3], flow.kernel(40, theta=2.0, time=times[3])[40], rtol=1e-4)


def test_answers_do_not_depend_on_what_was_asked_before(laplacian, modes):
    times = np.geomspace(0.5, 500, 9) / modes[0][300]
    used = HeatFlow(laplacian)
    for source, theta, time in [(5, 0.1, times[0]), (9, 0.1, times[8]), (5, 2.0, times[4]), (5, THETA, times[5])]:
        used.kernel(source, theta=theta, time=time)
    fresh = HeatFlow(laplacian).kernel(5, theta=THETA, time=times[6])
    again = used.kernel(5, theta=THETA, time=times[6])
    assert mass_norm(laplacian, again - fresh) < 2e-5 * mass_norm(laplacian, fresh)


def test_heat_stays_on_its_piece():
    ball = sphere(2)
    n = ball.vertex_count
    two = TriangleMesh(np.vstack((ball.vertices, ball.vertices + 5)), np.vstack([ball.faces, ball.faces + n]))
    kernel = HeatFlow(AnisotropicLaplacian(two, alpha=1.0)).kernel(n + 1, theta=0.0, time=1e3)
    assert not kernel[:n].any()
    assert_allclose(kernel[n:], 1 / AnisotropicLaplacian(ball).mass.sum(), rtol=1e-9)


def test_three_vertices_are_enough():
    triangle = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    laplacian = AnisotropicLaplacian(triangle, alpha=2.0)
    generator = -0.1 * laplacian.stiffness(0.3).toarray() / laplacian.mass[:, None]
    kernel = HeatFlow(laplacian).kernel(1, theta=0.3, time=0.1)
    assert_allclose(kernel, (expm(generator) / laplacian.mass)[1], rtol=1e-6)


def test_vertices_without_mass_hold_no_heat():
    mesh = TriangleMesh(np.vstack([sphere(2).vertices, [9, 9, 9]]), sphere(2).faces)
    flow = HeatFlow(AnisotropicLaplacian(mesh, alpha=1.0))
    assert flow.kernel(0, theta=0.0, time=0.1)[-1] == 0
    with pytest.raises(ParameterError, match="source 162 belongs to no face with an area"):
        flow.kernel(162, theta=0.0, time=0.1)


@pytest.mark.parametrize(
    ("source", "options", "message"),
    [
        (642, {}, "source must be from 0 to 641, but it is 642"),
        (-1, {}, "source must be from 0 to 641, but it is -1"),
        (1.5, {}, r"source must be a vertex number, but it is 1\.5"),
        (0, {"time": 0.0}, r"time must be finite and greater than 0, but it is 0\.0"),
        (0, {"time": np.nan}, "time must be finite and greater than 0, but it is nan"),
        (0, {"theta": np.inf}, "theta must be finite, but it is inf"),
    ],
)
def test_bad_arguments_are_explained(laplacian, source, options, message):
    with pytest.raises(ParameterError, match=message):
        HeatFlow(laplacian).kernel(source, **{"theta": 0.0, "time": 0.1, **options})


class Enough(Exception):
    """Somebody who waited no longer does."""


def test_large_shapes_take_fronts_and_find_the_same(laplacian, modes, monkeypatch):
    monkeypatch.setattr(heat_factors, "MOST_SUPERLU", 0)
    told = []
    flow = HeatFlow(laplacian, progress=lambda done, total: told.append(done / total))
    kernel = flow.kernel(30, theta=THETA, time=0.02)
    exact = dense_kernel(modes, 0.02)[:, 30]
    assert mass_norm(laplacian, kernel - exact) < 1e-5 * mass_norm(laplacian, exact)
    stays = flow.autodiffusion(30, thetas=[THETA], times=[0.02])
    assert_allclose(stays, [[exact[30]]], rtol=1e-5)
    assert told[0] < 1
    assert max(told) > 0.5


@pytest.mark.parametrize("most", [0, 10**6])
def test_a_flow_whose_progress_raises_answers_the_next_time(laplacian, monkeypatch, most):
    monkeypatch.setattr(heat_factors, "MOST_SUPERLU", most)
    fresh = laplacian.with_alpha(7.0)
    patience = [0]

    def progress(done, total):
        patience[0] -= 1
        if patience[0] == -1:
            raise Enough

    flow = HeatFlow(fresh, progress=progress)
    with pytest.raises(Enough):
        flow.kernel(30, theta=THETA, time=0.02)
    expected = HeatFlow(fresh).kernel(30, theta=THETA, time=0.02)
    assert_allclose(flow.kernel(30, theta=THETA, time=0.02), expected, rtol=1e-9)


@pytest.mark.parametrize("time", [1e9, 1e60, 1e200])
def test_heat_that_has_long_been_even_stays_so(time):
    """Beside such a multiple of the stiffness the mass is lost to rounding, and the matrix is singular."""
    for seed in range(12):
        triangle = TriangleMesh(np.random.default_rng(seed).standard_normal((3, 3)), [[0, 1, 2]])
        flow = HeatFlow(AnisotropicLaplacian(triangle))
        assert_allclose(flow.kernel(0, theta=THETA, time=time), 1 / triangle.area, rtol=1e-9)
        assert_allclose(flow.autodiffusion(0, thetas=[THETA], times=[time]), 1 / triangle.area, rtol=1e-9)
