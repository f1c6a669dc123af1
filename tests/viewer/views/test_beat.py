"""How often the window is painted while background work goes on: once a beat, for everything that changed."""

import pytest
from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QHBoxLayout, QMainWindow, QStatusBar, QWidget

from add_viewer.models.jobs import Job, JobRequest, Jobs
from add_viewer.views.beat import PATIENCE, Beat
from add_viewer.views.elided_label import ElidedLabel
from add_viewer.views.job_status import JobStatus
from add_viewer.views.jobs_panel import JobsPanel
from add_viewer.views.share_bar import ShareBar

UPDATE, LAYOUT, PAINT = QEvent.Type.UpdateRequest, QEvent.Type.LayoutRequest, QEvent.Type.Paint


class Counted(QObject):
    """How many events of each type came to the objects that it watches."""

    def __init__(self, *watched):
        super().__init__()
        self.counts = {}
        for each in watched:
            each.installEventFilter(self)

    def eventFilter(self, watched, event):
        self.counts[event.type()] = self.counts.get(event.type(), 0) + 1
        return False

    def of(self, kind):
        return self.counts.get(kind, 0)


@pytest.fixture
def window(screen, qtbot):
    made = QMainWindow()
    made.setCentralWidget(QWidget())
    QHBoxLayout(made.centralWidget())
    made.setStatusBar(QStatusBar())
    made.resize(700, 300)
    qtbot.addWidget(made)
    return made


@pytest.fixture
def jobs(tmp_path):
    return Jobs(tmp_path)


def put(jobs, id="a-job", **facts):
    request = JobRequest("train", "a training", (), jobs.new_folder("train"), resumable=True)
    jobs.put(Job(id, request, state="running", total=100, **facts))


def test_what_is_asked_for_between_two_beats_is_shown_once_and_together(screen, qtbot):
    beat, shown = Beat(), []
    one, two = lambda: shown.append(1), lambda: shown.append(2)
    for each in (one, two, one, two, one):
        beat.ask(each)
    assert shown == []
    qtbot.waitUntil(lambda: len(shown) >= 2)
    assert shown == [1, 2]
    qtbot.wait(PATIENCE + 50)
    assert shown == [1, 2]


def test_the_list_and_the_status_bar_are_painted_at_once_when_a_job_gets_on(window, jobs, qtbot):
    beat = Beat(window)
    panel, status = JobsPanel(jobs, lambda id: "", beat), JobStatus(jobs, beat)
    window.centralWidget().layout().addWidget(panel)
    window.statusBar().addPermanentWidget(status)
    window.show()
    put(jobs, done=1, seconds_left=100.0)
    qtbot.waitUntil(status.isVisible)
    qtbot.wait(100)
    counted = Counted(window)
    put(jobs, done=2, seconds_left=50.0, message="Training, step 2 of 100")
    qtbot.waitUntil(lambda: status.label.text().endswith("50 s left"))
    qtbot.wait(100)
    assert (counted.of(UPDATE), counted.of(LAYOUT)) == (1, 0)
    assert panel.rows["a-job"].progress.value() == panel.rows["a-job"].progress.maximum() // 50


def test_the_status_bar_keeps_its_height_when_a_job_begins(assembly, qtbot):
    bar, status = assembly.window.statusBar(), assembly.background.status
    height = bar.height()
    put(assembly.jobs, done=1, seconds_left=100.0)
    qtbot.waitUntil(status.isVisible)
    qtbot.wait(50)
    assert bar.height() == height
    assembly.jobs.remove("a-job")


def test_the_words_of_one_job_keep_their_room(window, jobs, qtbot):
    status = JobStatus(jobs, Beat(window))
    window.statusBar().addPermanentWidget(status)
    window.show()
    put(jobs, done=1, seconds_left=7200.0)
    qtbot.waitUntil(status.isVisible)
    wide = status.label.width()
    put(jobs, done=99, seconds_left=40.0)
    qtbot.waitUntil(lambda: status.label.text().endswith("40 s left"))
    assert status.label.width() == wide
    assert wide >= status.label.sizeHint().width()


def test_a_bar_that_knows_no_share_walks_slowly_and_rests_when_hidden(screen, qtbot):
    bar = ShareBar()
    qtbot.addWidget(bar)
    bar.resize(100, 4)
    bar.show()
    bar.show_share(None)
    qtbot.wait(50)
    counted = Counted(bar)
    before = bar.grab().toImage()
    qtbot.wait(2 * PATIENCE)
    assert 1 <= counted.of(PAINT) <= 5
    assert bar.is_walking
    assert bar.grab().toImage() != before
    bar.hide()
    assert not bar.is_walking
    bar.show()
    assert bar.is_walking
    bar.show_share(0.25)
    assert (bar.is_walking, bar.value()) == (False, bar.maximum() // 4)


def test_new_words_in_a_seen_label_change_no_layout(window, qtbot):
    label = ElidedLabel("short")
    window.centralWidget().layout().addWidget(label)
    assert label.sizeHint().width() < 200
    assert label.accessibleName() == "short"
    window.show()
    qtbot.wait(50)
    counted = Counted(window.centralWidget())
    label.setText("words " * 100)
    qtbot.wait(50)
    assert counted.of(LAYOUT) == 0
    assert (label.text(), label.accessibleName()) == ("words " * 100, "words " * 100)
    assert label.toolTip() == "words " * 100
    label.setText("short again")
    qtbot.waitUntil(lambda: label.toolTip() == "")
