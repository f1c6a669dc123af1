"""The list of jobs and the status bar's part of it, clicked by a mouse; nobody runs the jobs."""

import pytest
from PySide6.QtCore import Qt

from add_viewer.models.jobs import Job, JobRequest, Jobs
from add_viewer.views.beat import Beat
from add_viewer.views.job_status import JobStatus
from add_viewer.views.jobs_panel import JobsPanel

LEFT = Qt.MouseButton.LeftButton


class World:
    """A panel and a status on jobs that a test puts there."""

    def __init__(self, home, qtbot):
        self.jobs, self.asked, self.qtbot = Jobs(home), [], qtbot
        self.jobs.asked.connect(lambda verb, id: self.asked.append((verb, id)))
        beat = Beat()
        self.panel = JobsPanel(self.jobs, lambda id: f"what {id} said", beat)
        self.status = JobStatus(self.jobs, beat)
        beat.setParent(self.panel)
        for widget in (self.panel, self.status):
            qtbot.addWidget(widget)
        self.panel.resize(720, 240)
        self.panel.show()

    def put(self, kind="train", state="running", **facts):
        folder = self.jobs.new_folder(kind)
        request = JobRequest(kind, f"a {kind}", (), folder, kind == "train")
        self.jobs.put(Job(folder.name, request, state=state, **facts))
        return folder.name

    def change(self, id, **facts):
        self.jobs.put(Job(id, self.jobs[id].request, **facts))

    def click(self, button):
        assert button.isVisible()
        self.qtbot.mouseClick(button, LEFT)

    def offered(self, id):
        return {verb for verb, button in self.panel.rows[id].buttons.items() if not button.isHidden()}


@pytest.fixture
def world(screen, tmp_path, qtbot):
    return World(tmp_path, qtbot)


@pytest.mark.parametrize(
    ("kind", "state", "verbs"),
    [
        ("train", "running", {"pause", "cancel"}),
        ("train", "waiting", {"pause", "cancel"}),
        ("train", "paused", {"resume", "cancel"}),
        ("train", "interrupted", {"resume", "dismiss"}),
        ("evaluate", "running", {"cancel"}),
        ("evaluate", "interrupted", {"retry", "dismiss"}),
        ("evaluate", "failed", {"retry", "dismiss"}),
        ("train", "done", {"dismiss"}),
    ],
)
def test_a_job_offers_what_makes_sense_and_a_click_asks_for_it(world, kind, state, verbs):
    id = world.put(kind, state)
    assert world.offered(id) == verbs
    for verb in sorted(verbs):
        world.click(world.panel.rows[id].buttons[verb])
    assert world.asked == [(verb, id) for verb in sorted(verbs)]


def test_a_row_says_progress_time_left_and_why_it_failed(world, qtbot):
    id = world.put(done=340, total=1000, message="Training, step 340 of 1,000", seconds_left=130.0)
    row = world.panel.rows[id]
    assert row.state.text() == "Training, step 340 of 1,000 · 2 min left"
    assert (row.progress.value(), row.message.isHidden()) == (340, True)
    world.change(id, state="failed", message="the loss is nan.")
    assert (row.state.text(), row.message.text(), row.progress.isHidden()) == ("Failed", "the loss is nan.", True)


def test_the_newest_job_is_on_top_and_one_that_is_gone_leaves(world, qtbot):
    first, second = world.put(), world.put()
    qtbot.waitUntil(lambda: world.panel.rows[second].y() < world.panel.rows[first].y())
    world.jobs.remove(second)
    assert set(world.panel.rows) == {first}


def test_the_log_is_read_when_it_is_opened(world):
    id = world.put()
    row = world.panel.rows[id]
    assert row.log.toPlainText() == ""
    world.click(row.log_button)
    assert row.log.toPlainText() == f"what {id} said"
    assert row.log.isVisible()


def test_interrupted_jobs_are_offered_together(world):
    assert not world.panel.resume_all.isVisible()
    one = world.put(state="interrupted")
    assert world.panel.offer.text() == "a train was interrupted and can go on."
    two = world.put(state="interrupted")
    world.click(world.panel.resume_all)
    assert world.asked == [("resume", one), ("resume", two)]


def test_the_status_bar_shows_the_running_job_and_cancels_it(world, qtbot):
    world.put(state="done")
    qtbot.wait(350)
    assert world.status.isHidden()
    id = world.put(done=1, total=4, seconds_left=20.0)
    qtbot.waitUntil(lambda: not world.status.isHidden())
    assert world.status.label.text() == "a train · 20 s left"
    world.status.show()
    world.click(world.status.cancel_button)
    assert world.asked == [("cancel", id)]
