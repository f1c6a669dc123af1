"""Where a value lies on the colour bar, linear and logarithmic."""

import numpy as np
import pytest

from add_viewer.models.kernel_scale import KernelScale


def test_the_linear_scale_is_the_share_of_the_maximum():
    values = np.array([0.0, 1.0, 4.0])
    scale = KernelScale.of(values, "linear")
    assert scale.position(values) == pytest.approx([0, 0.25, 1])
    assert scale.ticks() == [(0.0, "0"), (0.5, "2"), (1.0, "4")]


def test_the_log_scale_spans_two_decades_and_says_so():
    values = np.array([-1e-9, 1.7, 17.0, 170.0])
    scale = KernelScale.of(values, "log")
    assert scale.position(values) == pytest.approx([0, 0, 0.5, 1])
    assert [label for _, label in scale.ticks()] == ["≤ 1.7", "17", "170"]
