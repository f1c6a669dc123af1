"""Colours go where the correspondence says, raw and smooth, with errors where the truth is known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.sparse import csr_array

from add_core.correspondence import FunctionalMap, coordinate_colors, transfer_colors
from add_core.errors import ParameterError
from add_core.geometry import PointCloud, geodesic_distances
from add_core.geometry.shapes import ellipsoid
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import compute_spectrum

SHAPE = ellipsoid(1.0, 0.8, 0.6, subdivisions=2)
N = SHAPE.vertex_count
MATCH = np.random.default_rng(0).integers(0, N, 50)


def test_raw_colours_are_those_of_the_matched_points():
    colors = np.random.default_rng(1).random((N, 3))
    carried = transfer_colors(SHAPE, MATCH, colors=colors)
    assert_array_equal(carried.raw, colors[MATCH])
    assert_array_equal(carried.smooth, carried.raw)
    assert_array_equal(carried.match_21, MATCH)
    assert carried.error is None


def test_a_scalar_field_keeps_one_column():
    assert transfer_colors(SHAPE, MATCH, colors=np.arange(N)).raw.shape == (50, 1)


def test_soft_matches_mix_colours_and_stand_for_the_largest_share():
    soft = np.zeros((2, N))
    soft[0, [3, 7]] = 0.25, 0.75
    soft[1, 5] = 1.0
    for shares in (soft, csr_array(soft)):
        carried = transfer_colors(SHAPE, shares, colors=np.arange(float(N)))
        assert_allclose(carried.raw[:, 0], [6.0, 5.0])
        assert_array_equal(carried.match_21, [7, 5])


def test_smooth_colours_lack_the_noise_of_raw_ones_but_stay_within_range():
    spectrum = compute_spectrum(AnisotropicLaplacian(SHAPE, alpha=0.0), count=40)
    noisy = np.arange(N)
    noisy[::5] = np.random.default_rng(2).integers(0, N, len(noisy[::5]))
    colors = coordinate_colors(SHAPE)
    carried = transfer_colors(
        SHAPE, noisy, colors=colors, smooth_map=FunctionalMap.from_matches(spectrum, spectrum, np.arange(N), count=40)
    )
    assert np.abs(carried.smooth - colors).mean() < 0.2 * np.abs(carried.raw - colors).mean()
    assert carried.smooth.min() >= 0.0
    assert carried.smooth.max() <= 1.0
    direct = transfer_colors(SHAPE, FunctionalMap.from_matches(spectrum, spectrum, np.arange(N), count=40))
    assert_array_equal(direct.smooth, carried.smooth)
    assert_array_equal(direct.match_21, np.arange(N))


def test_errors_are_geodesic_and_unknown_without_truth():
    truth = np.where(np.arange(50) % 4 == 0, -1, MATCH[::-1])
    error = transfer_colors(SHAPE, MATCH, truth=truth).error
    assert np.isnan(error[::4]).all()
    known = truth >= 0
    exact = geodesic_distances(SHAPE, truth[known])[np.arange(known.sum()), MATCH[known]]
    assert_allclose(error[known], exact, rtol=0.12, atol=1e-12)


def test_coordinate_colours_fill_their_range_and_turn_with_the_shape():
    colors = coordinate_colors(SHAPE)
    assert_allclose(colors.min(axis=0), 0.0)
    assert_allclose(colors.max(axis=0), 1.0)
    lopsided = SHAPE.vertices + 0.2 * SHAPE.vertices**2
    turn = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    turned = coordinate_colors(PointCloud(lopsided @ turn.T + 3.0))
    assert_allclose(turned, coordinate_colors(PointCloud(lopsided)), atol=1e-9)


def test_bad_arguments_are_named():
    with pytest.raises(ParameterError, match=f"colors must have {N} rows like the source, but it has 3"):
        transfer_colors(SHAPE, MATCH, colors=np.ones((3, 3)))
    with pytest.raises(ParameterError, match="match_21 must be from 0"):
        transfer_colors(SHAPE, [N])
    with pytest.raises(ParameterError, match=r"truth must have shape \(50,\), but it has \(2,\)"):
        transfer_colors(SHAPE, MATCH, truth=[0, 1])
