"""Unit geodesic diameter, whatever the unit, place and kind of shape."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import GeometryError
from add_core.geometry import PointCloud, TriangleMesh, geodesic_diameter, normalize
from add_core.geometry.shapes import cylinder, rectangle, sphere


@pytest.mark.parametrize(
    ("shape", "diameter", "tolerance"),
    [
        (sphere(3), np.pi, 5e-3),
        (rectangle(1.0, 1.2, n=10), np.hypot(1.0, 1.2), 1e-12),
        (cylinder(radius=0.5, height=3.0), np.hypot(np.pi * 0.5, 3.0), 2e-3),
    ],
)
def test_the_diameter_is_the_known_one(shape, diameter, tolerance):
    assert geodesic_diameter(shape) == pytest.approx(diameter, rel=tolerance)


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("shape", [sphere(2), PointCloud(sphere(3).vertices)])
def test_a_normalised_shape_has_unit_diameter(shape, unit):
    scaled = replace(shape, **{"points" if isinstance(shape, PointCloud) else "vertices": unit * shape.vertices})
    result = normalize(scaled)
    assert type(result) is type(shape)
    assert geodesic_diameter(result) == pytest.approx(1.0, rel=1e-12)
    ratio = np.linalg.norm(result.vertices, axis=1)
    assert_allclose(ratio, 1 / np.pi, rtol=0.03)


def test_many_vertices_are_measured_along_edges():
    assert geodesic_diameter(rectangle(1.0, 1.2, n=140)) == pytest.approx(np.hypot(1.0, 1.2), rel=0.08)


def test_normalising_divides_every_vertex_and_changes_nothing_else():
    mesh = TriangleMesh(rectangle(3.0, 4.0, n=6).vertices + 10.0, rectangle(3.0, 4.0, n=6).faces, "sheet")
    result = normalize(mesh)
    assert_allclose(result.vertices, mesh.vertices / 5.0, rtol=1e-12)
    assert_array_equal(result.faces, mesh.faces)
    assert result.name == "sheet"


def test_normalising_a_cloud_keeps_its_normals():
    ball = sphere(2).vertices
    assert_allclose(normalize(PointCloud(5 * ball, ball)).normals, ball, atol=1e-15)


def test_the_diameter_survives_motion_and_order():
    mesh = cylinder(radius=0.5, height=3.0, around=24, along=12)
    rng = np.random.default_rng(0)
    order = rng.permutation(mesh.vertex_count)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    moved = TriangleMesh((mesh.vertices @ turn.T + 4.0)[order], np.argsort(order)[mesh.faces])
    assert geodesic_diameter(moved) == pytest.approx(geodesic_diameter(mesh), rel=2e-3)


def test_the_largest_of_several_components_counts():
    small, large = sphere(2), sphere(2, radius=3.0)
    both = TriangleMesh(np.vstack([small.vertices + 20, large.vertices]), np.vstack([small.faces, large.faces + 162]))
    assert geodesic_diameter(both) == pytest.approx(geodesic_diameter(large), rel=1e-12)


@pytest.mark.parametrize(
    "shape",
    [
        TriangleMesh(np.ones((3, 3)), [[0, 1, 2]], "dot"),
        PointCloud(np.ones((10, 3)), name="dot"),
        PointCloud(np.ones((1, 3)), name="dot"),
    ],
)
def test_a_shape_without_extent_is_refused(shape):
    with pytest.raises(GeometryError, match="the shape 'dot' has no extent"):
        normalize(shape)
