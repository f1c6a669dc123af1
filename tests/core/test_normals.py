"""Estimated normals of clouds whose normals are known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.geometry import PointCloud, subsample
from add_core.geometry.enclosure import enclosure
from add_core.geometry.normals import estimate_normals, reflected_cosines
from add_core.geometry.shapes import cylinder, ellipsoid, rectangle, sphere, torus
from add_core.geometry.tetrahedra import Tetrahedra


def normals_of(points):
    return estimate_normals(points).normals


def random_rotation(seed):
    q = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return q * np.linalg.det(q)


@pytest.mark.parametrize("shape", [sphere(4), ellipsoid(1.0, 0.6, 0.3), torus(), cylinder(radius=0.4, height=3.0)])
def test_normals_point_outward_everywhere(shape):
    normals = PointCloud(shape.vertices).outward_normals
    assert np.einsum("ni,ni->n", normals, shape.vertex_normals).min() > 0.95


def test_normals_of_a_sphere_are_its_radii():
    points = subsample(sphere(5), 1500).cloud.points
    angle = np.arccos(np.einsum("ni,ni->n", normals_of(points), points))
    assert np.degrees(np.median(angle)) < 1.0
    assert np.degrees(angle.max()) < 6.0


def test_normals_of_a_plane_are_all_the_same_and_exact():
    points = rectangle(n=8).vertices @ random_rotation(3).T
    normals = normals_of(points)
    assert_allclose(np.abs(normals @ (random_rotation(3) @ [0, 0, 1])), 1.0, atol=1e-12)
    assert_allclose(normals @ normals[0], 1.0, atol=1e-12)


def test_every_piece_is_turned_outward_on_its_own():
    ball = sphere(3).vertices
    normals = normals_of(np.vstack([ball, ball * 0.5 + [4.0, 0, 0], ball + np.array([0, 9.0, 0])]))
    assert np.einsum("ni,ni->n", normals, np.vstack([ball] * 3)).min() > 0.9


def test_two_walls_that_face_each_other_point_at_each_other():
    """Two balls a little apart: the propagation must turn round on its way across the gap."""
    ball = sphere(3).vertices
    normals = normals_of(np.vstack([ball, ball + np.array([2.3, 0, 0])]))
    assert np.einsum("ni,ni->n", normals, np.vstack([ball, ball])).min() > 0.9


def pressed_together(gap):
    """Two lenses above each other, nearer than their points are apart, and the normals of both."""
    lens = ellipsoid(1.0, 1.0, 0.6)
    above = lens.vertices + np.array([0, 0, 2 * 0.6 + gap])
    return np.vstack([lens.vertices, above]), np.vstack([lens.vertex_normals] * 2)


@pytest.mark.parametrize("gap", [0.01, 0.02, 0.04])
def test_bodies_pressed_together_keep_normals_of_their_own(gap):
    """Planes fitted across the gap turn one of them inside out as a whole."""
    points, expected = pressed_together(gap)
    cosine = np.einsum("ni,ni->n", normals_of(points), expected)
    assert cosine.min() > 0.5
    assert np.mean(cosine > 0.95) > 0.98


def test_edges_across_the_gap_between_two_bodies_are_off_their_surface():
    lens = ellipsoid(1.0, 1.0, 0.6)
    points, _ = pressed_together(0.02)
    found = estimate_normals(points)
    assert found.enclosed.all()
    own = lens.faces[:, [1, 0]]
    assert found.off_surface(own).mean() < 0.02
    assert_array_equal(found.off_surface(own[:, ::-1]), found.off_surface(own))
    across = np.stack([own[:, 0], own[:, 1] + len(lens.vertices)], axis=1)
    assert found.off_surface(across).all()


def test_nothing_is_off_the_surface_where_nothing_is_enclosed():
    found = estimate_normals(rectangle(n=8).vertices)
    assert not found.enclosed.any()
    assert not found.off_surface(np.array([[0, 80], [3, 1]])).any()


def test_a_body_of_rings_is_one_body():
    """Sixteen points all around and the next ring farther away: every ball lies in one ring, as its plane does."""
    z, angle = np.linspace(-0.99, 0.99, 25), np.linspace(0, 2 * np.pi, 16, endpoint=False)
    wide = 0.1 * np.sqrt(1 - z**2)[:, None]
    points = np.stack([wide * np.cos(angle), wide * np.sin(angle), np.repeat(z[:, None], 16, axis=1)], axis=2)
    points = points.reshape(-1, 3)
    expected = points / np.array([0.1, 0.1, 1.0]) ** 2
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    cosine = np.einsum("ni,ni->n", normals_of(points), expected)
    assert np.mean(cosine > 0.9) > 0.97  # but for the tips


def test_where_sheets_touch_planes_are_still_fitted_against_noise():
    points, expected = pressed_together(0.02)
    points += 0.1 * 0.066 * np.random.default_rng(0).normal(size=points.shape)
    found = normals_of(points)
    raw = enclosure(Tetrahedra.between(points)).normals
    off, off_raw = (np.degrees(np.median(np.arccos(np.einsum("ni,ni->n", n, expected)))) for n in (found, raw))
    assert off < 0.75 * off_raw


@pytest.mark.parametrize("seed", [0, 1])
def test_a_rough_sheet_with_a_border_encloses_nothing_and_keeps_to_one_side(seed):
    sheet = rectangle(n=24).vertices
    points = sheet + 0.3 / 24 * np.random.default_rng(seed).normal(size=sheet.shape)
    up = normals_of(points)[:, 2]
    assert (np.sign(up.sum()) * up).min() > 0.5


@pytest.mark.parametrize("unit", [1e-6, 1e6])
def test_normals_follow_rigid_motion_and_ignore_the_unit(unit):
    points = subsample(torus(), 700).cloud.points
    turn = random_rotation(1)
    moved = unit * (points @ turn.T + [1.0, -2.0, 3.0])
    assert_allclose(normals_of(moved), normals_of(points) @ turn.T, atol=1e-6)


def test_normals_do_not_depend_on_the_order_of_the_points():
    points = subsample(torus(), 700).cloud.points
    order = np.random.default_rng(2).permutation(700)
    assert_allclose(normals_of(points[order]), normals_of(points)[order], atol=1e-9)


def test_normals_that_are_given_are_kept():
    ball = sphere(2).vertices
    assert_allclose(PointCloud(ball, -3 * ball).outward_normals, -ball, atol=1e-15)


def test_points_in_one_place_have_one_normal():
    ball = sphere(2).vertices
    normals = PointCloud(np.vstack([ball, ball[:40]])).outward_normals
    assert_allclose(normals[162:], normals[:40])
    assert np.einsum("ni,ni->n", normals[:162], ball).min() > 0.95


@pytest.mark.parametrize("count", [1, 2, 3, 10])
def test_few_points_have_unit_normals(count):
    points = np.random.default_rng(0).normal(size=(count, 3))
    assert_allclose(np.linalg.norm(normals_of(points), axis=1), 1.0)


def test_normals_of_one_circle_agree_after_reflection_however_far_apart():
    angle = np.linspace(0.1, 6.0, 25)
    normals = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    chord = normals[1:] - normals[0]
    chord /= np.linalg.norm(chord, axis=1, keepdims=True)
    here = np.broadcast_to(normals[0], chord.shape)
    assert_allclose(reflected_cosines(chord, here, normals[1:]), 1.0, atol=1e-12)
    assert_allclose(reflected_cosines(chord, here, -normals[1:]), -1.0, atol=1e-12)
