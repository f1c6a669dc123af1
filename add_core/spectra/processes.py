"""Solving the operators of a job one after another, here or in single-threaded processes of their own."""

from __future__ import annotations

import json
import logging
import os
import queue
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from threadpoolctl import threadpool_limits

from .._check import FloatArray
from ..eigensolver.job import SpectralJob
from ..eigensolver.solver import PencilSolver
from ..errors import ConvergenceError

_log = logging.getLogger(__name__)

_START = """import json, sys
path, further = json.loads(sys.argv[1])
sys.path[:] = path
from add_core.eigensolver.worker import main
main(*map(tuple, further))
"""
"""The worker imports what the caller imports, from wherever the caller has it."""

_FORKS = sys.platform == "linux"
"""One process imports and forks the other workers, which saves each a third of a second of CPU. Elsewhere libraries
do not survive a fork, or there is none.
"""


_ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1"
)
_KEPT_MEMORY = {"MALLOC_MMAP_THRESHOLD_": str(2**25), "MALLOC_TRIM_THRESHOLD_": str(2**29)}
"""glibc keeps what an operator frees for the next one: faulting it in anew is a twentieth of the work. Arrays above
32 MB, the most that it accepts here, still return to the system, so that peaks stay low on large shapes.
"""


class WorkersUnavailable(RuntimeError):
    """Worker processes cannot be started or died; the work can still be done here."""


@dataclass(frozen=True, eq=False)
class Solved:
    """One operator done: its number, its eigenvalues (K,), and what it took (0 where unknown)."""

    channel: int
    values: FloatArray
    fallback: str
    seconds: float = 0.0
    megabytes: float = 0.0


def solve_here(job: SpectralJob, write: Callable[[int, FloatArray], None]) -> Iterator[Solved]:
    """Solve every operator in this process; `write(channel, functions)` receives the eigenfunctions (n, K) of each."""
    solver = PencilSolver(job.indptr, job.indices, job.mass)
    for channel in range(len(job.values)):
        with threadpool_limits(1):  # results then do not depend on the number of cores
            pairs = solver.eigenpairs(job.values[channel], count=int(job.count), scale=float(job.scales[channel]))
        write(channel, pairs.functions)
        yield Solved(channel, pairs.values, pairs.fallback)


class WorkerPool:
    """Processes that wait for a job folder. Starting them takes a moment, so start early; `close` ends them at once."""

    def __init__(self, count: int) -> None:
        self._answers: queue.Queue[tuple[int, str]] = queue.Queue()
        self._workers: list[_Worker] = []
        if not sys.executable or getattr(sys, "frozen", False):  # a frozen app would start itself again
            raise WorkersUnavailable("this program has no Python interpreter of its own to start")
        self._said = tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace")  # a pipe could fill up and block
        try:
            while len(self._workers) < count:
                self._workers += _start(self._said, count if _FORKS else 1)
            for number in range(count):
                threading.Thread(target=self._listen, args=(number,), daemon=True).start()
        except OSError as error:
            self.close()
            raise WorkersUnavailable(f"worker processes cannot be started: {error}") from None

    def solve(self, job: SpectralJob, folder: Path) -> Iterator[Solved]:
        """Solve every operator of the job saved in `folder`; which worker takes which changes no number."""
        waiting = iter(range(len(job.values)))
        for number in range(len(self._workers)):
            self._send(number, json.dumps(str(folder)))
            self._send_next(number, waiting)
        for _ in range(len(job.values)):
            number, line = self._answers.get()
            if not line:
                raise WorkersUnavailable(f"a worker process ended by itself ({self._last_words(number)})")
            answer = json.loads(line)
            if "error" in answer:
                raise _error_of(answer)
            self._send_next(number, waiting)
            answer["values"] = np.array(answer["values"])
            yield Solved(**answer)

    def close(self) -> None:
        for worker in self._workers:
            _close_quietly(worker.requests)  # ends it, whatever it is doing
        for worker in self._workers:
            try:
                worker.process.wait(timeout=5)
            except subprocess.TimeoutExpired:
                worker.process.kill()
                worker.process.wait()
            _close_quietly(worker.answers)
        self._said.close()

    def _listen(self, number: int) -> None:
        try:
            for line in self._workers[number].answers:
                self._answers.put((number, line))
        except ValueError:  # closed while waiting
            return
        self._answers.put((number, ""))

    def _send_next(self, number: int, waiting: Iterator[int]) -> None:
        channel = next(waiting, None)
        if channel is not None:
            self._send(number, str(channel))

    def _send(self, number: int, line: str) -> None:
        requests = self._workers[number].requests
        try:
            requests.write(line + "\n")
            requests.flush()
        except OSError:
            raise WorkersUnavailable(f"a worker process ended by itself ({self._last_words(number)})") from None

    def _last_words(self, number: int) -> str:
        process = self._workers[number].process
        try:
            status = process.wait(timeout=0.5)
        except subprocess.TimeoutExpired:  # it lives: one that it has forked has ended
            status = None
        self._said.seek(0)
        said = self._said.read().strip().splitlines()
        return said[-1] if said else "no reason given" if status is None else f"exit status {status}"


@dataclass(frozen=True, eq=False)
class _Worker:
    """The process that it is or that has forked it, and the caller's ends of the pipes to it."""

    process: subprocess.Popen[str]
    requests: IO[str]
    answers: IO[str]


def _start(said: IO[str], count: int) -> list[_Worker]:
    """A process that forks all but the first of `count` workers."""
    pipes = [(os.pipe(), os.pipe()) for _ in range(count - 1)]
    theirs = [(requests[0], answers[1]) for requests, answers in pipes]
    ours = [(requests[1], answers[0]) for requests, answers in pipes]
    try:
        process = subprocess.Popen(
            [sys.executable, "-P", "-c", _START, json.dumps([sys.path, theirs])],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=said,
            text=True,
            encoding="utf-8",
            env=os.environ | _ONE_THREAD | _KEPT_MEMORY,
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            pass_fds=[end for ends in theirs for end in ends],
        )
    except OSError:
        _close_all(ours)
        raise
    finally:
        _close_all(theirs)
    assert process.stdin is not None
    assert process.stdout is not None
    forked = [
        _Worker(process, os.fdopen(requests, "w", encoding="utf-8"), os.fdopen(answers, encoding="utf-8"))
        for requests, answers in ours
    ]
    return [_Worker(process, process.stdin, process.stdout), *forked]


def _close_all(pairs: list[tuple[int, int]]) -> None:
    for pair in pairs:
        for end in pair:
            os.close(end)


def _close_quietly(stream: Any) -> None:
    try:
        stream.close()
    except OSError:  # a pipe whose other end is gone, with a line still unsent
        _log.debug("a worker's pipe was closed unsent")


def _error_of(answer: dict[str, Any]) -> Exception:
    if answer.get("code") is not None:
        return OSError(answer["code"], answer["error"])
    if answer["error"].startswith("MemoryError"):
        return MemoryError(answer["error"])
    return ConvergenceError(answer["error"])
