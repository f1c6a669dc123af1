"""Long work: what was asked for, how far it is, and what can be done with it."""

from __future__ import annotations

import secrets
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from psygnal import Signal

State = Literal["waiting", "running", "done", "failed", "cancelled", "paused", "interrupted"]
Verb = Literal["cancel", "pause", "resume", "retry", "dismiss"]

FINAL = frozenset({"done", "failed", "cancelled"})
UNFINISHED = frozenset({"waiting", "running", "paused", "interrupted"})
LONG_KINDS = frozenset({"train", "evaluate"})
"""Kinds that go on for minutes to hours: nothing else has to wait for them."""


@dataclass(frozen=True)
class JobRequest:
    """One command of `add-core` to run beside the window.

    kind : "describe", "spectra", "train", "evaluate", "match" or "symmetry". title : for people, "mADD3 on People".
    arguments : what follows `add-core`, without --json, which is always added; no relative paths.
    folder : of its own, from `Jobs.new_folder`: holds job.json, what the command said, and its outputs.
    resumable : the same command goes on where it was stopped; other jobs begin anew.
    """

    kind: str
    title: str
    arguments: tuple[str, ...]
    folder: Path
    resumable: bool = False


@dataclass(frozen=True)
class Job:
    """A request and how far it is.

    done, total : steps of the present phase; total 0 while that is unknown. message : what is being done, or why it
    failed. result : what the command said last. seconds_left : of the present phase, None while unknown.
    hidden : no longer in the list of jobs, but its folder is kept.
    """

    id: str
    request: JobRequest
    state: State = "waiting"
    done: int = 0
    total: int = 0
    message: str = ""
    seconds_left: float | None = None
    result: Mapping[str, Any] = field(default_factory=dict)
    hidden: bool = False

    @property
    def share(self) -> float | None:
        """Of the present phase, 0 to 1; None while unknown."""
        return min(self.done / self.total, 1.0) if self.total > 0 else None

    @property
    def is_finished(self) -> bool:
        return self.state in FINAL

    def can(self, verb: Verb) -> bool:
        """Whether `verb` makes sense now."""
        goes_on = self.request.resumable
        allowed: dict[Verb, bool] = {
            "cancel": self.state in ("waiting", "running", "paused"),
            "pause": goes_on and self.state in ("waiting", "running"),
            "resume": goes_on and self.state in ("paused", "interrupted"),
            "retry": self.state in ("failed", "cancelled") or (self.state == "interrupted" and not goes_on),
            "dismiss": self.state in FINAL or self.state == "interrupted",
        }
        return allowed[verb]


class Jobs:
    """All jobs, in the order in which they were asked for.

    changed : the id of a job that is new, goes on or is gone. finished : the id of a job that is done, failed or
    cancelled, once. said : id and what its command said, line by line. asked : a verb and an id, for whoever runs jobs.
    """

    changed = Signal(str)
    finished = Signal(str)
    said = Signal(str, dict)
    asked = Signal(str, str)

    def __init__(self, home: Path) -> None:
        self.home = home
        self._jobs: dict[str, Job] = {}

    def __contains__(self, id: object) -> bool:
        return id in self._jobs

    def __getitem__(self, id: str) -> Job:
        return self._jobs[id]

    @property
    def all(self) -> tuple[Job, ...]:
        return tuple(self._jobs.values())

    @property
    def listed(self) -> tuple[Job, ...]:
        return tuple(job for job in self._jobs.values() if not job.hidden)

    def new_folder(self, kind: str) -> Path:
        """A place for the next job's files; it is made when the job starts."""
        return self.home / f"{time.strftime('%Y%m%d-%H%M%S')}-{kind}-{secrets.token_hex(3)}"

    # -- what is asked for --------------------------------------------------------------------------------------------

    def start(self, request: JobRequest) -> str:
        """Run a command as soon as it is its turn; returns the job's id, the name of its folder."""
        id = request.folder.name
        self.put(Job(id, request))
        self.asked.emit("start", id)
        return id

    def cancel(self, id: str) -> None:
        """End a job and what it started; what it has written so far stays."""
        self._ask("cancel", id)

    def pause(self, id: str) -> None:
        """Stop a job where it is, so that it can go on later, even after the app was closed."""
        self._ask("pause", id)

    def resume(self, id: str) -> None:
        """Go on with a job that was paused or interrupted."""
        self._ask("resume", id)

    def retry(self, id: str) -> None:
        """Run a job again that failed, or was cancelled or interrupted."""
        self._ask("retry", id)

    def dismiss(self, id: str) -> None:
        """Take a job that does not run off the list."""
        self._ask("dismiss", id)

    def recall(self, id: str) -> None:
        """Let what a job's command said before the app was started be said again."""
        if id in self._jobs:
            self.asked.emit("recall", id)

    def _ask(self, verb: Verb, id: str) -> None:
        if id in self._jobs and self._jobs[id].can(verb):
            self.asked.emit(verb, id)

    # -- what happened ------------------------------------------------------------------------------------------------

    def put(self, job: Job) -> None:
        """Say how far a job is."""
        before = self._jobs.get(job.id)
        if job == before:
            return
        self._jobs[job.id] = job
        self.changed.emit(job.id)
        if before is not None and job.is_finished and not before.is_finished:
            self.finished.emit(job.id)

    def remove(self, id: str) -> None:
        """Forget a job."""
        if self._jobs.pop(id, None) is not None:
            self.changed.emit(id)
