"""Running a job of many operators: where its eigenfunctions are kept, who solves it, and how it is stopped."""

from __future__ import annotations

import logging
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

from .._check import FloatArray
from ..eigensolver.job import EIGENFUNCTIONS, SpectralJob
from ..eigensolver.solver import PencilSolver
from ..errors import Cancelled
from .cache import Arrays, SpectraCache, remove_abandoned
from .processes import Solved, WorkerPool, WorkersUnavailable, solve_here

_log = logging.getLogger(__name__)

Progress = Callable[[int, int], object]

_SCRATCH = "add-core-spectra-"

SMALL = 1e9
"""Below this much work, counted as C·n·K², a job is done before worker processes have started."""

MOST_WORKERS = 4
"""Beyond this the memory's bandwidth is shared out rather than used better."""


def default_workers(operators: int, vertices: int, count: int) -> int:
    """One process per core, but none beside this one for little work."""
    if operators * vertices * float(count) ** 2 < SMALL:
        return 1
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(cores, MOST_WORKERS, operators)


def run_job(
    prepare: Callable[[], SpectralJob],
    *,
    workers: int,
    progress: Progress | None,
    store: SpectraCache | None,
    key: str,
    label: str,
) -> Arrays:
    """Eigenvalues (C, K), eigenfunctions (C, n, K), mass (n,) and fallbacks (C,) of a job, kept in `store` if there
    is one.

    prepare : builds the job; worker processes start meanwhile.
    Trouble with processes or disks costs a warning, never the result. Raises Cancelled, and what `progress` raises.
    """
    with ExitStack() as stack:
        pool = _pool(workers, stack)
        job = prepare()
        try:
            folder = _scratch(job, store, needed=pool is not None, stack=stack)
            found = _solved(job, pool, folder, progress)
            if folder is None:
                return found
            if store is not None and folder.parent == store.folder:
                return store.commit(folder, key, found, label)
            return found | {"eigenfunctions": _taken_over(folder / EIGENFUNCTIONS)}
        except WorkersUnavailable as error:
            _log.warning("Solving in this process instead: %s.", error)
        except _StoppedByCaller as stopped:
            raise stopped.reason from None
        except OSError as error:
            _log.warning("Spectra are kept in memory only: %s.", error)
        try:
            return _solved(job, None, None, progress)
        except _StoppedByCaller as stopped:
            raise stopped.reason from None


class _StoppedByCaller(Exception):
    """Carries what `progress` raised past the handling of our own trouble with disks and processes."""

    def __init__(self, reason: Exception) -> None:
        self.reason = reason


def _report(progress: Progress | None, done: int, total: int) -> None:
    if progress is None:
        return
    try:
        wanted = progress(done, total)
    except Exception as error:
        raise _StoppedByCaller(error) from error
    if wanted is False:
        raise _StoppedByCaller(Cancelled(f"Stopped on request after {done} of {total} operators."))


def _pool(workers: int, stack: ExitStack) -> WorkerPool | None:
    if workers < 2:
        return None
    try:
        pool = WorkerPool(workers)
    except WorkersUnavailable as error:
        _log.warning("Solving in this process instead: %s.", error)
        return None
    stack.callback(pool.close)
    return pool


def _scratch(job: SpectralJob, store: SpectraCache | None, *, needed: bool, stack: ExitStack) -> Path | None:
    """Where eigenfunctions go while they are computed: beside the cache's entries, else in a temporary folder, else
    memory.
    """
    size = job.output_bytes + (job.values.nbytes + job.indices.nbytes if needed else 0) + 2**20
    if store is not None:
        try:
            return stack.enter_context(store.scratch(size))
        except OSError as error:
            _log.warning("Spectra cannot be cached: %s.", error)
    if not needed:
        return None
    remove_abandoned(Path(tempfile.gettempdir()), _SCRATCH)
    return Path(stack.enter_context(tempfile.TemporaryDirectory(prefix=_SCRATCH, ignore_cleanup_errors=True)))


def _solved(job: SpectralJob, pool: WorkerPool | None, folder: Path | None, progress: Progress | None) -> Arrays:
    """Everything but eigenfunctions, which are in the folder; or everything, where there is none."""
    shape = job.output_shape
    output = np.empty(shape, job.dtype) if folder is None else None
    source: Iterator[Solved]
    if folder is not None:
        job.create_output(folder)
    if pool is not None and folder is not None:
        inputs = folder / "inputs"
        inputs.mkdir()
        job.save(inputs)
        PencilSolver(job.indptr, job.indices, job.mass).order.save(inputs)
        source = pool.solve(job, folder)
    else:
        source = solve_here(job, _writer(job, folder, output))
    eigenvalues, fallbacks = np.empty((shape[0], shape[2])), [""] * shape[0]
    _report(progress, 0, shape[0])
    for done, solved in enumerate(source, start=1):
        eigenvalues[solved.channel], fallbacks[solved.channel] = solved.values, solved.fallback
        if solved.fallback:
            _log.warning("Operator %d was solved by the %s.", solved.channel, solved.fallback)
        _report(progress, done, shape[0])
    if pool is not None and folder is not None:
        pool.close()  # before its inputs go: Windows deletes no file that is mapped
        shutil.rmtree(folder / "inputs")
    found: Arrays = {"eigenvalues": eigenvalues, "mass": job.mass, "fallbacks": np.array(fallbacks)}
    return found if output is None else found | {"eigenfunctions": output}


def _taken_over(path: Path) -> np.ndarray[Any, Any]:
    """An array whose file is about to go: mapped where a file may go while it is mapped, else copied to memory."""
    return np.asarray(np.load(path, mmap_mode=None if os.name == "nt" else "r", allow_pickle=False))


def _writer(
    job: SpectralJob, folder: Path | None, output: np.ndarray[Any, Any] | None
) -> Callable[[int, FloatArray], None]:
    def write(channel: int, functions: FloatArray) -> None:
        if output is not None:
            output[channel] = functions
        elif folder is not None:
            job.write_output(folder, channel, functions)

    return write
