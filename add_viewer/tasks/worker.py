"""One background thread for short work: per lane, the newest request wins."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QObject, Qt, QThread, Signal, Slot

LANES = ("open", "kernel", "fields", "answers", "insights", "directions", "curves", "export", "rest")
"""In the order in which waiting work is taken up."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class _Job:
    work: Callable[[], Any]
    done: Callable[[Any], None]
    failed: Callable[[BaseException], None]


class Worker(QThread):
    """Runs work on its thread and answers on the window's; what waits is replaced by newer requests of its lane.

    Work that has begun is finished: it is short, and whoever asked drops late answers by ticket.
    """

    _answered = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._waiting: dict[str, list[_Job]] = {lane: [] for lane in LANES}
        self._condition = threading.Condition()
        self._stopping = False
        self._unanswered = 0
        self._answered.connect(self._answer, Qt.ConnectionType.QueuedConnection)

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
            self._waiting[lane].append(_Job(work, done, failed))
            self._condition.notify()
        if not self.isRunning():
            self.start(QThread.Priority.LowPriority)

    @property
    def is_idle(self) -> bool:
        """Whether everything that was asked for has been answered."""
        return self._unanswered == 0

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
            try:
                answer = (job.done, job.work())
            except BaseException as error:  # noqa: BLE001 - whatever it is, the person must hear of it
                answer = (job.failed, error)
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

    @Slot(object)
    def _answer(self, answer: tuple[Callable[[Any], None], Any]) -> None:
        if not self._stopping:
            callback, value = answer
            self._unanswered -= 1
            callback(value)
