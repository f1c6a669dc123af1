"""Background work in the window: the list of jobs, and the running one in the status bar."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget

from ..models.jobs import Jobs
from .job_status import JobStatus
from .jobs_panel import JobsPanel
from .theme import Theme

if TYPE_CHECKING:
    from .main_window import MainWindow


class BackgroundViews:
    """Puts what shows background work into the window."""

    def __init__(self, window: MainWindow, jobs: Jobs, read_log: Callable[[str], str]) -> None:
        self._jobs = jobs
        self.panel, self.status = JobsPanel(jobs, read_log), JobStatus(jobs)
        self.jobs_dock = window.panels.add_beside(window.curve_dock, "Jobs", self.panel)
        window.statusBar().addPermanentWidget(self.status)
        self.status.opened.connect(self.open_jobs)
        window.menus.on("jobs", self.open_jobs)
        window.add_part(self)

    def open_jobs(self) -> None:
        """Bring the list of jobs to the front."""
        _bring_to_front(self.jobs_dock)

    def offer_to_go_on(self) -> None:
        """Show the list if an earlier window left something that can go on."""
        if any(job.state == "interrupted" for job in self._jobs.listed):
            self.open_jobs()

    def show_theme(self, theme: Theme) -> None:
        """Icons in the theme's colours."""
        self.panel.show_theme(theme)
        self.status.show_theme(theme)


def _bring_to_front(dock: QDockWidget) -> None:
    dock.show()
    dock.raise_()
    dock.widget().setFocus(Qt.FocusReason.OtherFocusReason)
