"""The list of jobs: everything that runs, ran or waits in the background."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QStackedLayout,
    QVBoxLayout,
    QWidget,
)

from ..models.jobs import Job, Jobs
from .beat import Beat
from .elided_label import ElidedLabel
from .job_row import JobRow
from .theme import GRID, LIGHT, Theme

EMPTY = (
    "Spectra, trainings and evaluations that run in the background appear here,\n"
    "with their progress, the time they still take, and their log."
)


class JobsPanel(QWidget):
    """Shows `jobs` and asks them for what the person chooses. read_log : what a job's command said."""

    def __init__(self, jobs: Jobs, read_log: Callable[[str], str], beat: Beat, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._jobs, self._read_log, self._beat, self._theme = jobs, read_log, beat, LIGHT
        self.rows: dict[str, JobRow] = {}
        self.offer, self.resume_all = ElidedLabel(), QPushButton()
        self._offer_row = QWidget()
        self._list = QVBoxLayout()
        self._build()
        jobs.changed.connect(self._job_changed)
        self.resume_all.clicked.connect(self._resume_all)
        self._show_jobs()

    def _build(self) -> None:
        self.resume_all.setToolTip("Go on with every job that was interrupted")
        self.resume_all.setProperty("primary", True)
        row = QHBoxLayout(self._offer_row)
        row.setContentsMargins(2 * GRID, GRID, GRID, GRID)
        row.addWidget(self.offer, 1)
        row.addWidget(self.resume_all)
        listed = QWidget()
        column = QVBoxLayout(listed)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self._list.setSpacing(0)
        column.addWidget(self._offer_row)
        column.addLayout(self._list)
        column.addStretch(1)
        self._scroll = scroll = QScrollArea()
        scroll.setWidget(listed)
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        empty = QLabel(EMPTY)
        empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        empty.setWordWrap(True)
        empty.setProperty("role", "muted")
        self._stack = QStackedLayout(self)
        self._stack.addWidget(empty)
        self._stack.addWidget(scroll)

    # -- models to view -----------------------------------------------------------------------------------------------

    def _job_changed(self, id: str) -> None:
        row = self.rows.get(id)
        is_same = row is not None and id in self._jobs and self._jobs[id].state == row.job.state
        if not is_same:
            self._show_jobs()
        else:
            self._beat.ask(self._show_jobs)

    def _show_jobs(self) -> None:
        listed = self._jobs.listed
        for id in set(self.rows) - {job.id for job in listed}:
            self._remove(id)
        for job in listed:
            if job.id not in self.rows:
                self._add(job)
            row = self.rows[job.id]
            if row.job != job:
                row.show_job(job)
                self._show_log(job.id)
        stopped = [job for job in listed if job.state == "interrupted" and job.can("resume")]
        self._offer_row.setVisible(bool(stopped))
        what = f"{stopped[0].request.title} was" if len(stopped) == 1 else f"{len(stopped)} jobs were"
        self.offer.setText(f"{what} interrupted and can go on.")
        self.resume_all.setText("Resume" if len(stopped) == 1 else "Resume all")
        self._stack.setCurrentIndex(1 if listed else 0)

    def _add(self, job: Job) -> None:
        row = self.rows[job.id] = JobRow(job, self._theme)
        row.setFrameShape(QFrame.Shape.NoFrame)
        row.asked.connect(lambda verb, id=job.id: getattr(self._jobs, verb)(id))
        row.log_opened.connect(lambda on, id=job.id: self._open_log(id) if on else None)
        self._list.insertWidget(0, row)  # the newest first

    def _remove(self, id: str) -> None:
        row = self.rows.pop(id)
        self._list.removeWidget(row)
        row.hide()
        row.deleteLater()

    def _show_log(self, id: str) -> None:
        row = self.rows.get(id)
        if row is not None and row.log_button.isChecked() and self.isVisible():
            row.show_log(self._read_log(id))

    def _open_log(self, id: str) -> None:
        self._show_log(id)
        QTimer.singleShot(0, lambda: self._scroll.ensureWidgetVisible(self.rows[id]) if id in self.rows else None)

    def _resume_all(self) -> None:
        for job in self._jobs.listed:
            if job.state == "interrupted":
                self._jobs.resume(job.id)

    def show_theme(self, theme: Theme) -> None:
        """Icons in the theme's colours."""
        self._theme = theme
        for row in self.rows.values():
            row.show_theme(theme)
