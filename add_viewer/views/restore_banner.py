"""After a crash: the session that was open is offered, and waits until the person decides."""

from __future__ import annotations

from datetime import datetime

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QSizePolicy, QWidget

from ..models.session_file import KeptSession
from .theme import GRID, Theme


class RestoreBanner(QFrame):
    """One sentence and two answers."""

    restore = Signal()
    discard = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("restore")
        self.text = QLabel()
        self.text.setWordWrap(True)
        self.text.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.restore_button, self.discard_button = QPushButton("Restore"), QPushButton("Discard")
        self.restore_button.setProperty("primary", True)
        self.restore_button.clicked.connect(self.restore)
        self.discard_button.clicked.connect(self.discard)
        row = QHBoxLayout(self)
        row.setContentsMargins(2 * GRID, GRID, 2 * GRID, GRID)
        row.setSpacing(GRID)
        row.addWidget(self.text, 1)
        for button in (self.restore_button, self.discard_button):
            row.addWidget(button, 0, Qt.AlignmentFlag.AlignVCenter)
        self.hide()

    def offer(self, kept: KeptSession) -> None:
        """Ask about one session."""
        self.text.setText(f"The app ended without being closed{_when(kept.saved)}. Still there: {summary(kept)}.")
        self.show()

    def show_theme(self, theme: Theme) -> None:
        """A bar with the accent colour at its edge."""
        self.setStyleSheet(
            f"#restore {{ background: {theme.panel}; border: none; border-left: 4px solid {theme.accent};"
            f" border-bottom: 1px solid {theme.line}; }}"
        )


def summary(kept: KeptSession) -> str:
    """ "Person 1, neutral and 2 more shapes, with 3 picked points" """
    others = len(kept.shapes) - 1
    names = kept.shapes[0].name if kept.shapes else "no shape"
    more = f" and {others} more shape{'s' * (others > 1)}" if others > 0 else ""
    points = f", with {len(kept.picks)} picked point{'s' * (len(kept.picks) > 1)}" if kept.picks else ""
    return names + more + points


def _when(saved: str) -> str:
    try:
        moment = datetime.fromisoformat(saved).astimezone()
    except ValueError:
        return ""
    today = moment.date() == datetime.now().astimezone().date()
    return moment.strftime(" at %H:%M" if today else " on %d %B at %H:%M")
