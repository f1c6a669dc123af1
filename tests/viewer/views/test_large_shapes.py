"""Large shapes turn as a coarse stand-in and rest as themselves."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from add_viewer.models import coarse

THIGH = 6868


@pytest.fixture
def large(monkeypatch, person):
    """A person that counts as large."""
    monkeypatch.setattr(coarse, "MOST_DRAWN", 5000)
    monkeypatch.setattr(coarse, "_WANTED", 2500)
    person.open()
    return person


def shown(person):
    body = person.canvas._body
    return [actor.GetMapper().GetInput().GetNumberOfPoints() for actor in body.actors if actor.GetVisibility()]


def test_a_large_shape_turns_as_its_stand_in_with_the_same_colours_and_rests_as_itself(large, qtbot):
    large.click(THIGH)
    large.wait_for_kernel()
    qtbot.waitUntil(lambda: shown(large) == [6890])
    start = QPoint(20, 20)
    qtbot.mousePress(large.canvas, Qt.MouseButton.LeftButton, pos=start)
    qtbot.mouseMove(large.canvas, start + QPoint(12, 0))
    assert shown(large)[0] < 3600
    moving = large.pixels()
    qtbot.mouseRelease(large.canvas, Qt.MouseButton.LeftButton, pos=start + QPoint(12, 0))
    qtbot.waitUntil(lambda: shown(large) == [6890])
    away = np.abs(large.pixels() - moving).max(axis=2)
    assert (away > 60).mean() < 0.02
    large.click(THIGH, Qt.KeyboardModifier.ShiftModifier)
    assert [pick.vertex for pick in large.session.state.picks] == [THIGH]


def test_a_picture_never_shows_the_stand_in(large):
    large.canvas.steer("rotate", (10.0, 0.0))
    large.canvas.picture(1.0, transparent=False)
    assert shown(large) == [6890]
