"""Where numbers stand on sliders."""

import pytest

from add_viewer.models.scales import BrokenLine, Logarithm


@pytest.mark.parametrize("scale", [BrokenLine(10.0, 200.0), Logarithm(0.002, 5.0)])
def test_position_and_value_undo_each_other(scale):
    for step in range(11):
        assert scale.position(scale.value(step / 10)) == pytest.approx(step / 10, abs=1e-12)


def test_alpha_up_to_ten_takes_half_the_slider():
    assert BrokenLine(10.0, 200.0).position(10.0) == 0.5
    assert BrokenLine(10.0, 200.0).value(0.25) == 5.0


def test_equal_ratios_take_equal_room():
    scale = Logarithm(0.01, 1.0)
    assert scale.position(0.1) == pytest.approx(0.5)


@pytest.mark.parametrize("scale", [BrokenLine(10.0, 200.0), Logarithm(0.002, 5.0)])
def test_numbers_beyond_the_ends_stand_at_the_ends(scale):
    assert scale.position(-1.0) == 0.0
    assert scale.position(1e9) == 1.0
    assert scale.value(7.0) == pytest.approx(scale.value(1.0))
