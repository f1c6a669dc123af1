"""Curves read between their samples."""

import numpy as np
import pytest

from add_viewer.models.curve_reading import once_around, over_theta, over_time, read_backwards
from add_viewer.models.picks import Pick
from add_viewer.models.results import AutodiffusionCurves


@pytest.fixture
def curves() -> AutodiffusionCurves:
    thetas = np.pi * np.arange(4) / 4
    reaches = np.geomspace(0.01, 1.0, 5)
    values = (2.0 + np.cos(2 * thetas))[:, None] / reaches[None, :]
    return AutodiffusionCurves(Pick("a", 0, 0), thetas, reaches, values, weyl_eigenvalue=2.0, expected=4)


def test_a_power_of_time_is_read_exactly_at_any_time(curves):
    assert over_theta(curves, 0.0456) == pytest.approx((2 + np.cos(2 * curves.thetas)) / 0.0456)


def test_times_follow_from_reaches(curves):
    assert curves.times == pytest.approx(curves.reaches / 2.0)


@pytest.mark.parametrize("index", range(4))
@pytest.mark.parametrize("turns", [-1, 0, 1])
def test_computed_angles_are_read_exactly_with_period_pi(curves, index, turns):
    assert over_time(curves, curves.thetas[index] + turns * np.pi) == pytest.approx(curves.values[index])


def test_between_the_last_angle_and_the_first_the_curve_is_closed(curves):
    middle = over_time(curves, 0.5 * (curves.thetas[3] + np.pi))
    assert middle == pytest.approx(0.5 * (curves.values[3] + curves.values[0]))
    angles, values = once_around(curves, curves.values[:, 0])
    assert angles[-1] == pytest.approx(angles[0] + np.pi)
    assert values[-1] == values[0]


def test_a_curve_over_theta_is_drawn_smooth_through_what_was_computed():
    """Sixteen straight pieces would be off by 0.04, and have corners of 1.7."""

    def curve(theta):
        return 2 + np.sin(2 * theta) + 0.3 * np.cos(4 * theta + 1)

    thetas = np.pi * np.arange(16) / 16
    made = AutodiffusionCurves(Pick("a", 0, 0), thetas, np.ones(1), curve(thetas)[:, None], expected=16)
    angles, values = once_around(made, curve(thetas))
    assert values[:: len(angles) // 16] == pytest.approx(curve(np.append(thetas, np.pi)))
    assert np.abs(values - curve(angles)).max() < 0.004
    slopes = np.diff(values) / np.diff(angles)
    assert np.abs(np.diff(slopes, append=slopes[0])).max() < 0.3, "no corner, where it closes neither"


def test_while_few_angles_are_known_no_waves_are_invented(curves):
    few = AutodiffusionCurves(curves.pick, curves.thetas[:3], curves.reaches, curves.values[:3], expected=4)
    assert once_around(few, few.values[:, 0])[1] == pytest.approx(np.append(few.values[:, 0], few.values[0, 0]))


def test_a_mirror_curve_read_backwards_is_the_curve_itself():
    thetas = np.pi * np.arange(16) / 16
    curve = 2 + np.sin(2 * thetas) + 0.3 * np.cos(4 * thetas + 1)
    mirrored = 2 + np.sin(-2 * thetas) + 0.3 * np.cos(-4 * thetas + 1)
    assert read_backwards(thetas, mirrored) == pytest.approx(curve)
