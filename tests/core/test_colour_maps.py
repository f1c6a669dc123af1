"""Colour maps of fields keep their promises."""

import numpy as np
import pytest

from add_core.drawing.colour_maps import coloured, distance_map, sequential_map, signed_map
from add_core.drawing.colours import SKIN, srgb_to_oklab


def test_maps_begin_or_meet_at_bare_skin_and_near_is_darker_than_the_middle():
    assert sequential_map()[0] == pytest.approx(SKIN, abs=0.01)
    assert signed_map(257)[128] == pytest.approx(SKIN, abs=0.01)
    lightness = srgb_to_oklab(distance_map(256))[:, 0]
    assert lightness[0] < lightness[-1] < lightness[128]
    assert (np.diff(srgb_to_oklab(sequential_map())[:, 0]) < 0).all()
    assert coloured(np.array([0.0, 2.0]), "distance") == pytest.approx(distance_map()[[0, -1]])
