"""A process that solves operators of a job folder: numbers of operators come in on stdin, results go out on stdout.

Started as a program of its own, not by forking the caller or by `multiprocessing`: it never imports the caller's
script, so a script needs no `if __name__ == "__main__"`, and no lock or thread of a window or of OpenBLAS is copied
half-way. Where that is safe it forks further workers once it has all that they need, imports and symbolic
factorisation, and before it has any thread. Each ends when its input closes, so nothing stays behind when the caller is
killed.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from ..errors import AddError
from .job import SpectralJob
from .ordering import Dissection
from .solver import PencilSolver


def main(*further: tuple[int, int]) -> None:
    """Serve until stdin closes, and in a forked process for each of `further`, file descriptors to read and to answer.

    The first line is the job folder, each further line the number of an operator.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the caller decides what ends
    ends = [(os.dup(0), os.dup(1)), *further]
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)  # whatever a library prints must not mix with the answers
    first = os.fdopen(ends[0][0], encoding="utf-8")
    said = first.readline()
    if not said:
        return
    folder = Path(json.loads(said))
    job = SpectralJob.load(folder / "inputs")
    solver = PencilSolver(job.indptr, job.indices, job.mass, Dissection.load(folder / "inputs"))
    if further:
        _ = solver.tree  # found once for all
    gc.freeze()  # all this is no garbage
    number, children = _forked(len(further))
    for source, target in {*ends} - {ends[number]}:  # a pipe ends only when nobody holds it any more
        os.close(source)
        os.close(target)
    requests = first
    if number > 0:
        requests = os.fdopen(ends[number][0], encoding="utf-8")
        requests.readline()  # the folder, which is known
    _serve(requests, ends[number][1], children, lambda channel: _answer(job, solver, folder, channel))


def _forked(count: int) -> tuple[int, list[int]]:
    """Which worker this process is now, 0 … count, and the processes that it has forked: `count` of them, or none."""
    children: list[int] = []
    for number in range(1, count + 1):
        child = os.fork()
        if child == 0:
            return number, []
        children.append(child)
    return 0, children


def _serve(lines: TextIO, target: int, children: list[int], answer: Callable[[int], dict[str, Any]]) -> None:
    answers = os.fdopen(target, "w", encoding="utf-8")
    requests: queue.Queue[str] = queue.Queue()
    threading.Thread(target=_read, args=(lines, requests, children), daemon=True).start()
    while True:
        answers.write(json.dumps(answer(int(requests.get()))) + "\n")
        answers.flush()


def _read(lines: TextIO, requests: queue.Queue[str], children: list[int]) -> None:
    for line in lines:
        requests.put(line)
    for child in children:  # their input has ended too; who waits for this process then has their CPU time as well
        os.waitpid(child, 0)
    os._exit(0)  # the caller is gone, perhaps in the middle of an operator


def _answer(job: SpectralJob, solver: PencilSolver, folder: Path, channel: int) -> dict[str, Any]:
    began = time.process_time()
    try:
        pairs = solver.eigenpairs(np.array(job.values[channel]), count=int(job.count), scale=float(job.scales[channel]))
        job.write_output(folder, channel, pairs.functions)
    except (AddError, OSError, MemoryError) as error:
        return {"channel": channel, "error": f"{type(error).__name__}: {error}", "code": getattr(error, "errno", None)}
    return {
        "channel": channel,
        "values": pairs.values.tolist(),
        "fallback": pairs.fallback,
        "seconds": time.process_time() - began,
        "megabytes": _peak_megabytes(),
    }


def _peak_megabytes() -> float:
    """Largest resident memory of this process so far; 0 where the system does not say."""
    # Linux counts a parent's peak among that of a process that it starts, except here.
    with contextlib.suppress(OSError):
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 2**10
    try:
        import resource
    except ImportError:  # Windows
        return 0.0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (2**20 if sys.platform == "darwin" else 2**10)


if __name__ == "__main__":
    main()
