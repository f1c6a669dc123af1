"""One job in the list: title, progress, time left, what can be done with it, and its log."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QFontDatabase
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from ..models.job_words import headline, remark
from ..models.jobs import Job, Verb
from .elided_label import ElidedLabel
from .icons import icon
from .share_bar import ShareBar
from .theme import GRID, Theme

VERBS: dict[Verb, tuple[str, str, str]] = {
    "resume": ("Resume", "mdi6.play", "Go on where this job stopped"),
    "retry": ("Retry", "mdi6.refresh", "Run this job again"),
    "pause": ("Pause", "mdi6.pause", "Stop after a checkpoint; it can go on later, even after the app was closed"),
    "cancel": ("Cancel", "mdi6.stop", "End this job; what it has written so far stays"),
    "dismiss": ("Dismiss", "mdi6.close", "Take this job off the list"),
}
"""Words, icon and help of what can be done with a job."""

_STATE_ICONS = {
    "waiting": "mdi6.timer-sand",
    "running": "mdi6.cog-outline",
    "done": "mdi6.check-circle-outline",
    "failed": "mdi6.alert-circle-outline",
    "cancelled": "mdi6.cancel",
    "paused": "mdi6.pause-circle-outline",
    "interrupted": "mdi6.power-plug-off-outline",
}


class JobRow(QFrame):
    """Shows one job. asked : a verb that the person chose. log_opened : whether the log is to be shown."""

    asked = Signal(str)
    log_opened = Signal(bool)

    def __init__(self, job: Job, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.job, self._theme = job, theme
        self.title, self.state, self.message, self._icon = ElidedLabel(), QLabel(), QLabel(), QLabel()
        self.progress = ShareBar()
        self.log_button = QToolButton()
        self.buttons = {verb: QToolButton() for verb in VERBS}
        self.log = QPlainTextEdit()
        self._build()
        self.show_job(job)
        self.show_theme(theme)

    def _build(self) -> None:
        self.title.setProperty("role", "heading")
        self.state.setProperty("role", "muted")
        self.message.setProperty("role", "muted")
        self.message.setWordWrap(True)
        self.message.setTextFormat(Qt.TextFormat.PlainText)
        self.message.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.log.setReadOnly(True)
        self.log.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.log.setFixedHeight(16 * GRID)
        self.log.hide()
        grid = QGridLayout(self)
        grid.setContentsMargins(2 * GRID, GRID // 2, GRID, GRID // 2)
        grid.setHorizontalSpacing(GRID)
        grid.setVerticalSpacing(GRID // 2)
        grid.addWidget(self._icon, 0, 0)
        grid.addWidget(self.title, 0, 1)
        grid.addWidget(self.state, 0, 2)
        grid.addLayout(self._button_row(), 0, 3)
        grid.addWidget(self.progress, 1, 1, 1, 3)
        grid.addWidget(self.message, 2, 1, 1, 3)
        grid.addWidget(self.log, 3, 1, 1, 3)
        grid.setColumnStretch(1, 1)

    def _button_row(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(GRID // 2)
        for verb, button in self.buttons.items():
            words, _, help_text = VERBS[verb]
            button.setText(words)
            button.setToolTip(help_text)
            button.setAccessibleName(f"{words} this job")
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            button.clicked.connect(lambda _checked=False, verb=verb: self.asked.emit(verb))
            row.addWidget(button)
        self.log_button.setText("Log")
        self.log_button.setToolTip("Show or hide what the command said")
        self.log_button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.log_button.setCheckable(True)
        self.log_button.toggled.connect(self._toggle_log)
        row.insertWidget(4, self.log_button)
        return row

    def show_job(self, job: Job) -> None:
        """Show how far the job is."""
        if job.state != self.job.state:
            self._show_state_icon(job)
        self.job = job
        self.title.setText(job.request.title)
        self.state.setText(headline(job))
        self.message.setText(remark(job))
        self.message.setVisible(bool(remark(job)))
        self.progress.setVisible(job.state == "running")
        self.progress.show_share(job.share)
        for verb, button in self.buttons.items():
            button.setVisible(job.can(verb))

    def show_log(self, text: str) -> None:
        """Show what the command said, at its end unless the person reads further up."""
        if text == self.log.toPlainText():
            return
        bar = self.log.verticalScrollBar()
        was_at_end = bar.value() >= bar.maximum() - 4
        self.log.setPlainText(text or "It has not said anything yet.")
        if was_at_end:
            bar.setValue(bar.maximum())

    def _toggle_log(self, on: bool) -> None:
        self.log.setVisible(on)
        self.log_opened.emit(on)

    def _show_state_icon(self, job: Job) -> None:
        colours = {"failed": self._theme.danger, "done": self._theme.accent, "running": self._theme.accent}
        colour = colours.get(job.state, self._theme.muted)
        self._icon.setPixmap(icon(_STATE_ICONS[job.state], colour).pixmap(18, 18))
        self._icon.setAccessibleName(job.state)

    def show_theme(self, theme: Theme) -> None:
        """Icons in the theme's colours."""
        self._theme = theme
        self._show_state_icon(self.job)
        for verb, button in self.buttons.items():
            button.setIcon(icon(VERBS[verb][1], theme.text))
        self.log_button.setIcon(icon("mdi6.text-box-outline", theme.text))
