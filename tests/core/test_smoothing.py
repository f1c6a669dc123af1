"""Values of vertices without what changes from each one to the next."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.descriptors import smoothed
from add_core.errors import ParameterError
from add_core.geometry import PointCloud, TriangleMesh
from add_core.geometry.shapes import ellipsoid, sphere
from add_core.operators import AnisotropicLaplacian


@pytest.fixture(scope="module", params=["mesh", "cloud"])
def shape(request):
    mesh = ellipsoid(1.0, 0.7, 0.5, subdivisions=3)
    return mesh if request.param == "mesh" else PointCloud(mesh.vertices)


@pytest.mark.parametrize("strength", [0.1, 3.0, 50.0, 1000.0])
def test_it_is_the_filter_of_its_formula(shape, strength):
    values = np.random.default_rng(0).normal(size=(shape.vertex_count, 3))
    stiffness = AnisotropicLaplacian(shape, alpha=0.0).stiffness().toarray()
    diagonal = np.diag(stiffness)
    expected = np.linalg.solve(
        np.diag(diagonal) + strength**2 * stiffness @ (stiffness / diagonal[:, None]), diagonal[:, None] * values
    )
    assert_allclose(smoothed(shape, values, strength=strength), expected, atol=1e-9)


def test_constants_stay_and_smooth_functions_nearly(shape):
    assert_allclose(smoothed(shape, np.full((shape.vertex_count, 2), 3.0)), 3.0, rtol=1e-9)
    x = shape.vertices[:, 0]
    assert np.abs(smoothed(shape, x) - x).max() < 0.05


def test_noise_of_single_vertices_goes():
    ball = sphere(4)
    noise = np.random.default_rng(1).normal(size=ball.vertex_count)
    assert smoothed(ball, noise).std() < 0.35 * noise.std()


def test_the_unit_of_length_and_the_order_of_vertices_are_nothing_to_it():
    ball = ellipsoid(1.0, 0.7, 0.5, subdivisions=2)
    values = np.random.default_rng(2).normal(size=(ball.vertex_count, 2, 70))
    expected = smoothed(ball, values)
    assert expected.shape == values.shape
    assert_allclose(smoothed(TriangleMesh(1e6 * ball.vertices, ball.faces), values), expected, atol=1e-8)
    order = np.random.default_rng(3).permutation(ball.vertex_count)
    place = np.argsort(order)
    assert_allclose(
        smoothed(TriangleMesh(ball.vertices[order], place[ball.faces]), values[order]), expected[order], atol=1e-8
    )


def test_a_vertex_of_no_face_keeps_its_value():
    ball = sphere(1)
    more = TriangleMesh(np.vstack([ball.vertices, [5.0, 5.0, 5.0]]), ball.faces)
    values = np.random.default_rng(4).normal(size=len(more.vertices))
    found = smoothed(more, values)
    assert_allclose(found[-1], values[-1])
    assert_allclose(found[:-1], smoothed(ball, values[:-1]), atol=1e-10)


def test_values_of_another_shape_are_refused():
    with pytest.raises(ParameterError, match="a row for each of the 42 vertices, but their shape is \\(41, 2\\)"):
        smoothed(sphere(1), np.zeros((41, 2)))
    for strength in (-1.0, 1e4):
        with pytest.raises(ParameterError, match="strength"):
            smoothed(sphere(1), np.zeros(42), strength=strength)


def test_what_it_is_given_is_left_as_it_was():
    values = np.arange(42.0)
    smoothed(sphere(1), values)
    assert_array_equal(values, np.arange(42.0))
