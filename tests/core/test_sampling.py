"""Farthest points against the definition, and what a subsample carries along."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.distance import cdist

from add_core.errors import ParameterError
from add_core.geometry import PointCloud, TriangleMesh, farthest_points, subsample
from add_core.geometry.shapes import rectangle, sphere


def test_each_point_is_the_farthest_from_all_before():
    shape = PointCloud(np.random.default_rng(0).normal(size=(300, 3)))
    chosen = farthest_points(shape, 40, 7)
    assert chosen[0] == 7
    apart = cdist(shape.points, shape.points)
    for k in range(1, 40):
        reach = apart[chosen[:k]].min(axis=0)
        assert reach[chosen[k]] == pytest.approx(reach.max(), rel=1e-12)


def test_a_smaller_sample_is_a_prefix_of_a_larger_one():
    shape = sphere(3)
    assert_array_equal(farthest_points(shape, 20), farthest_points(shape, 100)[:20])


@pytest.mark.parametrize("unit", [1e-6, 1e6, 1e-55])
def test_the_choice_does_not_depend_on_the_unit_of_length(unit):
    points = np.random.default_rng(1).normal(size=(200, 3))
    assert_array_equal(farthest_points(PointCloud(points), 50), farthest_points(PointCloud(unit * points), 50))


def test_all_vertices_can_be_chosen_once_each_even_where_they_coincide():
    points = np.repeat(np.random.default_rng(2).normal(size=(20, 3)), 3, axis=0)
    chosen = farthest_points(PointCloud(points), 60)
    assert_array_equal(np.sort(chosen), np.arange(60))
    assert len(np.unique(points[chosen[:20]], axis=0)) == 20


def test_all_points_in_one_place_are_taken_in_order():
    assert_array_equal(farthest_points(PointCloud(np.ones((4, 3))), 4), [0, 1, 2, 3])


def test_vertices_without_faces_are_never_chosen():
    ball = sphere(1)
    mesh = TriangleMesh(np.vstack([ball.vertices, [[9.0, 0, 0]]]), ball.faces)
    assert 42 not in farthest_points(mesh, 42)
    with pytest.raises(ParameterError, match="count must be from 1 to 42, but it is 43"):
        farthest_points(mesh, 43)
    first = TriangleMesh(np.vstack([[[9.0, 9, 9]], sphere(1).vertices]), sphere(1).faces + 1)
    assert farthest_points(first, 3)[0] == 1
    assert 0 not in subsample(first, 42).indices
    with pytest.raises(ParameterError, match="start must be a vertex of some face, but no face uses 42"):
        farthest_points(mesh, 3, 42)


def test_a_subsample_carries_normals_numbers_and_name():
    ball = TriangleMesh(sphere(3).vertices, sphere(3).faces, "ball")
    sample = subsample(ball, 100, start=5)
    assert sample.indices[0] == 5
    assert sample.cloud.name == "ball"
    assert_array_equal(sample.cloud.points, ball.vertices[sample.indices])
    assert_allclose(sample.cloud.normals, ball.vertices[sample.indices], atol=0.02)


def test_a_subsample_of_a_cloud_keeps_what_the_cloud_has():
    points = rectangle(n=6).vertices
    assert subsample(PointCloud(points), 9).cloud.normals is None
    with_normals = PointCloud(points, np.full_like(points, 2.0))
    assert_allclose(subsample(with_normals, 9).cloud.normals, np.full((9, 3), 3**-0.5), rtol=1e-12)


def test_a_subsample_with_a_vertex_that_has_no_normal_has_none():
    mesh = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 0, 0], [6, 0, 0], [7, 0, 0]], [[0, 1, 2], [3, 4, 5]])
    assert subsample(mesh, 6).cloud.normals is None
