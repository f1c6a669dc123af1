"""Fans against a Delaunay triangulation of the whole plane, and the area that they add up to."""

import logging

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial import Delaunay

from add_core.geometry import PointCloud, subsample
from add_core.geometry.arcs import arc_edges
from add_core.geometry.delaunay_stars import WIDEST_ANGLE, delaunay_stars
from add_core.geometry.shapes import cylinder, rectangle, sphere, torus

UP = np.array([0.0, 0.0, 1.0])


def flat_cloud(points):
    return PointCloud(points, np.tile(UP, (len(points), 1)))


def jittered(n, seed=0):
    grid = rectangle(n=n).vertices.copy()
    grid[:, :2] += np.random.default_rng(seed).uniform(-0.3, 0.3, (len(grid), 2)) / n
    return grid


def sorted_rows(triangles):
    return set(map(tuple, np.sort(triangles, axis=1)))


def widest_angle(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    sides = [(b - a, c - a), (a - b, c - b), (a - c, b - c)]
    cosines = [np.einsum("ti,ti->t", u, v) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1) for u, v in sides]
    return np.arccos(np.min(cosines, axis=0))


def test_a_star_is_what_delaunay_finds_around_the_point():
    rng = np.random.default_rng(5)
    plane = rng.normal(size=(200, 14, 2))
    stars = delaunay_stars(plane, np.ones((200, 14), dtype=bool), np.zeros((200, 14)))
    for row in range(200):
        points = np.vstack([[0.0, 0.0], plane[row]])
        whole = Delaunay(points).simplices
        expected = whole[(whole == 0).any(axis=1) & (widest_angle(points, whole) < WIDEST_ANGLE)]
        found = stars[stars[:, 0] == row, 1:] + 1
        assert sorted_rows(np.column_stack([np.zeros(len(found), dtype=int), found])) == sorted_rows(expected)


def test_stars_run_counter_clockwise():
    plane = np.random.default_rng(6).normal(size=(50, 10, 2))
    row, first, second = delaunay_stars(plane, np.ones((50, 10), dtype=bool), np.zeros((50, 10))).T
    a, b = plane[row, first], plane[row, second]
    assert (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0).all()


def test_neighbours_that_are_not_usable_are_as_if_they_were_not_there():
    plane = np.random.default_rng(7).normal(size=(1, 12, 2))
    usable = np.arange(12)[None] % 2 == 0
    some = delaunay_stars(plane, usable, np.zeros((1, 12)))
    alone = delaunay_stars(plane[:, ::2], np.ones((1, 6), dtype=bool), np.zeros((1, 6)))
    assert_array_equal(some[:, 1:], 2 * alone[:, 1:])


@pytest.mark.parametrize("direction", [0.0, 0.7, np.pi])
def test_points_on_a_line_have_no_star(direction):
    along = np.array([-2.0, -1.0, 1.0, 3.0])
    plane = along[None, :, None] * np.array([np.cos(direction), np.sin(direction)])
    assert len(delaunay_stars(plane, np.ones((1, 4), dtype=bool), np.zeros((1, 4)))) == 0


def test_fans_of_a_flat_cloud_are_its_delaunay_triangulation():
    points = jittered(12)
    fans = flat_cloud(points).fans
    whole = Delaunay(points[:, :2]).simplices
    expected = whole[widest_angle(points, whole) < WIDEST_ANGLE]
    inner = (np.abs(points[:, :2] - 0.5) < 0.35).all(
        axis=1
    )  # far from the hull, whose long edges reach past 20 neighbours
    assert sorted_rows(fans.triangles[inner[fans.triangles].all(axis=1)]) == sorted_rows(
        expected[inner[expected].all(axis=1)]
    )
    assert len(fans.isolated) == 0


def test_each_corner_of_a_triangle_holds_it_and_the_three_make_up_one():
    fans = flat_cloud(jittered(12)).fans
    _, counts = np.unique(np.sort(fans.triangles, axis=1), axis=0, return_counts=True)
    assert np.mean(counts == 3) > 0.98
    assert_allclose(np.median(fans.weights), 1 / 3)


@pytest.mark.parametrize("n", [4, 9])
def test_a_grid_is_covered_exactly_once_although_its_points_lie_on_common_circles(n):
    cloud = flat_cloud(rectangle(2.0, 1.0, n=n).vertices)
    assert cloud.area == pytest.approx(2.0, rel=1e-12)
    assert_allclose(cloud.fans.weights, 1 / 3)


@pytest.mark.parametrize(
    ("shape", "area", "tolerance"),
    [
        (sphere(4), 4 * np.pi, 1e-3),
        (cylinder(radius=0.5, height=2.0), 2 * np.pi, 2e-3),
        (torus(around=120, through=48), 4 * np.pi**2 * 0.4, 1e-2),
    ],
)
def test_fans_cover_curved_surfaces_once(shape, area, tolerance):
    assert PointCloud(shape.vertices, shape.vertex_normals).area == pytest.approx(area, rel=tolerance)
    assert subsample(shape, 1200).cloud.area == pytest.approx(area, rel=0.015)


def test_fans_turn_counter_clockwise_about_the_outward_normal():
    cloud = subsample(sphere(4), 800).cloud
    a, b, c = (cloud.points[cloud.fans.triangles[:, i]] for i in range(3))
    assert (np.einsum("ti,ti->t", np.cross(b - a, c - a), a) > 0).all()


def test_no_triangle_spans_the_gap_between_two_sheets():
    sheet = rectangle(n=12).vertices
    points = np.vstack([sheet, sheet + np.array([0, 0, 0.05])])  # the gap is narrower than the distance between points
    normals = np.repeat([[0, 0, -1.0], [0, 0, 1.0]], len(sheet), axis=0)
    triangles = PointCloud(points, normals).fans.triangles
    assert len(np.unique(triangles // len(sheet), axis=1)) == len(triangles)
    assert (triangles // len(sheet) == triangles[:, :1] // len(sheet)).all()


@pytest.mark.parametrize("away", [3.0, 50.0])
def test_an_outlier_is_reported_and_touched_by_nothing(caplog, away):
    points = np.vstack([sphere(2).vertices, [[away, 0, 0]]])
    with caplog.at_level(logging.WARNING, logger="add_core"):
        fans = PointCloud(points).fans
    assert_array_equal(fans.isolated, [162])
    assert "1 of 163 points touch no triangle (first: 162)" in caplog.text


def test_a_cloud_without_triangles_leaves_complaints_to_whoever_needs_them(caplog):
    """A warning beside the error about its missing area would be a second line for one mistake."""
    with caplog.at_level(logging.WARNING, logger="add_core"):
        assert_array_equal(PointCloud(np.eye(3)[:2]).fans.isolated, [0, 1])
    assert not caplog.text


def test_points_in_one_place_share_one_fan():
    grid = rectangle(n=6).vertices
    cloud = flat_cloud(np.vstack([grid, grid[10:13], grid[10:11]]))
    assert cloud.area == pytest.approx(1.0, rel=1e-12)
    assert len(cloud.fans.isolated) == 0
    share = np.bincount(cloud.fans.triangles.ravel(), np.repeat(cloud.fans.weights * cloud.fans.areas, 3))
    alone = flat_cloud(grid).fans
    expected = np.bincount(alone.triangles.ravel(), np.repeat(alone.weights * alone.areas, 3))
    assert share[10] + share[49] + share[52] == pytest.approx(expected[10], rel=1e-9)


def test_arcs_of_a_sphere_are_as_long_as_great_circles():
    ball = sphere(2)
    lengths = np.linalg.norm(arc_edges(ball.vertices, ball.vertices, ball.faces), axis=2)
    chords = np.linalg.norm(ball.opposite_edges, axis=2)
    assert_allclose(lengths, 2 * np.arcsin(chords / 2), rtol=1e-12)


def test_arcs_of_a_flat_cloud_are_its_chords_exactly():
    mesh = rectangle(n=5)
    assert_array_equal(arc_edges(mesh.vertices, np.tile(UP, (36, 1)), mesh.faces), mesh.opposite_edges)
