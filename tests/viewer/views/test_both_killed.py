"""App and training killed at once: the next window offers to go on with both, and nothing is lost."""

import os
import signal
import subprocess
import sys

import pytest
from PySide6.QtCore import Qt

from add_core.geometry.shapes import torus
from add_core.io import save_shape

STEPS, SEEN = 400, 110
"""Of the training, and how many are done when it is killed: a checkpoint comes after each hundred."""

APP = """
import sys, time
from PySide6.QtCore import QSettings
from add_viewer.assembly import Assembly
from add_viewer.models.training import TrainingRequest
store, folder, steps, seen = sys.argv[1:]
assembly = Assembly([], store=QSettings(store, QSettings.Format.IniFormat))
assembly.window.show()
assembly.opening.open(f"{folder}/body0.ply")
while assembly.session.state.active is None:
    assembly.app.processEvents()
assembly.session.pick(5)
assembly.session.diffuse(alpha=7.5)
id = assembly.training.start(TrainingRequest("ADD1", data=folder, angles=2, eigenpairs=20, splines=6, pairs=16,
                                             steps=int(steps)))
while assembly.training.curves(id).last_step < int(seen):
    assert not assembly.jobs[id].is_finished, assembly.jobs[id].message
    assembly.app.processEvents()
    time.sleep(0.002)
assembly.keeping.remember()
print(assembly.job_control.process_of(id).pid, flush=True)
while True:
    assembly.app.processEvents()
    time.sleep(0.002)
"""


@pytest.fixture
def bodies(tmp_path):
    """Five tori of one connectivity."""
    folder = tmp_path / "bodies"
    folder.mkdir()
    for number in range(5):
        save_shape(torus(major=1.0, minor=0.3 + 0.05 * number, around=16, through=8), folder / f"body{number}.ply")
    return folder


@pytest.fixture
def killed(screen, bodies, tmp_path):
    """A window with a session and a training, both killed in the middle."""
    command = [sys.executable, "-c", APP, str(tmp_path / "first.ini"), str(bodies), str(STEPS), str(SEEN)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as app:
        training = int(app.stdout.readline())
        os.kill(training, signal.SIGSTOP)  # so that neither sees the other's end
        app.kill()
        app.wait()
        os.kill(training, signal.SIGKILL)


def test_both_go_on_in_the_next_window_and_nothing_is_lost(killed, assembly, bodies, qtbot):
    (job,) = assembly.training.runs
    banner, panel = assembly.session_files.banner, assembly.background.panel
    assert banner.isVisible()
    qtbot.waitUntil(panel.resume_all.isVisible, timeout=20_000)
    assert assembly.jobs[job.id].state == "interrupted"
    qtbot.mouseClick(banner.restore_button, Qt.MouseButton.LeftButton)
    qtbot.mouseClick(panel.resume_all, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: assembly.session.state.active is not None, timeout=60_000)
    state = assembly.session.state
    assert (state.active_key, state.diffusion.alpha) == (str(bodies / "body0.ply"), 7.5)
    assert [pick.vertex for pick in state.picks] == [5]
    qtbot.waitUntil(lambda: assembly.jobs[job.id].is_finished, timeout=90_000)
    assert assembly.jobs[job.id].state == "done"
    assert assembly.training.curves(job.id).steps == list(range(1, STEPS + 1))
    assert assembly.keeping.leftovers() == []
