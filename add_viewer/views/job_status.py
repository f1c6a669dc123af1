"""The running job in the status bar."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QStatusBar, QToolButton, QWidget

from ..models.job_words import time_words
from ..models.jobs import Job, Jobs
from .beat import Beat
from .icons import icon
from .share_bar import ShareBar
from .theme import GRID, Theme


class JobStatus(QWidget):
    """What runs, how far it is, and a button that ends it; nothing where nothing runs.

    opened : the person wants to see all jobs.
    """

    opened = Signal()

    def __init__(self, jobs: Jobs, beat: Beat, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._jobs, self._shown = jobs, ""
        self.label, self.cancel_button, self.progress = QToolButton(), QToolButton(), ShareBar()
        self._build()
        jobs.changed.connect(lambda id: beat.ask(self._show_job))
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
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(GRID // 2)
        for widget in (self.label, self.progress, self.cancel_button):
            row.addWidget(widget)

    def keep_room(self, bar: QStatusBar) -> None:
        """Let the status bar be as high without a job as with one, so that nothing moves when one begins."""
        was_hidden = self.isHidden()
        self.show()
        bar.setMinimumHeight(bar.sizeHint().height())
        self.setHidden(was_hidden)

    def _show_job(self) -> None:
        running = [job for job in self._jobs.all if job.state == "running"]
        self.setVisible(bool(running))
        if not running:
            self._shown = ""
            return
        job = running[-1]
        self._say(_sentence(job, len(running) - 1), is_new=job.id != self._shown)
        self._shown = job.id
        self.progress.show_share(job.share)
        self.cancel_button.setVisible(job.can("cancel"))

    def _say(self, words: str, *, is_new: bool) -> None:
        """The room for the words of one job grows but does not shrink: nothing moves for each second less."""
        self.label.setText(words)
        needed = self.label.sizeHint()
        if is_new or needed.width() > self.label.width():
            self.label.setFixedSize(needed)

    def show_theme(self, theme: Theme) -> None:
        """The button in the theme's colour."""
        self.cancel_button.setIcon(icon("mdi6.close", theme.muted))


def _sentence(job: Job, others: int) -> str:
    words = [job.request.title]
    if job.seconds_left is not None:
        words.append(f"{time_words(job.seconds_left)} left")
    return " · ".join(words) + (f" (and {others} more)" if others else "")
