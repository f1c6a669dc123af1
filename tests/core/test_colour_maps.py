"""Colour maps of fields keep their promises."""

import numpy as np
import pytest

from add_core.drawing.colour_maps import coloured, distance_map, sequential_map, signed_map
from add_core.drawing.colours import SKIN, srgb_to_oklab
from add_core.drawing.position_colours import position_colours
from add_core.geometry import normalize
from add_core.io import humans


def test_maps_begin_or_meet_at_bare_skin_and_near_is_darker_than_the_middle():
    assert sequential_map()[0] == pytest.approx(SKIN, abs=0.01)
    assert signed_map(257)[128] == pytest.approx(SKIN, abs=0.01)
    lightness = srgb_to_oklab(distance_map(256))[:, 0]
    assert lightness[0] < lightness[-1] < lightness[128]
    assert (np.diff(srgb_to_oklab(sequential_map())[:, 0]) < 0).all()
    assert coloured(np.array([0.0, 2.0]), "distance") == pytest.approx(distance_map()[[0, -1]])


def test_place_colours_tell_both_sides_and_both_ends_of_a_body_apart():
    person = normalize(humans()[0])
    colours = srgb_to_oklab(position_colours(person.vertices))
    away = np.linalg.norm(colours - colours[humans().symmetry], axis=1)
    aside = np.abs(person.vertices[:, 0] - person.vertices[humans().symmetry, 0]) > 0.1
    assert away[aside].min() > 0.1
    top, bottom = np.argmax(person.vertices[:, 2]), np.argmin(person.vertices[:, 2])
    assert np.linalg.norm(colours[top] - colours[bottom]) > 0.15
