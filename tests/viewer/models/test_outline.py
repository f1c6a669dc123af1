"""The points by which cameras are placed reach as far as the shape, whichever way one looks."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from add_viewer.models.outline import outline_of


@pytest.mark.parametrize("thickness", [1.0, 0.3, 0.01, 0.0])
def test_a_few_points_reach_as_far_as_all_of_them(thickness):
    random = np.random.default_rng(0)
    places = random.normal(size=(60_000, 3)) * [1.0, 2.0, thickness]
    outline = outline_of(places)
    assert len(outline) < 5000
    for way in [*np.eye(3), *random.normal(size=(50, 3))]:
        reach, whole = (np.ptp(points @ way) for points in (outline, places))
        assert 0.97 * whole <= reach <= whole
    assert_array_equal(np.ptp(outline, axis=0), np.ptp(places, axis=0))


def test_all_points_of_a_small_shape_are_kept():
    places = np.random.default_rng(1).normal(size=(6890, 3))
    assert_array_equal(outline_of(places), places)
