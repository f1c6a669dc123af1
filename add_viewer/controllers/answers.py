"""What processes computed, by question: asked once, read off the window's thread, kept while there is room."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from psygnal import Signal

from ..models.jobs import Job, JobRequest, Jobs
from .running import Run, explain

ROOM = 800_000_000
"""Bytes of answers kept in memory; the spectra behind them are on disk, so that what is dropped comes back soon."""


class Question(Hashable, Protocol):
    """Something that one command of the core answers. Equal questions have one answer.

    kind : of the job. title : for people, "WKS of Person 1". file_name : of the output in the job's folder.
    """

    @property
    def kind(self) -> str: ...

    @property
    def title(self) -> str: ...

    @property
    def file_name(self) -> str: ...

    def arguments(self, output: Path) -> tuple[str, ...]:
        """What follows `add-core`."""

    def read(self, output: Path, said: Mapping[str, Any]) -> Any:
        """The answer, from the file and from what the command said last. Raises AddError or OSError."""


class Answers:
    """Asks through jobs. `arrived` carries a question that has been answered, or has failed."""

    arrived = Signal(object)
    progressed = Signal(object)

    def __init__(self, jobs: Jobs, run: Run, room: int = ROOM) -> None:
        self._jobs, self._run, self._room = jobs, run, room
        self._known: OrderedDict[Question, Any] = OrderedDict()
        self._asked: dict[str, Question] = {}
        self._pending: set[Question] = set()
        self._starting = False
        self._problems: dict[Question, str] = {}
        jobs.finished.connect(self._finished)
        jobs.changed.connect(self._changed)

    def get(self, question: Question) -> Any | None:
        """The answer, None if there is none yet."""
        if question in self._known:
            self._known.move_to_end(question)
        return self._known.get(question)

    def want(self, question: Question) -> Any | None:
        """The answer; if there is none yet, it is asked for. What has failed is not asked for again by itself."""
        known = self.get(question)
        if known is None and question not in self._problems and question not in self._pending:
            folder = self._jobs.new_folder(question.kind)
            arguments = question.arguments(folder / question.file_name)
            self._asked[folder.name] = question
            self._pending.add(question)
            self._starting = True  # what listens to progress may ask for more, but not in the middle of a start
            try:
                self._jobs.start(JobRequest(question.kind, _capital(question.title), arguments, folder))
            finally:
                self._starting = False
        return known

    def message(self, question: Question) -> str:
        """What is happening to a question, in words: "Computing WKS of Person 1 … 40 %"."""
        if question in self._problems:
            return f"{_capital(question.title)}: {self._problems[question]}"
        id = next((id for id, asked in reversed(self._asked.items()) if asked == question), None)
        job = self._jobs[id] if id is not None and id in self._jobs else None
        share = f" {100 * job.share:.0f} %" if job is not None and job.share else ""
        return f"Computing {question.title} …{share}"

    def is_asked(self, question: Question) -> bool:
        """Whether a process is at it."""
        return question in self._pending

    def has_failed(self, question: Question) -> bool:
        """Whether it was asked for in vain."""
        return question in self._problems

    def forget_problems(self) -> None:
        """Let what has failed be asked for again: the person has chosen anew."""
        self._problems.clear()

    def _changed(self, id: str) -> None:
        if id in self._asked and id in self._jobs:
            if not self._jobs[id].is_finished:
                self._problems.pop(self._asked[id], None)  # tried again from the list of jobs
                self._pending.add(self._asked[id])
            if not self._starting:
                self.progressed.emit(self._asked[id])

    def _finished(self, id: str) -> None:
        question = self._asked.get(id)
        if question is None:
            return
        job = self._jobs[id]
        if job.state != "done":
            reason = "was cancelled. Choose it again to compute it." if job.state == "cancelled" else job.message
            self._fail(question, reason)
            return
        self._run(
            "answers",
            lambda: question.read(job.request.folder / question.file_name, job.result),
            done=lambda answer: self._read(job, question, answer),
            failed=lambda error: self._fail(question, explain(error)),
            queue=True,
        )

    def _read(self, job: Job, question: Question, answer: Any) -> None:
        self._asked.pop(job.id, None)
        self._pending.discard(question)
        self._known[question] = answer
        while len(self._known) > 1 and sum(map(_size, self._known.values())) > self._room:
            self._known.popitem(last=False)
        self._jobs.dismiss(job.id)  # its files are read
        self.arrived.emit(question)

    def _fail(self, question: Question, reason: str) -> None:
        self._pending.discard(question)
        self._problems[question] = reason
        self.arrived.emit(question)


def _capital(title: str) -> str:
    """The title with a capital, unless its first word is a name with capitals of its own: mADD3."""
    first = title.partition(" ")[0]
    return title[:1].upper() + title[1:] if first == first.lower() else title


def _size(answer: Any) -> int:
    """Bytes of the arrays that an answer is or holds."""
    arrays = [answer] if isinstance(answer, np.ndarray) else vars(answer).values()
    return sum(array.nbytes for array in arrays if isinstance(array, np.ndarray))
