"""The background thread: per lane, the newest request wins."""

import threading

import pytest


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
