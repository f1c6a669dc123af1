"""Jobs without processes: whose turn it is, what becomes of them, and what the next window makes of their folders."""

from __future__ import annotations

import json
from dataclasses import dataclass, field

import pytest
from psygnal import EmitLoopError

from add_viewer.controllers.job_folders import Stamp
from add_viewer.controllers.jobs import JobsController
from add_viewer.models.jobs import JobRequest, Jobs

HERE, ELSEWHERE = Stamp(100, "this window"), Stamp(200, "another window")


@dataclass
class FakeProcess:
    """Says and ends what a test tells it to."""

    identity: Stamp
    folder: object
    said: object
    ended: object
    anew: bool = False
    asked: bool = False
    killed: bool = False

    def kill(self) -> None:
        self.killed = True

    def ask_to_end(self) -> None:
        self.asked = True


@dataclass
class FakeProcesses:
    """Remembers what was started; `alive` are the processes that the system knows."""

    window: Stamp = HERE
    alive: set = field(default_factory=set)
    started: list = field(default_factory=list)
    followed: list = field(default_factory=list)
    stopped: bool = False

    def is_alive(self, pid, began):
        return (pid, began) in self.alive

    def start(self, arguments, folder, *, anew, said, ended):
        if arguments[0] == "impossible":
            raise OSError(2, "No such file", "python")
        folder.mkdir(parents=True, exist_ok=True)
        self.started.append(FakeProcess(Stamp(len(self.started) + 1, "then"), folder, said, ended, anew))
        return self.started[-1]

    def follow(self, pid, began, folder, *, said, ended):
        self.followed.append(FakeProcess(Stamp(pid, began), folder, said, ended))
        return self.followed[-1]

    def stop(self):
        self.stopped = True


class World:
    """One window's jobs, on a folder that others share."""

    def __init__(self, home, window=HERE, alive=()):
        self.jobs, self.complaints, self.now = Jobs(home), [], 0.0
        self.processes = FakeProcesses(window, set(alive))
        self.controller = JobsController(self.jobs, self.processes, self.complaints.append, clock=lambda: self.now)
        self.finished = []
        self.jobs.finished.connect(self.finished.append)

    def start(self, kind="train", *, resumable=True, command=None):
        folder = self.jobs.new_folder(kind)
        return self.jobs.start(JobRequest(kind, f"a {kind}", (command or kind,), folder, resumable))

    @property
    def states(self):
        return [job.state for job in self.jobs.all]

    def process(self, id):
        return next(each for each in reversed(self.processes.started) if each.folder.name == id)

    def say(self, id, *events, is_news=True):
        self.process(id).said(list(events), is_news)


def step(number, of=10):
    return {"event": "step", "step": number, "steps": of, "loss": 1.0}


@pytest.fixture
def world(tmp_path):
    return World(tmp_path)


def test_short_work_overtakes_a_second_training_and_only_two_run_at_once(world):
    first, second = world.start("train"), world.start("train")
    assert world.states == ["running", "waiting"]
    spectra, describe = world.start("spectra"), world.start("describe")
    assert world.states == ["running", "waiting", "running", "waiting"]
    world.process(spectra).ended(0, "")
    assert world.jobs[describe].state == "running"
    world.process(first).ended(0, "")
    assert world.jobs[second].state == "running"


def test_a_result_finishes_a_job_once(world):
    id = world.start("describe")
    world.say(id, {"event": "progress", "done": 3, "total": 17, "label": "Spectra"})
    assert (world.jobs[id].done, world.jobs[id].total, world.jobs[id].message) == (3, 17, "Spectra")
    world.say(id, {"event": "result", "output": "x.npz"})
    assert world.finished == []
    world.process(id).ended(0, "")
    assert world.finished == [id]
    assert (world.jobs[id].state, world.jobs[id].result) == ("done", {"output": "x.npz"})


def test_answers_that_were_used_long_ago_leave_the_list_and_the_disk(world):
    training, failed = world.start("train"), world.start("describe")
    world.process(failed).ended(1, "add-core: no such shape")
    world.process(training).ended(0, "")
    answers = [world.start("describe") for _ in range(15)]
    for id in answers:
        world.process(id).ended(0, "")
    assert [job.id for job in world.jobs.all] == [training, failed, *answers[3:]]
    assert [world.jobs.home.joinpath(id).exists() for id in answers] == [False] * 3 + [True] * 12


def test_time_left_follows_the_latest_speed_and_not_what_was_said_before(world):
    id = world.start()
    world.say(id, step(5, 100), is_news=False)
    assert world.jobs[id].seconds_left is None
    for world.now, number in ((10.0, 6), (12.0, 8)):
        world.say(id, step(number, 100))
    assert world.jobs[id].seconds_left == pytest.approx(92.0)
    world.say(id, {"event": "progress", "done": 0, "total": 4, "label": "another phase"})
    assert world.jobs[id].seconds_left is None


def test_a_failure_tells_the_last_words_and_can_be_retried(world):
    id = world.start("describe", resumable=False)
    world.process(id).ended(2, "add-core: there is no shape.")
    assert (world.jobs[id].state, world.jobs[id].message) == ("failed", "there is no shape.")
    assert "a describe failed: there is no shape." in world.complaints[0]
    world.jobs.retry(id)
    assert world.jobs[id].state == "running"
    assert world.process(id).anew


def test_a_command_that_cannot_start_is_a_failure_and_not_an_exception(world):
    id = world.start(command="impossible")
    assert world.jobs[id].state == "failed"
    assert "No such file" in world.complaints[0]


@pytest.mark.parametrize(("verb", "state"), [("pause", "paused"), ("cancel", "cancelled")])
def test_pausing_and_cancelling_wait_for_the_process_to_end(world, verb, state):
    id = world.start()
    getattr(world.jobs, verb)(id)
    assert (world.jobs[id].state, world.process(id).asked) == ("running", True)
    world.say(id, step(4))
    assert world.jobs[id].message == "Stopping …"
    world.process(id).ended(130, "add-core: Stopped on request.")
    assert world.jobs[id].state == state
    assert not world.complaints


def test_a_job_that_is_done_before_it_could_be_stopped_is_done(world):
    id = world.start()
    world.jobs.pause(id)
    world.say(id, {"event": "done", "model": "m"})
    world.process(id).ended(0, "")
    assert world.jobs[id].state == "done"


def test_a_listener_that_stumbles_does_not_keep_the_others_waiting(world):
    def stumble(_id):
        raise ValueError("stumbled")

    first, second = world.start(), world.start()
    world.jobs.finished.connect(stumble)
    world.say(first, {"event": "done"})
    with pytest.raises(EmitLoopError):
        world.process(first).ended(0, "")
    assert [world.jobs[id].state for id in (first, second)] == ["done", "running"]


def test_a_waiting_job_is_cancelled_without_ever_starting(world):
    world.start()
    id = world.start()
    world.jobs.cancel(id)
    assert (world.jobs[id].state, len(world.processes.started)) == ("cancelled", 1)
    assert world.finished == [id]


def test_only_jobs_that_go_on_where_they_were_can_be_paused(world):
    id = world.start("spectra", resumable=False)
    world.jobs.pause(id)
    assert not world.process(id).asked
    world.process(id).ended(-9, "")
    assert world.jobs[id].state == "interrupted"
    assert (world.jobs[id].can("resume"), world.jobs[id].can("retry")) == (False, True)


def test_a_killed_training_is_interrupted_and_goes_on_with_the_same_command(world):
    id = world.start()
    world.say(id, step(3))
    world.process(id).ended(-9, "")
    assert (world.jobs[id].state, world.jobs[id].message) == ("interrupted", "It can go on where it was")
    assert world.finished == []
    world.jobs.resume(id)
    assert (world.jobs[id].state, world.process(id).anew) == ("running", False)


def test_the_next_window_offers_what_the_closed_one_left(world, tmp_path):
    training, waiting, paused = world.start(), world.start(), world.start()
    world.jobs.pause(paused)
    world.controller.stop()
    assert world.process(training).asked
    after = World(tmp_path)
    after.controller.restore()
    assert {job.id: job.state for job in after.jobs.all} == {
        training: "interrupted",
        waiting: "interrupted",
        paused: "paused",
    }
    after.jobs.resume(waiting)
    assert after.jobs[waiting].state == "running"


def test_the_window_after_a_crash_follows_what_runs_and_tells_how_everything_ended(world, tmp_path):
    training, evaluation, waiting = world.start(), world.start("evaluate"), world.start()
    process = world.process(training).identity
    after = World(tmp_path, Stamp(300, "next window"), alive={(process.pid, process.began)})
    after.controller.restore()
    assert {job.id: job.state for job in after.jobs.all} == {
        training: "running",
        evaluation: "interrupted",
        waiting: "interrupted",
    }
    (followed,) = after.processes.followed
    assert followed.identity == process
    followed.said([step(9), {"event": "done", "model": "m"}], False)
    followed.ended(None, "")
    assert after.finished == [training]


def test_a_training_that_finished_while_no_window_was_open_is_done(world, tmp_path):
    id = world.start()
    after = World(tmp_path, Stamp(300, "next window"))
    after.controller.restore()
    after.processes.followed[0].said([step(10), {"event": "done", "model": "m"}], False)
    after.processes.followed[0].ended(None, "Started on 28 November 2026, 10:00:00")
    assert after.jobs[id].state == "done"


def test_answers_that_nobody_waits_for_any_more_are_ended_and_forgotten(world, tmp_path):
    id = world.start("describe", resumable=False)
    process = world.process(id).identity
    after = World(tmp_path, Stamp(300, "next window"), alive={(process.pid, process.began)})
    after.controller.restore()
    assert after.jobs.all == ()
    assert after.processes.followed[0].killed
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("words", "state"), [("add-core: the loss is nan.", "failed"), ("", "interrupted")])
def test_how_a_followed_process_ended_is_read_from_its_words(world, tmp_path, words, state):
    id = world.start()
    process = world.process(id).identity
    after = World(tmp_path, Stamp(300, "next window"), alive={(process.pid, process.began)})
    after.controller.restore()
    after.processes.followed[0].ended(None, words)
    assert after.jobs[id].state == state


def test_jobs_of_a_window_that_is_still_open_are_left_alone(world, tmp_path):
    world.start()
    other = World(tmp_path, ELSEWHERE, alive={(HERE.pid, HERE.began)})
    other.controller.restore()
    assert other.jobs.all == ()


def test_a_dismissed_training_keeps_its_folder_and_other_jobs_go(world, tmp_path):
    training, other = world.start(), world.start("match")
    for id in (training, other):
        world.say(id, {"event": "result"})
        world.process(id).ended(0, "")
        world.jobs.dismiss(id)
    assert [job.id for job in world.jobs.all] == [training]
    assert world.jobs.listed == ()
    assert [path.name for path in tmp_path.iterdir()] == [training]


def test_a_running_job_cannot_be_dismissed(world, tmp_path):
    id = world.start()
    world.jobs.dismiss(id)
    assert (tmp_path / id / "job.json").exists()


def test_damaged_folders_are_left_alone(world, tmp_path, caplog):
    id = world.start()
    world.controller.stop()
    for name, text in (("torn", '{"format": 1, "ki'), ("future", json.dumps({"format": 2})), ("list", "[]")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "job.json").write_text(text)
    after = World(tmp_path)
    after.controller.restore()
    assert [job.id for job in after.jobs.all] == [id]
    assert caplog.text.count("is left alone") == 3


def test_a_full_disk_is_a_message_and_the_job_goes_on(world, monkeypatch):
    def full(_path, _write):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("add_viewer.controllers.job_folders.write_atomically", full)
    id = world.start()
    assert world.jobs[id].state == "running"
    assert "No space left on device" in world.complaints[0]


def test_the_log_is_what_a_person_reads(world):
    id = world.start()
    folder = world.jobs[id].request.folder
    (folder / "output.jsonl").write_text(
        '{"event": "step", "step": 1}\n{"event": "validation", "step": 1, "auc": 0.91, "improved": true}\n'
    )
    (folder / "log.txt").write_text('{"event": "progress", "done": 1}\nOperator 3 was solved by ARPACK.\n')
    assert world.controller.log(id).splitlines() == [
        "validation: step 1, auc 0.91, the best so far",
        "Operator 3 was solved by ARPACK.",
    ]


def test_the_log_of_a_command_that_was_paused_and_went_on_is_in_the_order_of_events(world):
    id = world.start()
    folder = world.jobs[id].request.folder
    said = '{"event": "step", "step": 1}\n{"event": "validation", "step": %d}\n'
    (folder / "output.jsonl").write_text(f"\n{said % 1}\n\n{said % 3}")  # the second run said nothing
    (folder / "log.txt").write_text("Started on 1\nStopped 1\nStarted on 2\nKilled\nStarted on 3\n")
    assert world.controller.log(id).splitlines() == [
        *("Started on 1", "validation: step 1", "Stopped 1"),
        *("Started on 2", "Killed"),
        *("Started on 3", "validation: step 3"),
    ]
