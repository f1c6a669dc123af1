"""Delaunay tetrahedra against what defines them, and what clouds enclose against the surfaces they were taken from."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial import KDTree

from add_core.geometry import subsample
from add_core.geometry.enclosure import enclosure
from add_core.geometry.shapes import rectangle, sphere
from add_core.geometry.tetrahedra import Tetrahedra


def scattered(count=200, seed=0):
    return np.random.default_rng(seed).normal(size=(count, 3))


def test_balls_pass_through_their_corners_and_hold_no_point():
    found = Tetrahedra.between(scattered())
    assert found.solid.all()
    reach = np.linalg.norm(found.points[found.corners] - found.centres[:, None], axis=2)
    assert_allclose(reach, np.repeat(found.radii[:, None], 4, axis=1), rtol=1e-6)
    nearest = KDTree(found.points).query(found.centres)[0]
    assert (nearest > found.radii * (1 - 1e-6)).all()


def test_points_are_kept_up_to_their_middle_and_scale():
    points = 1e6 * scattered() + 1e7
    found = Tetrahedra.between(points)
    assert_allclose(found.points * found.scale, points - points.mean(axis=0), atol=1e-3)
    assert np.abs(found.points).max() == 1.0


def test_every_facet_is_there_once_and_turned_from_its_first_side_to_its_second():
    found = Tetrahedra.between(scattered(60))
    facets = found.facets
    assert len(np.unique(np.sort(facets.corners, axis=1), axis=0)) == len(facets.corners)
    hull = facets.sides[:, 1] < 0
    assert 2 * len(facets.corners) - np.count_nonzero(hull) == 4 * len(found.corners)
    middle = found.points[found.corners].mean(axis=1)
    on_facet = found.points[facets.corners[:, 0]]
    assert (np.einsum("fi,fi->f", facets.upright, on_facet - middle[facets.sides[:, 0]]) > 0).all()
    beyond = middle[facets.sides[~hull, 1]] - on_facet[~hull]
    assert (np.einsum("fi,fi->f", facets.upright[~hull], beyond) > 0).all()


def test_angles_areas_and_circles_of_a_facet():
    """A right angle with legs 3 and 4 in the hull of a pyramid: the circle's diameter is the long side."""
    points = np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 0], [0.5, 0.5, 2], [1, 1, 9]])
    found = Tetrahedra.between(points)
    base = np.flatnonzero((np.sort(found.facets.corners, axis=1) == [0, 1, 2]).all(axis=1))
    assert len(base) == 1
    assert_allclose(found.facets.radii[base] * found.scale, 2.5)
    assert_allclose(found.facets.areas[base] * found.scale**2, 6.0)
    order = np.argsort(found.facets.corners[base[0]])
    assert_allclose(found.facets.angles[base[0], order], [np.pi / 2, np.arctan(4 / 3), np.arctan(3 / 4)])


def test_a_facet_of_points_on_a_sphere_sinks_below_its_skin_as_far_as_its_plane_from_the_middle():
    points = scattered(80)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    facets = Tetrahedra.between(np.vstack([points, -points])).facets
    hull = facets.sides[:, 1] < 0
    corner = np.vstack([points, -points])[facets.corners[hull, 0]]
    assert_allclose(facets.sinking[hull, 0], np.einsum("fi,fi->f", facets.upright[hull], corner), atol=1e-5)
    assert_allclose(facets.sinking[~hull].sum(axis=1), 0, atol=1e-4)  # all share one ball


def test_around_a_point_inside_the_tetrahedra_leave_no_direction_out():
    points = np.vstack([[[0.0, 0, 0]], sphere(1).vertices])
    found = Tetrahedra.between(points)
    assert found.shares[found.corners == 0].sum() == pytest.approx(1.0)
    found = Tetrahedra.between(np.vstack([points[1:], [[0.3, 0.1, 5.0]]]))
    tip = found.shares[found.corners == 42].sum()
    assert 0 < tip < (1 - np.cos(np.arcsin(1 / 4.9))) / 2  # less than the cone around the ball below


@pytest.mark.parametrize("points", [rectangle(n=4).vertices, scattered(4), np.outer(np.arange(9.0), [1, 2, 3])])
def test_points_in_a_plane_or_too_few_have_no_tetrahedra(points):
    assert Tetrahedra.between(points) is None


def test_the_border_of_what_a_ball_encloses_is_its_hull():
    points = scattered(900)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    border = enclosure(Tetrahedra.between(points))
    assert len(border.facets) == 2 * 900 - 4  # Euler
    assert np.einsum("ni,ni->n", border.normals, points).min() > 0.9


def test_the_hole_of_a_ring_is_outside():
    around, through = np.random.default_rng(0).uniform(0, 2 * np.pi, (2, 1500))
    out = np.stack([np.cos(through) * np.cos(around), np.cos(through) * np.sin(around), np.sin(through)], axis=1)
    points = 0.4 * out + np.stack([np.cos(around), np.sin(around), 0 * around], axis=1)
    tetrahedra = Tetrahedra.between(points)
    border = enclosure(tetrahedra)
    assert np.mean(np.einsum("ni,ni->n", border.normals, out) > 0.9) > 0.98
    assert border.areas.sum() * tetrahedra.scale**2 == pytest.approx(4 * np.pi**2 * 0.4, rel=0.03)


def test_points_may_be_off_the_surface_by_a_fifth_of_their_distance():
    shape = subsample(sphere(5), 1500).cloud
    points = shape.points + 0.2 * 0.08 * np.random.default_rng(0).normal(size=(1500, 3))
    border = enclosure(Tetrahedra.between(points))
    assert np.mean(np.einsum("ni,ni->n", border.normals, shape.normals) > 0.8) > 0.95
