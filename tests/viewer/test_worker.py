"""The background thread: per lane, the newest request wins."""

import threading
import time

import pytest

from add_viewer.models.long_work import Cancelled, go_on


@pytest.fixture
def worker(qapp):
    from add_viewer.tasks.worker import Worker

    made = Worker()
    yield made
    made.stop()


def test_a_waiting_request_is_replaced_by_a_newer_one_of_its_lane(worker, qtbot):
    gate, answers = threading.Event(), []
    worker.submit("kernel", gate.wait, done=lambda _value: answers.append("first"), failed=answers.append)
    qtbot.waitUntil(lambda: not worker._waiting["kernel"])
    for number in range(5):
        worker.submit("kernel", lambda number=number: number, done=answers.append, failed=answers.append)
    gate.set()
    qtbot.waitUntil(lambda: 4 in answers)
    assert answers == ["first", 4]


def test_a_kernel_overtakes_waiting_curves_and_queued_work_keeps_its_order(worker, qtbot):
    gate, answers = threading.Event(), []
    worker.submit("curves", gate.wait, done=lambda _value: None, failed=answers.append)
    qtbot.waitUntil(lambda: not worker._waiting["curves"])
    for lane, name in (("curves", "curve"), ("kernel", "kernel"), ("open", "a"), ("open", "b")):
        worker.submit(lane, lambda name=name: name, done=answers.append, failed=answers.append, queue=lane == "open")
    gate.set()
    qtbot.waitUntil(lambda: len(answers) == 4)
    assert answers == ["a", "b", "kernel", "curve"]


def test_errors_of_any_kind_reach_whoever_asked_on_the_window_s_thread(worker, qtbot):
    heard = []

    def work():
        raise RuntimeError("boom")

    worker.submit(
        "kernel", work, done=heard.append, failed=lambda error: heard.append((error, threading.current_thread()))
    )
    qtbot.waitUntil(lambda: bool(heard))
    error, thread = heard[0]
    assert str(error) == "boom"
    assert thread is threading.main_thread()


def test_no_answer_comes_after_the_end(qapp, qtbot):
    from add_viewer.tasks.worker import Worker

    worker, heard = Worker(), []
    worker.submit("kernel", lambda: 1, done=heard.append, failed=heard.append)
    worker.stop()
    qtbot.wait(50)
    assert heard == []
    assert not worker.isRunning()


def test_it_is_idle_once_everything_has_been_answered(worker, qtbot):
    answers = []
    assert worker.is_idle
    for number in range(3):  # the later two replace what waits
        worker.submit("kernel", lambda number=number: number, done=answers.append, failed=answers.append)
        assert not worker.is_idle
    worker.submit("curves", lambda: 1 / 0, done=answers.append, failed=answers.append)
    qtbot.waitUntil(lambda: worker.is_idle, timeout=5000)
    assert 2 in answers
    assert isinstance(answers[-1], ZeroDivisionError)


def test_work_that_asks_between_its_steps_ends_for_newer_and_begins_again_after_more_urgent(worker, qtbot):
    answers, begun, gate = [], [], threading.Event()

    def long_work(name):
        begun.append(name)
        gate.wait()
        go_on()
        return name

    worker.submit("curves", lambda: long_work("old"), done=answers.append, failed=answers.append)
    qtbot.waitUntil(lambda: begun == ["old"])
    worker.submit("kernel", lambda: "urgent", done=answers.append, failed=answers.append)
    gate.set()
    qtbot.waitUntil(lambda: worker.is_idle)
    assert (answers, begun) == (["urgent", "old"], ["old", "old"])
    gate.clear()
    worker.submit("curves", lambda: long_work("older"), done=answers.append, failed=answers.append)
    qtbot.waitUntil(lambda: begun[-1] == "older")
    worker.submit("curves", lambda: "newer", done=answers.append, failed=answers.append)
    gate.set()
    qtbot.waitUntil(lambda: worker.is_idle)
    assert answers[2:] == ["newer"]


def test_long_work_tells_how_far_it_is_and_can_be_cancelled(worker, qtbot, monkeypatch):
    monkeypatch.setattr("add_viewer.tasks.worker.PATIENCE", 0.0)
    told, failed, threads = [], [], set()

    def endless():
        while True:
            go_on(1, 4)
            time.sleep(0.001)

    worker.progressed.connect(lambda lane, share: told.append((lane, share)))
    worker.progressed.connect(lambda lane, share: threads.add(threading.current_thread()))
    worker.submit("kernel", endless, done=failed.append, failed=failed.append)
    qtbot.waitUntil(lambda: ("kernel", 0.25) in told)
    worker.cancel()
    qtbot.waitUntil(lambda: told[-1] == ("", 0.0) and worker.is_idle)
    assert isinstance(failed[0], Cancelled)
    assert threads == {threading.main_thread()}
    worker.submit("kernel", endless, done=failed.append, failed=failed.append)
    qtbot.waitUntil(lambda: told[-1] == ("kernel", 0.25))
    worker.stop()  # does not wait for ever
    assert len(failed) == 1
