"""Trainings: started from a request, followed by their curves, offered as descriptors while they still learn."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

from psygnal import Signal

from ..models.job_words import moment_of
from ..models.jobs import Job, JobRequest, Jobs
from ..models.training import MODEL_FILE, TrainingRequest, problem_of_data
from ..models.training_curves import TrainingCurves

KIND = "train"
INPUTS = MODEL_FILE.parent / "inputs"
"""Prepared inputs of a training, gigabytes of them: of no use once it is done."""


class TrainingController:
    """Starts trainings and keeps their curves.

    curves_changed : the id of a training whose curves grew. models_changed : the path of a model that is new or
    better, "" if one is gone.
    """

    curves_changed = Signal(str)
    models_changed = Signal(str)

    def __init__(self, jobs: Jobs, dispose: Callable[[Path], object], report: Callable[[str], None]) -> None:
        self._jobs, self._dispose, self._report = jobs, dispose, report
        self._curves: dict[str, TrainingCurves] = {}
        jobs.said.connect(self._hear)
        jobs.finished.connect(self._finished)

    @property
    def runs(self) -> tuple[Job, ...]:
        """All trainings, the newest first."""
        return tuple(job for job in reversed(self._jobs.all) if job.request.kind == KIND)

    def start(self, request: TrainingRequest) -> str | None:
        """Begin a training; returns its id, or None if it cannot begin."""
        if find_spec("torch") is None or find_spec("safetensors") is None:
            self._report(
                "Training needs torch and safetensors, which are not installed. Run: pip install torch safetensors"
            )
            return None
        problem = problem_of_data(request.data)
        if problem:
            self._report(problem)
            return None
        folder = self._jobs.new_folder(KIND)
        id = folder.name
        self._curves[id] = TrainingCurves()
        title = self._own_title(request.title)
        return self._jobs.start(JobRequest(KIND, title, request.arguments(folder), folder, resumable=True))

    def _own_title(self, title: str) -> str:
        """`title`, with a number if another training has it."""
        taken = {job.request.title for job in self.runs}
        numbered = (f"{title}, no. {number}" for number in range(2, len(taken) + 3))
        return title if title not in taken else next(each for each in numbered if each not in taken)

    def curves(self, id: str) -> TrainingCurves:
        """The curves so far; those of an earlier window come in a moment."""
        if id not in self._curves:
            self._curves[id] = TrainingCurves()
            if id in self._jobs and self._jobs[id].state != "waiting":
                self._jobs.recall(id)
        return self._curves[id]

    def model(self, id: str) -> Path | None:
        """The training's best model so far, None before its first validation."""
        path = self._jobs[id].request.folder / MODEL_FILE if id in self._jobs else None
        return path if path is not None and path.exists() else None

    def models(self) -> list[tuple[str, str]]:
        """Titles and paths of all models, the newest training's first."""
        found = [(job, self.model(job.id)) for job in self.runs]
        return [(f"{job.request.title} ({moment_of(job)})", str(path)) for job, path in found if path is not None]

    def delete(self, id: str) -> None:
        """Forget a training that does not run, with its model."""
        if id in self._jobs and self._jobs[id].state not in ("running", "waiting"):
            folder = self._jobs[id].request.folder
            self._curves.pop(id, None)
            self._jobs.remove(id)
            self._dispose(folder)
            self.models_changed.emit("")

    def _hear(self, id: str, event: dict[str, object]) -> None:
        if id not in self._jobs or self._jobs[id].request.kind != KIND:
            return
        if self._curves.setdefault(id, TrainingCurves()).hear(event):
            self.curves_changed.emit(id)
        if event["event"] == "validation" and event.get("improved", True):
            self._announce(id)

    def _finished(self, id: str) -> None:
        job = self._jobs[id]
        if job.request.kind == KIND and job.state == "done":
            self._dispose(job.request.folder / INPUTS)
            self._announce(id)

    def _announce(self, id: str) -> None:
        path = self.model(id)
        if path is not None:
            self.models_changed.emit(str(path))
