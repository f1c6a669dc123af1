"""Distances of pairs against straight lines, great circles and exact geodesics."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ParameterError
from add_core.geometry import PointCloud, TriangleMesh, geodesic_distances
from add_core.geometry.pair_distances import PairDistances
from add_core.geometry.shapes import rectangle, sphere


def some_rows(shape, step=1):
    """Distances from every `step`-th vertex to all."""
    n = shape.vertex_count
    first = np.arange(0, n, step)
    return PairDistances(shape)(np.repeat(first, n), np.tile(np.arange(n), len(first))).reshape(-1, n)


def test_on_a_sphere_they_are_great_circles():
    ball = sphere(3)
    circles = np.arccos(np.clip(ball.vertices[::16] @ ball.vertices.T, -1, 1))
    measured = some_rows(ball, 16)
    apart = circles > 0.2
    ratio = measured[apart] / circles[apart]
    assert ratio.min() > 0.95
    assert ratio.max() < 1.08
    assert ratio.mean() == pytest.approx(1.0, abs=0.03)
    assert_array_equal(np.diag(measured[:, ::16]), 0.0)


def test_a_crossing_is_the_straight_line_over_an_edge():
    """Two faces folded along an edge: unfolded, the way between the outer corners is straight."""
    bent = TriangleMesh([[0, 0, 0], [0, 1, 0], [1, 0.5, 0], [0, 0.5, 1]], [[0, 2, 1], [0, 1, 3]])
    assert_allclose(PairDistances(bent)([2, 0], [3, 3]), [2.0, np.sqrt(1.25)], rtol=1e-12)


def test_they_are_close_to_exact_geodesics_and_symmetric():
    sheet = rectangle(2.0, 1.0, n=14)
    measured, exact = some_rows(sheet, 5), geodesic_distances(sheet, np.arange(0, sheet.vertex_count, 5))
    assert_allclose(measured, exact, rtol=0.09, atol=1e-12)
    assert_allclose(measured[:, ::5], measured[:, ::5].T, rtol=0.05)


def test_no_way_leads_to_another_component():
    one = rectangle(n=3)
    away = one.vertices + np.array([9.0, 0.0, 0.0])
    two = TriangleMesh(np.vstack([one.vertices, away]), np.vstack([one.faces, one.faces + one.vertex_count]))
    half = two.vertex_count // 2
    measured = some_rows(two)
    assert np.isinf(measured[:half, half:]).all()
    assert np.isfinite(measured[:half, :half]).all()


def test_a_cloud_is_measured_along_chords():
    points = rectangle(1.0, 1.0, n=20).vertices
    measured = some_rows(PointCloud(points), 9)
    assert_allclose(measured, np.linalg.norm(points[::9, None] - points[None], axis=2), rtol=0.07, atol=1e-12)


def test_pairs_are_checked():
    with pytest.raises(ParameterError, match="second must be from 0 to 11, but it ranges from 12 to 12"):
        PairDistances(sphere(0))([0], [12])
    with pytest.raises(ParameterError, match=r"second must have shape \(2,\), but it has \(1,\)"):
        PairDistances(sphere(0))([0, 1], [1])
    assert len(PairDistances(sphere(0))(np.zeros(0, dtype=int), np.zeros(0, dtype=int))) == 0
