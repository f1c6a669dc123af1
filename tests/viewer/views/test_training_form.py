"""Choosing what to train with mouse and keys, and the curves that come of it."""

from math import pi

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage

from add_core.drawing.colours import MARKERS
from add_core.geometry.shapes import sphere
from add_core.io import save_shape
from add_viewer.controllers.training import TrainingController
from add_viewer.models.jobs import Job, JobRequest, Jobs
from add_viewer.models.training import EFFORTS, LOSSES, TrainingRequest
from add_viewer.models.training_curves import TrainingCurves
from add_viewer.views.beat import Beat
from add_viewer.views.plot import round_ticks
from add_viewer.views.training_form import TrainingForm
from add_viewer.views.training_panel import TrainingPanel
from add_viewer.views.training_plots import TrainingPlots


@pytest.fixture
def form(screen, qtbot):
    made = TrainingForm(TrainingRequest())
    qtbot.addWidget(made)
    made.show()
    return made


def choose(qtbot, box, index):
    box.setFocus()
    qtbot.keyClick(box, Qt.Key.Key_Home)
    for _ in range(index):
        qtbot.keyClick(box, Qt.Key.Key_Down)


def type_into(qtbot, field, text):
    field.setFocus()
    field.selectAll()
    qtbot.keyClicks(field, text)
    qtbot.keyClick(field, Qt.Key.Key_Return)


def test_an_effort_sets_the_numbers_and_a_typed_number_leaves_it(form, qtbot):
    choose(qtbot, form.effort, 1)
    assert form.request.effort is EFFORTS[1]
    assert form.numbers["eigenpairs"].text() == str(EFFORTS[1].eigenpairs)
    type_into(qtbot, form.numbers["angles"], "5")
    assert (form.request.angles, form.effort.currentIndex()) == (5, -1)
    choose(qtbot, form.effort, 2)
    assert (form.request.shapes, form.numbers["shapes"].text()) == (None, "")


def test_numbers_out_of_range_are_brought_into_it(form, qtbot):
    for name, typed, expected in (("angles", "0", 1), ("eigenpairs", "99999", 1000), ("seed", "-3", 0)):
        type_into(qtbot, form.numbers[name], typed)
        assert getattr(form.request, name) == expected
        assert form.numbers[name].text() == str(expected)


def test_the_budget_is_steps_or_minutes(form, qtbot):
    choose(qtbot, form.unit, 1)
    assert (form.request.steps, form.request.minutes) == (None, 10.0)
    type_into(qtbot, form.numbers["budget"], "2.5")
    assert form.request.minutes == 2.5
    choose(qtbot, form.unit, 0)
    assert (form.request.steps, form.request.minutes) == (EFFORTS[0].steps, None)
    type_into(qtbot, form.numbers["budget"], "80")
    choose(qtbot, form.unit, 1)
    assert form.request.minutes == 2.5
    choose(qtbot, form.unit, 0)
    assert form.request.steps == 80
    choose(qtbot, form.unit, 1)
    choose(qtbot, form.effort, 1)
    choose(qtbot, form.unit, 0)
    assert form.request.steps == EFFORTS[1].steps


def test_a_classifier_has_its_own_loss_and_gives_the_chosen_one_back(form, qtbot):
    choose(qtbot, form.loss, 1)
    choose(qtbot, form.architecture, 6)
    assert (form.request.architecture, form.loss.currentText()) == ("mADD4", "Multinomial, eq. (22)")
    choose(qtbot, form.architecture, 0)
    assert (form.loss.count(), form.loss.currentText()) == (2, LOSSES[1].title)
    assert form.request.loss == "siamese"


def test_a_folder_is_asked_for_where_one_is_wanted_and_nothing_starts_without(form, qtbot, tmp_path):
    assert not form.folder.isVisible()
    choose(qtbot, form.data, 3)
    assert form.folder.isVisible()
    assert not form.start_button.isEnabled()
    type_into(qtbot, form.folder, "/my shapes")
    assert "no folder '/my shapes'" in form._help["folder"].text()
    for number in range(4):
        assert not form.start_button.isEnabled()
        save_shape(sphere(1), tmp_path / f"shape{number}.off")
        type_into(qtbot, form.folder, str(tmp_path / "."))
        assert (f"holds {number + 1} shape" in form._help["folder"].text()) == (number < 3)
    assert form.request.data == str(tmp_path)
    with qtbot.waitSignal(form.submitted) as submitted:
        qtbot.mouseClick(form.start_button, Qt.MouseButton.LeftButton)
    assert submitted.args == [form.request]


def test_every_choice_has_a_sentence_that_is_not_cut(form, qtbot):
    for architecture in range(7):
        choose(qtbot, form.architecture, architecture)
        for label in form._help.values():
            assert label.text().endswith(".")
            assert label.height() >= label.heightForWidth(label.width())


def test_enter_in_a_field_enters_the_number_and_starts_nothing(form, qtbot):
    with qtbot.assertNotEmitted(form.submitted):
        type_into(qtbot, form.numbers["seed"], "7")
    assert (form.request.seed, form.isVisible()) == (7, True)


# -- the list of trainings ---------------------------------------------------------------------------------------------


@pytest.fixture
def panel(screen, qtbot, tmp_path):
    jobs = Jobs(tmp_path)
    made = TrainingPanel(jobs, TrainingController(jobs, list, list), Beat())
    for number, state in enumerate(("interrupted", "running", "interrupted")):
        id = f"2026112{number}-100000-train"
        request = JobRequest("train", f"training {number}", (), tmp_path / id, resumable=True)
        jobs.put(Job(id, request, state=state, done=34, total=100, message="It can go on"))
    qtbot.addWidget(made)
    made.show()
    qtbot.waitUntil(lambda: made.title.text() != "")
    return made


def test_the_training_that_runs_is_shown_first_and_the_chosen_one_stays(panel):
    assert panel.title.text() == "training 1"
    panel.list.setCurrentRow(2)
    panel._show_runs()
    assert panel.title.text() == "training 0"


def test_why_a_training_stopped_is_said_once(panel):
    panel.list.setCurrentRow(0)
    assert panel.state.text() == "Interrupted at 34 % · It can go on"


# -- curves -----------------------------------------------------------------------------------------------------------


@pytest.fixture
def curves():
    made = TrainingCurves()
    for step in range(1, 41):
        made.hear({"event": "step", "step": step, "steps": 80, "loss": 8.0 / step})
        if step % 10 == 0:
            scores = {"loss": 4.0, "auc": 0.9, "cmc1": step / 100, "cmc10": 0.5, "right_side": None}
            made.hear({"event": "validation", "step": step, **scores})
    return made


@pytest.fixture
def plots(screen, qtbot):
    made = TrainingPlots()
    qtbot.addWidget(made)
    made.resize(800, 200)
    made.show()
    return made


def count(widget, colour):
    """Pixels of a colour in what a widget shows."""
    image = widget.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
    pixels = flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3)
    return int((np.abs(pixels - 255 * np.array(colour)).max(axis=2) < 12).sum())


def test_scores_are_drawn_in_their_colours_and_unknown_ones_not(plots, curves):
    assert count(plots, MARKERS[0]) == 0
    plots.show_curves(curves)
    auc, cmc, side = (count(plots, MARKERS[number]) for number in range(3))
    assert min(auc, cmc) > 100
    assert side == 0


def test_the_cursor_shows_the_scores_of_the_nearest_validation(plots, curves, qtbot):
    plots.show_curves(curves)
    plots.grab()
    place = plots._plots[1].place(19.0, 0.5).toPoint()
    qtbot.mouseMove(plots, place + QPoint(-5, 0))
    qtbot.mouseMove(plots, place)
    assert [line.label for line in plots._score_lines(plots._seen())] == ["AUC 0.90", "CMC@1 0.20"]
    plots.leaveEvent(None)
    assert [line.label for line in plots._score_lines(plots._seen())] == ["AUC 0.90", "CMC@1 0.40"]


@pytest.mark.parametrize(("low", "high", "most"), [(0, 1, 4), (0, 8.3, 4), (0, 120, 3), (0, 4000, 5), (0.02, pi, 6)])
def test_ticks_are_round_few_and_inside(low, high, most):
    ticks = round_ticks(low, high, most)
    assert 2 <= len(ticks) <= most + 1
    assert low - 1e-9 <= ticks[0] < ticks[-1] <= high + 1e-9
    steps = np.diff(ticks)
    assert np.allclose(steps, steps[0])
    assert f"{steps[0]:e}"[0] in "125"


def test_one_value_has_one_tick():
    assert round_ticks(0.0, 0.0, 4) == [0.0]
