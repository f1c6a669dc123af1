"""The running job in the status bar."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtWidgets import QHBoxLayout, QProgressBar, QToolButton, QWidget

from ..models.job_words import time_words
from ..models.jobs import Job, Jobs
from .icons import icon
from .theme import GRID, Theme

PATIENCE = 300
"""Milliseconds between two updates."""


class JobStatus(QWidget):
    """What runs, how far it is, and a button that ends it; nothing where nothing runs.

    opened : the person wants to see all jobs.
    """

    opened = Signal()

    def __init__(self, jobs: Jobs, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._jobs, self._shown = jobs, ""
        self.label, self.cancel_button, self.progress = QToolButton(), QToolButton(), QProgressBar()
        self._build()
        self._frame = QTimer(self, singleShot=True, interval=PATIENCE)
        self._frame.timeout.connect(self._show_job)
        jobs.changed.connect(lambda id: None if self._frame.isActive() else self._frame.start())
        self.label.clicked.connect(self.opened)
        self.cancel_button.clicked.connect(lambda: self._jobs.cancel(self._shown))
        self._show_job()

    def _build(self) -> None:
        self.label.setToolTip("Show all jobs")
        self.cancel_button.setToolTip("Cancel this job")
        self.cancel_button.setAccessibleName("Cancel the running job")
        self.cancel_button.setIconSize(QSize(14, 14))
        for button in (self.label, self.cancel_button):
            button.setProperty("quiet", True)
            button.setCursor(Qt.CursorShape.PointingHandCursor)
        self.progress.setFixedWidth(12 * GRID)
        self.progress.setTextVisible(False)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(GRID // 2)
        for widget in (self.label, self.progress, self.cancel_button):
            row.addWidget(widget)

    def _show_job(self) -> None:
        running = [job for job in self._jobs.all if job.state == "running"]
        self.setVisible(bool(running))
        if not running:
            self._shown = ""
            return
        job = running[-1]
        self._shown = job.id
        self.label.setText(_sentence(job, len(running) - 1))
        share = job.share
        self.progress.setRange(0, 0 if share is None else 1000)
        self.progress.setValue(0 if share is None else round(1000 * share))
        self.cancel_button.setVisible(job.can("cancel"))

    def show_theme(self, theme: Theme) -> None:
        """The button in the theme's colour."""
        self.cancel_button.setIcon(icon("mdi6.close", theme.muted))


def _sentence(job: Job, others: int) -> str:
    words = [job.request.title]
    if job.seconds_left is not None:
        words.append(f"{time_words(job.seconds_left)} left")
    return " · ".join(words) + (f" (and {others} more)" if others else "")
