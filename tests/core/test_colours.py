"""Colours that carry meaning keep their promises."""

import numpy as np
import pytest

from add_core.drawing.colours import MARKERS, SKIN, kernel_map, oklab_to_srgb, srgb_to_oklab, theta_colour


def lightness(rgb):
    return srgb_to_oklab(rgb)[..., 0]


def test_no_heat_looks_like_bare_skin():
    assert kernel_map()[0] == pytest.approx(SKIN, abs=1e-6)


def test_more_heat_is_always_darker_and_never_black():
    falling = np.diff(lightness(kernel_map()))
    assert (falling < 0).all()
    assert falling.min() > 2.5 * falling.mean()  # even steps: no edge that the data has not
    assert lightness(kernel_map())[-1] > 0.2


def test_hues_of_angles_have_period_pi_and_tell_quarters_apart():
    angles = np.linspace(0, np.pi, 50)
    assert theta_colour(angles) == pytest.approx(theta_colour(angles + np.pi), abs=1e-9)
    quarters = srgb_to_oklab(theta_colour(np.radians([0, 45, 90, 135])))
    apart = np.linalg.norm(quarters[:, None] - quarters[None], axis=2)[np.triu_indices(4, 1)]
    assert apart.min() > 0.15


def test_eight_markers_are_told_apart():
    lab = srgb_to_oklab(MARKERS)
    apart = np.linalg.norm(lab[:, None] - lab[None], axis=2)[np.triu_indices(8, 1)]
    assert len(MARKERS) == 8
    assert apart.min() > 0.09


def test_oklab_goes_there_and_back():
    colours = np.random.default_rng(0).random((100, 3))
    assert oklab_to_srgb(srgb_to_oklab(colours)) == pytest.approx(colours, abs=1e-6)
