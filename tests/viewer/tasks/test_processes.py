"""Commands of the core in real processes."""

from __future__ import annotations

import os
import signal
import subprocess
import time

import pytest
from PySide6.QtCore import QCoreApplication

from add_viewer.controllers.job_folders import log_of
from add_viewer.tasks.identity import ProcessIdentity, beginning
from add_viewer.tasks.processes import ProcessRunner
from add_viewer.tasks.tail import MOST_AT_ONCE, Tail


class Ears:
    """What a process said, and how it ended."""

    def __init__(self):
        self.events, self.news, self.ends = [], [], []

    def said(self, events, is_news):
        self.events += events
        self.news.append(is_news)

    def ended(self, status, words):
        self.ends.append((status, words))


@pytest.fixture
def ears():
    return Ears()


@pytest.fixture
def runner(qapp):
    made = ProcessRunner()
    yield made
    made.stop()


def wait_for(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        QCoreApplication.processEvents()
        time.sleep(0.01)
        assert time.monotonic() < end, "it did not happen"


SPECTRA = ("spectra", "humans/0", "--count", "300", "--alphas", "0,50", "--no-cache", "--workers", "2")


def test_a_command_says_its_progress_and_its_result(runner, ears, tmp_path):
    arguments = ("spectra", "humans/0", "--count", "5", "--angles", "2", "--alphas", "0", "--no-cache")
    runner.start(arguments, tmp_path / "job", anew=True, said=ears.said, ended=ears.ended)
    wait_for(lambda: ears.ends)
    ((status, words),) = ears.ends
    assert (status, words[:11]) == (0, "Started on ")
    assert {event["event"] for event in ears.events} == {"progress", "result"}
    assert all(ears.news)
    assert log_of(tmp_path / "job").startswith("Started on ")
    assert (tmp_path / "job" / "output.jsonl").read_text()[:2] == "\n{"  # where one run ends and the next begins


def test_a_mistake_ends_with_a_status_and_one_line(runner, ears, tmp_path):
    runner.start(("info", "unicorn.ply"), tmp_path / "job", anew=True, said=ears.said, ended=ears.ended)
    wait_for(lambda: ears.ends)
    ((status, words),) = ears.ends
    assert status == 2
    assert words.startswith("add-core: ")


def descendants(pid):
    """Numbers of the processes that `pid` started, and those that these started."""
    command = ["ps", "-o", "pid=", "--ppid", str(pid)]
    words = subprocess.run(command, capture_output=True, text=True, check=False).stdout.split()
    return [number for child in map(int, words) for number in (child, *descendants(child))]


def test_killing_a_command_ends_its_workers_too(runner, ears, tmp_path):
    process = runner.start(SPECTRA, tmp_path / "job", anew=True, said=ears.said, ended=ears.ended)
    wait_for(lambda: len(descendants(process.identity.pid)) == 2)
    workers = [ProcessIdentity.of(child) for child in descendants(process.identity.pid)]
    assert os.getpriority(os.PRIO_PROCESS, workers[0].pid) > os.getpriority(os.PRIO_PROCESS, 0)
    process.kill()
    wait_for(lambda: ears.ends and not any(worker.is_alive for worker in workers))
    assert [status for status, _ in ears.ends] == [-signal.SIGKILL]


def test_what_an_earlier_window_started_is_followed_and_said_again(runner, ears, tmp_path):
    process = runner.start(SPECTRA, tmp_path / "job", anew=True, said=lambda *_: None, ended=lambda *_: None)
    wait_for(lambda: "progress" in (tmp_path / "job" / "log.txt").read_text())
    next_window = ProcessRunner()
    identity = process.identity
    next_window.follow(identity.pid, identity.began, tmp_path / "job", said=ears.said, ended=ears.ended)
    wait_for(lambda: ears.events)
    assert ears.events[0] == {"event": "progress", "done": 0, "total": 17, "label": "Spectra"}
    assert ears.news[0] is False
    process.kill()
    wait_for(lambda: ears.ends)
    assert [status for status, _ in ears.ends] == [None]
    next_window.stop()


def test_a_process_is_its_number_and_its_beginning():
    me = ProcessIdentity.of(os.getpid())
    assert me.is_alive
    assert not ProcessIdentity(me.pid, "in another life").is_alive
    assert beginning(2**22 + 1) is None


def test_a_tail_gives_each_complete_line_once_and_a_long_file_in_pieces(tmp_path):
    path = tmp_path / "growing"
    tail = Tail(path)
    assert (tail.lines(), tail.has_more, tail.is_old) == ([], False, False)
    with path.open("a") as file:
        file.write("one\ntw")
        file.flush()
        assert tail.lines() == ["one"]
        file.write("o\n")
        file.flush()
        assert tail.lines() == ["two"]
    path.write_text("x" * 99 + "\n" * (2 * MOST_AT_ONCE))
    again = Tail(path)
    assert again.is_old
    assert len(again.lines()) < MOST_AT_ONCE
    assert again.has_more
