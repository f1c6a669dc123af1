"""Animations: recorded between the window's other work, and leaving everything as it was."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PySide6.QtCore import Qt

from add_viewer.views.animation import AnimationChoice
from add_viewer.views.animation_export import AnimationDialog


@pytest.fixture
def heated(person, make_torus, qtbot):
    """A torus with heat on it."""
    person.session.add_shape(make_torus())
    person.session.pick(3)
    qtbot.waitUntil(lambda: person.window.view.field is not None, timeout=90000)
    return person


def record(person, qtbot, path: Path, choice: AnimationChoice) -> list[np.ndarray]:
    """Its pictures, once the file is there."""
    person.assembly.animations.record(path, choice)
    assert person.assembly.animations.bar.isVisible()
    qtbot.waitUntil(path.exists, timeout=90000)
    qtbot.waitUntil(lambda: not person.assembly.animations.bar.isVisible())
    with Image.open(path) as gif:
        pictures = []
        for number in range(gif.n_frames):
            gif.seek(number)
            pictures.append(np.asarray(gif.convert("RGB"), dtype=int))
    return pictures


def differences(pictures: list[np.ndarray]) -> list[float]:
    return [np.abs(one - two).mean() for one, two in pairwise(pictures)]


def test_a_turntable_shows_all_sides_and_turns_nothing_in_the_window(heated, qtbot, tmp_path):
    before = heated.assembly.session_files.cameras()
    pictures = record(heated, qtbot, tmp_path / "turn.gif", AnimationChoice("turntable", 240, 0.8, 10))
    assert len(pictures) == 8
    assert pictures[0].shape[1] == 240
    assert min(differences(pictures)) > 0.5
    assert heated.assembly.session_files.cameras() == before
    edges = np.stack([np.concatenate([each[0], each[-1]]) for each in pictures])
    assert np.ptp(edges, axis=(0, 1)).max() < 40, "nothing is cut at any angle"


def test_a_sweep_shows_every_angle_and_leaves_no_trace(heated, qtbot, tmp_path):
    session = heated.session
    session.diffuse(theta=0.3)
    state, past = session.state, list(session._past)
    pictures = record(heated, qtbot, tmp_path / "sweep.gif", AnimationChoice("theta", 240, 0.6, 10))
    assert len(pictures) == 6
    assert min(differences(pictures)) > 0.05
    assert session.state == state
    assert session._past == past


def test_time_goes_there_and_back(heated, qtbot, tmp_path):
    pictures = record(heated, qtbot, tmp_path / "time.gif", AnimationChoice("time", 200, 0.8, 10))
    assert len(pictures) == 8
    np.testing.assert_array_equal(pictures[1], pictures[7])
    assert np.abs(pictures[0] - pictures[4]).mean() > 0.5


def test_nothing_is_recorded_for_a_folder_that_cannot_be_written_to(heated, tmp_path):
    heated.assembly.animations.record(tmp_path / "none" / "turn.gif", AnimationChoice("turntable", 240, 0.8, 10))
    assert not heated.assembly.animations.bar.isVisible()
    assert "turn.gif was not saved" in heated.window.message.text.text()


def test_cancel_leaves_no_file_and_everything_as_it_was(heated, qtbot, tmp_path):
    state = heated.session.state
    animations = heated.assembly.animations
    animations.record(tmp_path / "sweep.gif", AnimationChoice("theta", 240, 8.0, 25))
    qtbot.waitUntil(lambda: animations.bar.progress.value() >= 2, timeout=90000)
    qtbot.mouseClick(animations.bar.cancel, Qt.MouseButton.LeftButton)
    assert heated.session.state == state
    assert not animations.bar.isVisible()
    assert heated.window.menus.actions["animation"].isEnabled()
    assert list(tmp_path.glob("*.gif")) == []


def test_without_heat_only_the_turntable_is_offered(qtbot):
    offered = []
    for sweeps in (True, False):
        dialog = AnimationDialog(sweeps=sweeps)
        qtbot.addWidget(dialog)
        offered.append(dialog.kind.count())
        assert dialog.choice == AnimationChoice()
    assert offered == [3, 1]
