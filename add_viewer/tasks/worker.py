"""One background thread for short work: per lane, the newest request wins."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from PySide6.QtCore import QObject, Qt, QThread, Signal, Slot

from ..models.long_work import Cancelled, Interrupted, listening

LANES = ("open", "kernel", "fields", "answers", "insights", "directions", "curves", "export", "rest")
"""In the order in which waiting work is taken up."""

PATIENCE = 0.7
"""Seconds after which work tells how far it is: most is done before anybody could read it."""
_TELL = 0.1
"""Seconds between two such messages."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class _Job:
    lane: str
    work: Callable[[], Any]
    done: Callable[[Any], None]
    failed: Callable[[BaseException], None]
    queue: bool


class Worker(QThread):
    """Runs work on its thread and answers on the window's; what waits is replaced by newer requests of its lane.

    Work that has begun is finished, unless it asks between its steps (`models.long_work`): then it ends for a newer
    request of its lane, begins again after what waits in an earlier lane, and can be cancelled.
    progressed : lane and share of work that takes longer than `PATIENCE`; "" and 0 when it is over.
    """

    progressed = Signal(str, float)
    _stepped = Signal(str, float)
    _answered = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._waiting: dict[str, list[_Job]] = {lane: [] for lane in LANES}
        self._condition = threading.Condition()
        self._stopping = self._cancelling = False
        self._unanswered = 0
        self._begun = self._told = 0.0
        self._answered.connect(self._answer, Qt.ConnectionType.QueuedConnection)
        # Whoever listens draws, and is perhaps no QObject: only from the window's thread may it be called.
        self._stepped.connect(self._pass_on, Qt.ConnectionType.QueuedConnection)

    def submit(
        self,
        lane: str,
        work: Callable[[], Any],
        *,
        done: Callable[[Any], None],
        failed: Callable[[BaseException], None],
        queue: bool = False,
    ) -> None:
        """Do `work` soon, then call `done` with its result or `failed` with its error, on the window's thread.

        queue : wait behind the lane's earlier requests instead of replacing them (several files opened at once).
        """
        with self._condition:
            if not queue:
                self._unanswered -= len(self._waiting[lane])
                self._waiting[lane].clear()
            self._unanswered += 1
            self._waiting[lane].append(_Job(lane, work, done, failed, queue))
            self._condition.notify()
        if not self.isRunning():
            self.start(QThread.Priority.LowPriority)

    @property
    def is_idle(self) -> bool:
        """Whether everything that was asked for has been answered."""
        return self._unanswered == 0

    def cancel(self) -> None:
        """End the running work at its next step, as an error of whoever asked."""
        self._cancelling = True

    def stop(self) -> None:
        """Forget what waits, let the running job end, and end the thread."""
        with self._condition:
            self._stopping = True
            for jobs in self._waiting.values():
                jobs.clear()
            self._condition.notify()
        self.wait()

    def run(self) -> None:
        while (job := self._next()) is not None:
            self._begun, self._told, self._cancelling = time.monotonic(), 0.0, False
            try:
                with listening(partial(self._step, job)):
                    answer: tuple[Callable[[Any], None], Any] = (job.done, job.work())
            except Interrupted:
                self._set_aside(job)
                continue
            except BaseException as error:  # noqa: BLE001 - whatever it is, the person must hear of it
                answer = (job.failed, error)
            finally:
                if self._told:
                    self._stepped.emit("", 0.0)
            if not self._stopping:
                self._answered.emit(answer)

    def _next(self) -> _Job | None:
        with self._condition:
            while not self._stopping:
                for jobs in self._waiting.values():
                    if jobs:
                        return jobs.pop(0)
                self._condition.wait()
        return None

    def _step(self, job: _Job, done: int, total: int) -> None:
        """Between two steps of the running job, on its thread."""
        if self._cancelling:
            raise Cancelled("Cancelled. Whatever you change next starts it anew.")
        if self._stopping or self._is_overtaken(job):
            raise Interrupted
        now = time.monotonic()
        if now - self._begun > PATIENCE and now - self._told > _TELL:
            self._told = now
            self._stepped.emit(job.lane, done / total)

    def _is_overtaken(self, job: _Job) -> bool:
        """Whether something waits in an earlier lane, or something newer in the job's own."""
        lanes = LANES[: LANES.index(job.lane) + (not job.queue)]
        return any(self._waiting[lane] for lane in lanes)

    def _set_aside(self, job: _Job) -> None:
        """Let an interrupted job begin again later, unless a newer one takes its place."""
        with self._condition:
            if self._waiting[job.lane] and not job.queue:
                self._unanswered -= 1
            elif not self._stopping:
                self._waiting[job.lane].insert(0, job)

    @Slot(object)
    def _answer(self, answer: tuple[Callable[[Any], None], Any]) -> None:
        if not self._stopping:
            callback, value = answer
            self._unanswered -= 1
            callback(value)

    @Slot(str, float)
    def _pass_on(self, lane: str, share: float) -> None:
        if not self._stopping:
            self.progressed.emit(lane, share)
