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

_START = "import json, sys; sys.path[:] = json.loads(sys.argv[1]); from add_core.eigensolver.worker import main; main()"
"""The worker imports what the caller imports, from wherever the caller has it."""


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
        self._processes: list[subprocess.Popen[str]] = []
        if not sys.executable or getattr(sys, "frozen", False):  # a frozen app would start itself again
            raise WorkersUnavailable("this program has no Python interpreter of its own to start")
        self._said = tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace")  # a pipe could fill up and block
        try:
            for number in range(count):
                self._processes.append(_start(self._said))
                threading.Thread(target=self._listen, args=(number,), daemon=True).start()
        except OSError as error:
            self.close()
            raise WorkersUnavailable(f"worker processes cannot be started: {error}") from None

    def solve(self, job: SpectralJob, folder: Path) -> Iterator[Solved]:
        """Solve every operator of the job saved in `folder`; which worker takes which changes no number."""
        waiting = iter(range(len(job.values)))
        for number in range(len(self._processes)):
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
        for process in self._processes:
            process.kill()
        for process in self._processes:
            process.wait()
            for stream in (process.stdin, process.stdout):
                if stream is not None:
                    _close_quietly(stream)
        self._said.close()

    def _listen(self, number: int) -> None:
        stdout = self._processes[number].stdout
        assert stdout is not None
        try:
            for line in stdout:
                self._answers.put((number, line))
        except ValueError:  # closed while waiting
            return
        self._answers.put((number, ""))

    def _send_next(self, number: int, waiting: Iterator[int]) -> None:
        channel = next(waiting, None)
        if channel is not None:
            self._send(number, str(channel))

    def _send(self, number: int, line: str) -> None:
        stdin = self._processes[number].stdin
        assert stdin is not None
        try:
            stdin.write(line + "\n")
            stdin.flush()
        except OSError:
            raise WorkersUnavailable(f"a worker process ended by itself ({self._last_words(number)})") from None

    def _last_words(self, number: int) -> str:
        process = self._processes[number]
        process.kill()
        status = process.wait()
        self._said.seek(0)
        said = self._said.read().strip().splitlines()
        return said[-1] if said else f"exit status {status}"


def _start(said: IO[str]) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-P", "-c", _START, json.dumps(sys.path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=said,
        text=True,
        encoding="utf-8",
        env=os.environ | _ONE_THREAD | _KEPT_MEMORY,
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )


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
