"""Trainings from the window: started, watched, paused, and gone on with whatever dies."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtGui import QImage

from add_core.drawing.colours import MARKERS
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import ellipsoid
from add_core.io import save_shape
from add_viewer.assembly import Assembly
from add_viewer.controllers.job_folders import kept_jobs
from add_viewer.models.training import TrainingRequest
from add_viewer.tasks.identity import beginning

CONTROL = Qt.KeyboardModifier.ControlModifier
PATIENCE = 90_000
STEPS = 4000


@pytest.fixture(scope="module")
def bodies(tmp_path_factory):
    """Five lumpy ellipsoids with the same faces."""
    folder = tmp_path_factory.mktemp("bodies")
    mesh = ellipsoid(1.0, 0.7, 0.5, subdivisions=2)
    for number in range(5):
        lumps = 1 + 0.2 * np.sin(2 * mesh.vertices[:, 0] + 0.1 * number) + 0.1 * np.cos(4 * mesh.vertices[:, 1])
        save_shape(TriangleMesh(mesh.vertices * lumps[:, None], mesh.faces), folder / f"body{number}.ply")
    return folder


def tiny(bodies):
    return TrainingRequest("ADD1", data=str(bodies), angles=2, eigenpairs=30, splines=8, pairs=16, steps=STEPS)


class Trainer:
    """What a person does about trainings."""

    def __init__(self, assembly, qtbot):
        self.assembly, self.qtbot = assembly, qtbot
        self.panel = assembly.background.training_panel

    @property
    def job(self):
        (job,) = self.assembly.training.runs
        return job

    @property
    def curves(self):
        return self.assembly.training.curves(self.job.id)

    def wait(self, condition):
        self.qtbot.waitUntil(lambda: bool(condition()), timeout=PATIENCE)

    def wait_for_state(self, state):
        self.wait(lambda: self.job.state == state)

    def wait_for_steps_after(self, step):
        self.wait(lambda: self.curves.last_step > step)

    def press(self, button):
        self.wait(button.isVisible)
        self.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)

    def pid(self):
        return self.assembly.job_control.process_of(self.job.id).pid


@pytest.fixture
def trainer(assembly, qtbot):
    return Trainer(assembly, qtbot)


def fill_in(form, person, qtbot, bodies):
    """Choose a folder and small numbers, with keys alone."""
    form.data.setFocus()
    qtbot.keyClick(form.data, Qt.Key.Key_End)
    person.type_into(form.folder, str(bodies))
    form.architecture.setFocus()
    qtbot.keyClicks(form.architecture, "ADD1")
    for name, typed in {"angles": "2", "eigenpairs": "30", "budget": str(STEPS)}.items():
        person.type_into(form.numbers[name], typed)


def shows(widget, colour):
    """Whether a widget's picture has pixels of a colour."""
    image = widget.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
    pixels = flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3)
    return bool((np.abs(pixels - 255 * np.array(colour)).max(axis=2) < 12).sum() > 10)


def see_its_distances(person, trainer, bodies):
    """Use the training's best state so far, while it trains on."""
    body = str(bodies / "body0.ply")
    person.open(body)
    person.session.pick(0)
    trainer.wait(trainer.panel.use_button.isEnabled)
    trainer.press(trainer.panel.use_button)
    field = (0, body)
    trainer.wait(lambda: field in person.results.fields and person.results.fields[field].values is not None)
    assert person.results.fields[field].choice.kind == "distance"
    assert person.results.fields[field].values[0] == 0.0
    assert trainer.job.state == "running"


def test_a_training_is_started_watched_used_paused_gone_on_with_and_cancelled(person, trainer, qtbot, bodies):
    qtbot.keyClick(person.window, Qt.Key.Key_T, CONTROL)
    form = trainer.panel.form
    fill_in(form, person, qtbot, bodies)
    assert form.request.data == str(bodies)
    trainer.press(form.start_button)
    trainer.wait_for_steps_after(0)
    assert trainer.job.request.title == f"ADD1 on {bodies.name}"
    trainer.wait(lambda: trainer.curves.validations)
    trainer.wait(lambda: shows(trainer.panel.plots, MARKERS[0]))  # the AUC is drawn
    assert trainer.assembly.background.status.isVisible()
    see_its_distances(person, trainer, bodies)

    trainer.press(trainer.panel.buttons["pause"])
    trainer.wait_for_state("paused")
    paused_at = trainer.curves.last_step
    trainer.press(trainer.panel.buttons["resume"])
    trainer.wait_for_steps_after(paused_at)
    steps = trainer.curves.steps
    assert steps == list(range(1, len(steps) + 1))

    trainer.press(trainer.panel.buttons["cancel"])
    trainer.wait_for_state("cancelled")
    trainer.wait(lambda: not trainer.assembly.background.status.isVisible())


def another_window(tmp_path):
    made = Assembly([], store=QSettings(str(tmp_path / "other.ini"), QSettings.Format.IniFormat), size=(1200, 800))
    made.window.show()
    return made


def test_a_killed_training_and_one_whose_window_is_closed_are_offered_to_go_on(trainer, qtbot, bodies, tmp_path):
    trainer.panel.submitted.emit(tiny(bodies))
    trainer.wait_for_steps_after(100)
    os.kill(trainer.pid(), signal.SIGKILL)
    trainer.wait_for_state("interrupted")
    killed_at = trainer.curves.last_step
    trainer.assembly.stop()
    after = Trainer(another_window(tmp_path), qtbot)
    assert after.job.state == "interrupted"
    jobs_panel = after.assembly.background.panel
    assert jobs_panel.isVisible()
    after.press(jobs_panel.resume_all)
    after.wait_for_steps_after(killed_at)
    pid, folder = after.pid(), after.job.request.folder
    after.assembly.stop()
    assert beginning(pid) is None
    assert [kept.job.state for kept in kept_jobs(folder.parent)] == ["interrupted"]


APP = """
import sys
from PySide6.QtCore import QSettings
from add_viewer.assembly import Assembly
from add_viewer.models.training import TrainingRequest
assembly = Assembly([], store=QSettings(sys.argv[1], QSettings.Format.IniFormat))
assembly.window.show()
id = assembly.training.start(TrainingRequest("ADD1", data=sys.argv[2], angles=2, eigenpairs=30, splines=8, pairs=16,
                                             steps=int(sys.argv[3])))
def tell(id):
    if assembly.training.curves(id).last_step >= 100:
        print(assembly.job_control.process_of(id).pid, flush=True)
assembly.training.curves_changed.connect(tell)
assembly.app.exec()
"""


def test_a_training_survives_the_death_of_its_window_and_the_next_one_follows_it(screen, qtbot, qapp, bodies, tmp_path):
    command = [sys.executable, "-c", APP, str(tmp_path / "first.ini"), str(bodies), str(10 * STEPS)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as app:
        pid = int(app.stdout.readline())
        app.kill()
    os.kill(pid, 0)  # it trains on
    after = Trainer(another_window(tmp_path), qtbot)
    assert after.job.state == "running"
    after.wait(lambda: len(after.curves.steps) > 100)
    assert after.curves.steps == list(range(1, len(after.curves.steps) + 1))
    after.assembly.jobs.pause(after.job.id)
    after.wait_for_state("paused")
    after.wait(lambda: beginning(pid) is None)
    after.assembly.stop()
