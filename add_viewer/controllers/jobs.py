"""Running jobs: whose turn it is, what becomes of them, and how they outlive the window."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol

from ..models.jobs import LONG_KINDS, Job, Jobs, State
from ..models.progress import Pace, progress_of
from .job_folders import KeptJob, Stamp, forget, keep, kept_jobs, log_of
from .running import explain

MOST_AT_ONCE = 2
"""Jobs that run at the same time, at most one of them long: what somebody waits for never queues behind trainings."""

PASSING_KINDS = frozenset({"describe", "spectra", "match", "symmetry"})
"""Whoever asked for them is gone with the window; the next one asks anew, and finds their spectra in the cache."""
MOST_USED, _USED = 12, ("done", "cancelled")
"""Passing jobs that stay in the list when they are over; those that failed stay until a person dismisses them."""

_COMPLAINT = "add-core: "
_STOPPED_BY_OTHERS = frozenset({-15, -9, -2, 130})
"""Exit statuses of a command that was killed or told to stop, though not by this window."""
_STOPPING = "Stopping …"
_END_WORDS: dict[State, str] = {"cancelled": "Cancelled", "paused": "Paused; it goes on where it is"}

Events = Callable[[list[dict[str, Any]], bool], None]
Ended = Callable[[int | None, str], None]


class Process(Protocol):
    """A command that runs."""

    @property
    def identity(self) -> Any: ...

    def ask_to_end(self) -> None: ...

    def kill(self) -> None: ...


class Processes(Protocol):
    """What tasks offer: starting commands, and following those of an earlier window."""

    @property
    def window(self) -> Any: ...

    def is_alive(self, pid: int, began: str) -> bool: ...

    def start(self, arguments: Sequence[str], folder: Path, *, anew: bool, said: Events, ended: Ended) -> Process: ...

    def follow(self, pid: int, began: str, folder: Path, *, said: Events, ended: Ended) -> Process: ...

    def stop(self) -> None: ...


@dataclass
class _Running:
    """A process, its pace, and the state that a person wants instead of it."""

    process: Process
    pace: Pace = field(default_factory=Pace)
    wanted: State | None = None


class JobsController:
    """Does what `jobs` are asked; every change of state is on disk before it is shown."""

    def __init__(
        self,
        jobs: Jobs,
        processes: Processes,
        report: Callable[[str], None] = lambda text: None,
        *,
        dispose: Callable[[Path], object] = forget,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._jobs, self._processes, self._report = jobs, processes, report
        self._dispose, self._clock = dispose, clock
        self._running: dict[str, _Running] = {}
        verbs = {
            "start": self._enqueue,
            "cancel": lambda id: self._end(id, "cancelled"),
            "pause": lambda id: self._end(id, "paused"),
            "resume": self._enqueue,
            "retry": self._enqueue,
            "dismiss": self._dismiss,
            "recall": self._recall,
        }
        jobs.asked.connect(lambda verb, id: verbs[verb](id))

    def restore(self) -> None:
        """Take up the jobs of earlier windows: those that run are followed, those that were stopped can be resumed."""
        for kept in kept_jobs(self._jobs.home):
            job = kept.job
            if kept.window != self._window and self._is_alive(kept.window):
                continue  # another window's
            if job.request.kind in PASSING_KINDS:
                self._end_orphan(job, kept.process)
            elif job.state == "running":
                self._follow(job, kept.process)  # it may have ended meanwhile, well or badly: its output tells
            elif job.state == "waiting":
                self._put(replace(job, state="interrupted", message=_interruption(job)))
            else:
                self._jobs.put(job)

    def _end_orphan(self, job: Job, process: Stamp) -> None:
        """Nobody waits for its answer any more."""
        if self._is_alive(process):
            folder = job.request.folder
            self._processes.follow(process.pid, process.began, folder, said=_ignore, ended=_ignore).kill()
        self._dispose(job.request.folder)

    def stop(self) -> None:
        """End what runs and what waits, so that the next window can offer to go on with it."""
        for job in self._jobs.all:
            running = self._running.get(job.id)
            if running is not None:
                running.process.ask_to_end()
            if job.state in ("running", "waiting"):
                state: State = "interrupted" if running is None or running.wanted is None else running.wanted
                message = "Stopped when the app was closed" if state == "interrupted" else _END_WORDS[state]
                self._keep(replace(job, state=state, message=message, seconds_left=None))
        self._running.clear()
        self._processes.stop()

    def process_of(self, id: str) -> Stamp:
        """The process that runs a job; pid 0 if none does."""
        running = self._running.get(id)
        return Stamp() if running is None else Stamp.of(running.process.identity)

    def log(self, id: str) -> str:
        """What a job's command said, for a person."""
        return log_of(self._jobs[id].request.folder) if id in self._jobs else ""

    # -- what is asked for --------------------------------------------------------------------------------------------

    def _enqueue(self, id: str) -> None:
        if id in self._running:
            return  # whoever heard of it has asked for another job, which let this one begin
        waiting = replace(self._jobs[id], state="waiting", message="", result={}, hidden=False)
        self._put(replace(waiting, done=0, total=0))
        self._start_next()

    def _start_next(self) -> None:
        while len(self._running) < MOST_AT_ONCE:
            waiting = [job for job in self._jobs.all if job.state == "waiting"]
            is_busy = any(self._jobs[id].request.kind in LONG_KINDS for id in self._running)
            short = [job for job in waiting if job.request.kind not in LONG_KINDS]
            turn = short or ([] if is_busy else waiting)
            if not turn:
                return
            self._start(turn[0])

    def _start(self, job: Job) -> None:
        request, (said, ended) = job.request, self._ears(job.id)
        try:
            process = self._processes.start(
                request.arguments, request.folder, anew=not request.resumable, said=said, ended=ended
            )
        except OSError as error:
            self._fail(job, explain(error))
            return
        self._running[job.id] = _Running(process)
        self._put(replace(job, state="running", message="Starting …"))

    def _follow(self, job: Job, process: Stamp) -> None:
        said, ended = self._ears(job.id)
        found = self._processes.follow(process.pid, process.began, job.request.folder, said=said, ended=ended)
        self._running[job.id] = _Running(found)
        self._put(job)

    def _end(self, id: str, state: State) -> None:
        running = self._running.get(id)
        if running is None:
            self._put(replace(self._jobs[id], state=state, message=_END_WORDS[state], seconds_left=None))
            return
        running.wanted = state
        self._jobs.put(replace(self._jobs[id], message=_STOPPING, seconds_left=None))
        running.process.ask_to_end()

    def _dismiss(self, id: str) -> None:
        job = self._jobs[id]
        if job.request.kind == "train":  # its model is still of use
            self._put(replace(job, hidden=True))
        else:
            self._jobs.remove(id)
            self._dispose(job.request.folder)

    def _recall(self, id: str) -> None:
        if id in self._running:
            return

        def said(events: list[dict[str, Any]], _is_news: bool) -> None:
            for event in events:
                self._jobs.said.emit(id, event)

        self._processes.follow(0, "", self._jobs[id].request.folder, said=said, ended=_ignore)

    # -- what happens -------------------------------------------------------------------------------------------------

    def _ears(self, id: str) -> tuple[Events, Ended]:
        def said(events: list[dict[str, Any]], is_news: bool) -> None:
            self._hear(id, events, is_news=is_news)

        def ended(status: int | None, words: str) -> None:
            try:
                self._ended(id, status, words)
            finally:  # whatever becomes of one job, the others have their turn
                self._start_next()
                self._tidy()

        return said, ended

    def _hear(self, id: str, events: list[dict[str, Any]], *, is_news: bool) -> None:
        job, running = self._jobs[id], self._running[id]
        for event in events:
            progress = progress_of(event)
            if progress is not None:
                left = running.pace.seconds_left(progress, self._clock()) if is_news else None
                done, total, words = progress.done, progress.total, progress.words
                job = replace(job, done=done, total=total, message=words, seconds_left=left)
            elif event["event"] in ("result", "done"):
                job = replace(job, result={name: value for name, value in event.items() if name != "event"})
        if running.wanted is not None:
            job = replace(job, message=_STOPPING, seconds_left=None)
        self._jobs.put(job)
        for event in events:
            self._jobs.said.emit(id, event)

    def _ended(self, id: str, status: int | None, words: str) -> None:
        running, job = self._running.pop(id), replace(self._jobs[id], seconds_left=None)
        complaint = words.removeprefix(_COMPLAINT)
        if status == 0 or (status is None and job.result):
            self._put(replace(job, state="done", message=""))
        elif running.wanted is not None:
            self._put(replace(job, state=running.wanted, message=_END_WORDS[running.wanted]))
        elif _has_failed(status, words):
            self._fail(job, complaint or f"It ended with status {status} and said nothing.")
        else:
            self._put(replace(job, state="interrupted", message=_interruption(job)))

    def _tidy(self) -> None:
        """Take answers off the list that were used long ago: there is one for each shape and descriptor."""
        used = [job for job in self._jobs.all if job.request.kind in PASSING_KINDS and job.state in _USED]
        for job in used[: max(len(used) - MOST_USED, 0)]:
            self._dismiss(job.id)

    def _fail(self, job: Job, reason: str) -> None:
        self._put(replace(job, state="failed", message=reason))
        self._report(f"{job.request.title} failed: {reason} See its log under View → Panels → Jobs.")

    # -- on disk ------------------------------------------------------------------------------------------------------

    def _put(self, job: Job) -> None:
        self._keep(job)
        self._jobs.put(job)

    def _keep(self, job: Job) -> None:
        try:
            keep(KeptJob(job, self.process_of(job.id), self._window))
        except OSError as error:
            self._report(f"The job {job.request.title} cannot be kept on disk: {explain(error)}")

    def _is_alive(self, stamp: Stamp) -> bool:
        return self._processes.is_alive(stamp.pid, stamp.began)

    @property
    def _window(self) -> Stamp:
        return Stamp.of(self._processes.window)


def _ignore(*_: object) -> None:
    """Hears what nobody wants to know."""


def _has_failed(status: int | None, words: str) -> bool:
    """Rather than having been killed; the status of a process that an earlier window started is not known."""
    return words.startswith(_COMPLAINT) if status is None else status not in _STOPPED_BY_OTHERS


def _interruption(job: Job) -> str:
    return "It can go on where it was" if job.request.resumable else "It ended before it was done"
