"""Sessions in the real window: saved, opened, and restored after the app was killed."""

import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from add_viewer.models.session_file import KeptSession, read_session

THIGH = 6868


def turn(person, qtbot) -> None:
    """Drag the picture with the mouse, and come closer with the wheel."""
    qtbot.mousePress(person.canvas, Qt.MouseButton.LeftButton, pos=QPoint(60, 200))
    for step in (20, 50, 90):
        qtbot.mouseMove(person.canvas, QPoint(60 + step, 200 + step // 2))
    qtbot.mouseRelease(person.canvas, Qt.MouseButton.LeftButton, pos=QPoint(150, 245))
    person.canvas.steer("zoom", (1.5,))


def worth_keeping(person) -> KeptSession:
    """All but the moment, and the panels: Qt packs equal layouts into different bytes."""
    return replace(person.assembly.keeping.snapshot(), saved="", layout="")


def test_a_session_comes_back_with_picks_cameras_and_panels(person, qtbot, tmp_path):
    person.open("dogs/1")
    person.open("humans/0")
    person.click(THIGH)
    turn(person, qtbot)
    person.window.curve_dock.close()
    before, path = worth_keeping(person), tmp_path / "talk.addsession"
    person.assembly.session_files.save_as(path)
    person.window.curve_dock.show()
    qtbot.keyClick(person.window, Qt.Key.Key_W, Qt.KeyboardModifier.ControlModifier)
    person.canvas.look("top")
    person.window.open_requested.emit(str(path))
    qtbot.waitUntil(lambda: len(person.session.state.shapes) == 2, timeout=90000)
    assert worth_keeping(person) == before
    assert not person.window.curve_dock.isVisible()
    assert person.window.settings.recent[0] == str(path)


def test_control_s_saves_where_it_was_saved_before(person, qtbot, tmp_path):
    person.open()
    path = tmp_path / "talk.addsession"
    person.assembly.session_files.save_as(path)
    person.click(THIGH)
    qtbot.keyClick(person.window, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert [pick.vertex for pick in read_session(path).picks] == [THIGH]


def test_a_session_that_is_none_is_told_in_the_window(person, qtbot, tmp_path):
    path = tmp_path / "bad.addsession"
    path.write_text("no session")
    person.window.open_requested.emit(str(path))
    qtbot.waitUntil(lambda: person.window.message.isVisible(), timeout=30000)
    assert "bad.addsession" in person.window.message.text.text()


def test_a_view_without_room_keeps_a_camera_that_can_be_saved(person, make_torus):
    person.session.add_shape(make_torus())
    canvas = person.window.view.canvas
    canvas.resize(0, 300)
    canvas.fit()
    (camera,) = person.assembly.session_files.cameras()
    assert np.isfinite([camera.distance, *camera.focal]).all()


DIE = """
import os, signal, sys, time
from PySide6.QtCore import QSettings
from add_viewer.assembly import Assembly

assembly = Assembly([], store=QSettings(sys.argv[1], QSettings.Format.IniFormat), size=(900, 700))
assembly.window.show()
assembly.opening.open("humans/0")
while assembly.session.state.active is None:
    assembly.app.processEvents()
assembly.session.pick(6868)
assembly.session.diffuse(alpha=7.5)
assembly.window.view.canvas.steer("rotate", (40.0, 10.0))
end = time.monotonic() + 3.0
while time.monotonic() < end:
    assembly.app.processEvents()
    time.sleep(0.01)
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.fixture
def killed(screen, tmp_path: Path) -> None:
    """An app that was killed while a session was open."""
    command = [sys.executable, "-c", DIE, str(tmp_path / "other.ini")]
    done = subprocess.run(command, capture_output=True, timeout=120, check=False, env=dict(os.environ))
    assert done.returncode == -signal.SIGKILL, done.stderr


def test_after_a_kill_the_app_offers_to_go_on_and_has_everything(killed, person, qtbot):
    banner = person.assembly.session_files.banner
    assert banner.isVisible()
    assert "Person 1" in banner.text.text()
    qtbot.mouseClick(banner.restore_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: person.session.state.active_key == "humans/0", timeout=90000)
    assert not banner.isVisible()
    assert [pick.vertex for pick in person.session.state.picks] == [THIGH]
    assert person.session.state.diffusion.alpha == 7.5
    assert person.window.view.canvas.camera_model.azimuth == pytest.approx(-40.0)
    assert person.assembly.keeping.leftovers() == []


def test_of_a_camera_that_shows_the_whole_shape_a_session_keeps_what_no_window_size_changes(person, qtbot):
    person.open()
    person.canvas.look("left")
    kept, place = person.assembly.session_files.cameras(), person.canvas.camera_model.distance
    person.window.resize(900, 500)
    qtbot.waitUntil(lambda: person.canvas.camera_model.distance != place)
    assert person.assembly.session_files.cameras() == kept
    person.canvas.steer("zoom", (1.5, 0.0, 0.0))
    assert person.assembly.session_files.cameras()[0].distance == person.canvas.camera_model.distance
