"""Trainings: a list of them, the curves of one, and what can be done with it."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from psygnal import SignalInstance
from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QMessageBox,
    QPushButton,
    QSizePolicy,
    QStackedLayout,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from ..models.job_words import headline, moment_of, remark
from ..models.jobs import Job, Jobs, Verb
from ..models.training import TrainingRequest
from ..models.training_curves import TrainingCurves
from .beat import Beat
from .elided_label import ElidedLabel
from .icons import icon
from .job_row import VERBS
from .theme import GRID, LIGHT, Theme
from .training_form import TrainingForm
from .training_plots import TrainingPlots

EMPTY = (
    "Learn a descriptor of your own from shapes with known correspondence. It trains in the background,\n"
    "its curves appear here, and its best state can be seen as distance maps while it still learns."
)
USE_HELP = "Show distance maps by this training's best descriptor so far; while it trains on, they follow it"


class Trainings(Protocol):
    """What the panel shows: see `controllers.training`."""

    @property
    def curves_changed(self) -> SignalInstance: ...

    @property
    def models_changed(self) -> SignalInstance: ...

    @property
    def runs(self) -> tuple[Job, ...]: ...

    def curves(self, id: str) -> TrainingCurves: ...

    def model(self, id: str) -> Path | None: ...


class TrainingPanel(QWidget):
    """Shows `trainings`, and asks `jobs` to pause, resume or cancel them.

    request : what was asked for last. submitted : a request. used : path of a model to make distance maps with.
    deleted : id of a training.
    """

    submitted = Signal(object)
    used = Signal(str)
    deleted = Signal(str)

    def __init__(self, jobs: Jobs, trainings: Trainings, beat: Beat, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._jobs, self._trainings, self._beat, self._theme = jobs, trainings, beat, LIGHT
        self.request = TrainingRequest()
        self._chosen: str | None = None
        self.form: TrainingForm | None = None
        self.new_button, self.first_button = QPushButton("New training…"), QPushButton("New training…")
        self.list, self.plots = QListWidget(), TrainingPlots()
        self.title, self.state = ElidedLabel(), ElidedLabel()
        self.buttons: dict[Verb, QToolButton] = {verb: QToolButton() for verb in VERBS if verb != "dismiss"}
        self.use_button, self.delete_button = QPushButton("Use for distance maps"), QToolButton()
        self._build()
        self._connect()
        self._show_runs()

    # -- building -----------------------------------------------------------------------------------------------------

    def _build(self) -> None:
        for button in (self.new_button, self.first_button):
            button.setToolTip("Choose data, network and budget, and train in the background")
            button.clicked.connect(self.open_form)
        self.first_button.setProperty("primary", True)
        self.title.setProperty("role", "heading")
        self.state.setProperty("role", "muted")
        self.use_button.setToolTip(USE_HELP)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self._empty_page())
        page = QWidget()
        row = QHBoxLayout(page)
        row.setContentsMargins(2 * GRID, GRID, GRID, GRID)
        row.setSpacing(2 * GRID)
        row.addLayout(self._left())
        row.addLayout(self._right(), 1)
        self._stack.addWidget(page)

    def _empty_page(self) -> QWidget:
        page = QWidget()
        text = QLabel(EMPTY)
        text.setAlignment(Qt.AlignmentFlag.AlignCenter)
        text.setWordWrap(True)
        text.setProperty("role", "muted")
        column = QVBoxLayout(page)
        column.setSpacing(2 * GRID)
        column.addStretch(1)
        column.addWidget(text)
        column.addWidget(self.first_button, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addStretch(1)
        return page

    def _left(self) -> QVBoxLayout:
        self.list.setFixedWidth(23 * GRID)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setAccessibleName("Trainings")
        column = QVBoxLayout()
        column.setSpacing(GRID)
        column.addWidget(self.new_button)
        column.addWidget(self.list, 1)
        return column

    def _right(self) -> QVBoxLayout:
        words = QVBoxLayout()
        words.setSpacing(0)
        words.addWidget(self.title)
        words.addWidget(self.state)
        head = QHBoxLayout()
        head.setSpacing(GRID // 2)
        head.addLayout(words, 1)
        for verb, button in self.buttons.items():
            text, _, help_text = VERBS[verb]
            button.setToolTip(f"{text}: {help_text[0].lower()}{help_text[1:]}")
            button.setAccessibleName(f"{text} this training")
            button.clicked.connect(lambda _checked=False, verb=verb: self._ask(verb))
            head.addWidget(button)
        self.delete_button.setToolTip("Delete this training and its model")
        self.delete_button.setAccessibleName("Delete this training")
        head.addWidget(self.delete_button)
        head.addWidget(self.use_button)
        self.plots.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        column = QVBoxLayout()
        column.setSpacing(GRID // 2)
        column.addLayout(head)
        column.addWidget(self.plots, 1)
        return column

    def _connect(self) -> None:
        self._jobs.changed.connect(lambda id: self._show_soon())
        self._trainings.curves_changed.connect(lambda id: self._show_soon())
        self._trainings.models_changed.connect(lambda path: self._show_soon())
        self.list.currentItemChanged.connect(self._choose)
        self.use_button.clicked.connect(self._use)
        self.delete_button.clicked.connect(self._confirm_deletion)

    # -- what a person does -------------------------------------------------------------------------------------------

    @property
    def selected(self) -> str | None:
        """The id of the training whose curves are shown."""
        item = self.list.currentItem()
        return None if item is None else str(item.data(Qt.ItemDataRole.UserRole))

    def select(self, id: str) -> None:
        """Show the curves of one training."""
        self._show_runs()
        for number in range(self.list.count()):
            if self.list.item(number).data(Qt.ItemDataRole.UserRole) == id:
                self.list.setCurrentRow(number)

    def _choose(self) -> None:
        self._chosen = self.selected
        self._show_run()

    def open_form(self) -> None:
        """Ask what to train, beginning with what was trained last."""
        self.form = TrainingForm(self.request, self)
        self.form.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.form.submitted.connect(self._submit)
        self.form.finished.connect(lambda _result: setattr(self, "form", None))
        self.form.open()

    def _submit(self, request: TrainingRequest) -> None:
        self.request = request
        self.submitted.emit(request)

    def _ask(self, verb: Verb) -> None:
        if self.selected is not None:
            getattr(self._jobs, verb)(self.selected)

    def _use(self) -> None:
        path = None if self.selected is None else self._trainings.model(self.selected)
        if path is not None:
            self.used.emit(str(path))

    def _confirm_deletion(self) -> None:
        id = self.selected
        if id is None:
            return
        box = QMessageBox(
            QMessageBox.Icon.Question,
            "Delete this training?",
            f"{self.title.text()}, its curves and its model are deleted. This cannot be undone.",
            QMessageBox.StandardButton.Cancel,
            self,
        )
        delete = box.addButton("Delete", QMessageBox.ButtonRole.DestructiveRole)
        delete.clicked.connect(lambda: self.deleted.emit(id))
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()

    # -- models to view -----------------------------------------------------------------------------------------------

    def _show_soon(self) -> None:
        self._beat.ask(self._show_runs)

    def _show_runs(self) -> None:
        runs = self._trainings.runs
        wanted = self._wanted(runs)
        listed = [self.list.item(number).data(Qt.ItemDataRole.UserRole) for number in range(self.list.count())]
        if listed != [job.id for job in runs]:
            with QSignalBlocker(self.list):
                self.list.clear()
                for job in runs:
                    item = QListWidgetItem()
                    item.setData(Qt.ItemDataRole.UserRole, job.id)
                    self.list.addItem(item)
        with QSignalBlocker(self.list):
            self.list.setCurrentRow(wanted)
        for number, job in enumerate(runs):
            self.list.item(number).setText(f"{job.request.title}\n{_short(job)}")
            self.list.item(number).setToolTip(f"{job.request.title}, {moment_of(job)}")
        self._stack.setCurrentIndex(1 if runs else 0)
        self._show_run()

    def _wanted(self, runs: tuple[Job, ...]) -> int:
        """The row of the training that the person chose; of one that runs; of the one that was shown; the newest."""
        ids = [job.id for job in runs]
        running = [job.id for job in runs if job.state == "running"]
        return next((ids.index(id) for id in (self._chosen, *running, self.selected) if id in ids), 0)

    def _show_run(self) -> None:
        id = self.selected
        if id is None or id not in self._jobs or not self.isVisible():
            return
        job = self._jobs[id]
        self.title.setText(job.request.title)
        self.state.setText(" · ".join(words for words in (headline(job), remark(job)) if words))
        for verb, button in self.buttons.items():
            button.setVisible(job.can(verb))
        self.delete_button.setVisible(job.state not in ("running", "waiting"))
        self.use_button.setEnabled(self._trainings.model(id) is not None)
        self.plots.waiting_text = _waiting(job)
        self.plots.show_curves(self._trainings.curves(id))

    def showEvent(self, event: object) -> None:
        self._show_soon()

    def resizeEvent(self, event: QResizeEvent) -> None:
        self.use_button.setText("Use for distance maps" if self.width() > 80 * GRID else "Use")

    def show_theme(self, theme: Theme) -> None:
        """Icons and curves in the theme's colours."""
        self._theme = theme
        for verb, button in self.buttons.items():
            button.setIcon(icon(VERBS[verb][1], theme.text))
        self.delete_button.setIcon(icon("mdi6.delete-outline", theme.text))
        self.use_button.setIcon(icon("mdi6.map-marker-distance", theme.text))
        self.new_button.setIcon(icon("mdi6.plus", theme.text))
        self.first_button.setIcon(icon("mdi6.plus", theme.on_accent))
        self.plots.show_theme(theme)
        self.list.setStyleSheet(
            f"QListWidget::item {{ padding: 4px 8px; border-radius: 4px; }}"
            f"QListWidget::item:selected {{ background: {theme.line}; color: {theme.text}; }}"
        )


def _short(job: Job) -> str:
    """For the list: "Running, 34 %", "Done, 28 Nov 11:38"."""
    if job.state == "running":
        return "Running" if job.share is None else f"Running, {100 * job.share:.0f} %"
    return f"Done, {moment_of(job)}" if job.state == "done" else headline(job)


def _waiting(job: Job) -> str:
    """Why there are no curves yet."""
    if job.state in ("waiting", "running"):
        return "The first curves appear as soon as the inputs of all shapes are computed."
    return "This training ended before its first step." if job.state != "done" else "Its curves are being read …"
