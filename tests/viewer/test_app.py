"""The command `add-viewer`, in processes of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings

from add_viewer import preflight
from add_viewer.app import main
from add_viewer.assembly import Assembly


def viewer(*arguments: str, environment: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "add_viewer.app", *arguments]
    return subprocess.run(
        command, capture_output=True, text=True, timeout=120, env={**os.environ, **(environment or {})}, check=False
    )


def test_a_picture_is_drawn_without_a_display(tmp_path: Path):
    if shutil.which("xvfb-run") is None:
        pytest.skip("needs xvfb-run")
    path = tmp_path / "window.png"
    done = viewer(
        "dogs/3", "--screenshot", str(path), "--size", "1024x700", environment={"DISPLAY": "", "WAYLAND_DISPLAY": ""}
    )
    assert (done.returncode, done.stderr) == (0, "")
    from PySide6.QtGui import QImage

    image = QImage(str(path))
    assert (image.width(), image.height()) == (1024, 700)
    assert not image.allGray()


def test_a_bad_file_is_one_line_and_status_two(screen, tmp_path: Path):
    path = tmp_path / "empty.off"
    path.write_text("")
    picture = tmp_path / "window.png"
    done = viewer(str(path), "--screenshot", str(picture))
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1
    assert "empty.off" in done.stderr
    assert not picture.exists()


def test_a_picture_in_no_folder_is_one_line_and_status_two(capsys):
    if not preflight.has_display():
        pytest.skip("would restart on a virtual screen")
    assert main(["--screenshot", "/no/such/folder/x.png"]) == 2
    assert "does not exist" in capsys.readouterr().err


def test_missing_libraries_are_told_by_package():
    def load(library: str) -> None:
        if "xcb-cursor" in library or "libEGL" in library:
            raise OSError(library)

    assert preflight.missing_packages(load, platform="linux") == ["libegl1", "libxcb-cursor0"]
    assert preflight.missing_packages(load, platform="darwin") == []


def test_no_display_is_told_with_a_way_out(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(preflight, "missing_packages", list)
    assert "--screenshot" in (preflight.complaint(for_picture=False) or "")
    assert preflight.complaint(for_picture=True) is None


@pytest.mark.parametrize("text", ["wide", "10x10", "1440", "99999x10"])
def test_a_size_that_is_none_is_explained(text, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["--size", text])
    assert ended.value.code == 2
    assert "--size" in capsys.readouterr().err


PICK_TWICE_AS_FINE = """
import gc
import sys
from PySide6.QtCore import QPoint, QSettings, Qt
from PySide6.QtTest import QTest
from add_viewer.assembly import Assembly

assembly = Assembly([], store=QSettings(sys.argv[1], QSettings.Format.IniFormat), size=(700, 440), theme="light")
gc.disable()
assembly.show()
assert gc.isenabled(), "nothing is ever collected"
assert gc.get_freeze_count() > 100_000, "the collector searches what libraries made"
assembly.opening.open("humans/0")
while assembly.session.state.active is None:
    assembly.app.processEvents()
for _ in range(20):
    assembly.app.processEvents()
canvas = assembly.window.view.canvas
assert canvas.devicePixelRatioF() == 2.0, canvas.devicePixelRatioF()
for vertex in (6868, 5056, 5581):
    click = canvas.place_of(vertex).toPoint()
    QTest.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=click)
    found = [pick.vertex for pick in assembly.session.state.active_picks]
    beside = canvas.place_of(found[0]) - click if found else None
    assert beside is not None and beside.manhattanLength() < 4, (vertex, found, beside)
picture = assembly.window.view.picture(2, transparent=False)
assert picture.width() == 2 * canvas.width(), (picture.width(), canvas.width())
assembly.stop()
"""


def test_picking_is_right_at_twice_the_scale(screen, tmp_path: Path):
    done = subprocess.run(
        [sys.executable, "-c", PICK_TWICE_AS_FINE, str(tmp_path / "settings.ini")],
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, "QT_SCALE_FACTOR": "2"},
        check=False,
    )
    assert done.returncode == 0, done.stderr


def test_a_display_that_does_not_answer_is_told_before_qt_aborts(monkeypatch, capsys):
    monkeypatch.setenv("DISPLAY", ":7391")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(preflight, "missing_packages", list)
    if not sys.platform.startswith("linux"):
        pytest.skip("X is for Linux")
    assert main(["humans/0"]) == 2
    assert "does not answer" in capsys.readouterr().err


def test_a_bad_session_is_one_line_and_status_two(screen, tmp_path: Path):
    path = tmp_path / "later.addsession"
    path.write_text('{"format": "add-viewer session", "version": 99}')
    done = viewer("--session", str(path), "--screenshot", str(tmp_path / "window.png"))
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1
    assert "version 99" in done.stderr


def test_a_picture_of_two_shapes_picks_on_the_first(screen, tmp_path: Path):
    store = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
    assembly = Assembly(["humans/0", "humans/12"], store=store, pick=[6868])
    try:
        for reference in ("humans/0", "humans/12"):
            assembly.opening.open(reference)
        end = time.monotonic() + 30
        while not assembly.session.state.picks and time.monotonic() < end:
            assembly.app.processEvents()
        assert assembly.session.state.active_key == "humans/0"
        assert [(pick.shape, pick.vertex) for pick in assembly.session.state.picks] == [("humans/0", 6868)]
    finally:
        assembly.stop()
