"""Background work in the window: the list of jobs, the running one in the status bar, and trainings."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget

from ..models.jobs import Jobs
from ..models.results import Notice
from .beat import Beat
from .job_status import JobStatus
from .jobs_panel import JobsPanel
from .theme import Theme
from .training_panel import TrainingPanel, Trainings

if TYPE_CHECKING:
    from .main_window import MainWindow


class BackgroundViews:
    """Puts what shows background work into the window."""

    def __init__(self, window: MainWindow, jobs: Jobs, read_log: Callable[[str], str], trainings: Trainings) -> None:
        self._jobs, self._window = jobs, window
        beat = Beat(window)
        self.panel, self.status = JobsPanel(jobs, read_log, beat), JobStatus(jobs, beat)
        self.jobs_dock = window.panels.add_beside(window.curve_dock, "Jobs", self.panel)
        self.training_panel = TrainingPanel(jobs, trainings, beat)
        self.training_dock = window.panels.add_beside(window.curve_dock, "Training", self.training_panel)
        window.statusBar().addPermanentWidget(self.status)
        self.status.keep_room(window.statusBar())
        self.status.opened.connect(self.open_jobs)
        self.training_panel.used.connect(self._use)
        window.menus.on("jobs", self.open_jobs)
        window.menus.on("train", self.open_training)
        window.add_part(self)

    def open_jobs(self) -> None:
        """Bring the list of jobs to the front."""
        _bring_to_front(self.jobs_dock)

    def open_training(self) -> None:
        """Bring the trainings to the front, with the form if there are none yet."""
        _bring_to_front(self.training_dock)
        if self.training_panel.selected is None:
            self.training_panel.open_form()

    def _use(self, path: str) -> None:
        window = self._window
        if window.session.state.active is None:
            window.message.show_notice(Notice("Open a shape first: distance maps are drawn on it.", kind="information"))
            return
        window.session.choose_field(kind="distance", descriptor=path)

    def offer_to_go_on(self) -> None:
        """Show the list if an earlier window left something that can go on, now or once its death is known."""
        if any(job.state == "interrupted" for job in self._jobs.listed):
            self.open_jobs()
        self._inherited = {job.id for job in self._jobs.listed if job.state == "running"}
        self._jobs.changed.connect(self._offer_inherited)

    def _offer_inherited(self, id: str) -> None:
        if id in self._inherited and id in self._jobs and self._jobs[id].state == "interrupted":
            self.open_jobs()

    def show_theme(self, theme: Theme) -> None:
        """Icons in the theme's colours."""
        self.panel.show_theme(theme)
        self.status.show_theme(theme)
        self.training_panel.show_theme(theme)


def _bring_to_front(dock: QDockWidget) -> None:
    dock.show()
    dock.raise_()
    dock.widget().setFocus(Qt.FocusReason.OtherFocusReason)
