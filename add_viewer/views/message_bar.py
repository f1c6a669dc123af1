"""A message above the view: it waits for the person, never blocks them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QToolButton, QWidget

from ..models.results import Notice
from .icons import icon
from .theme import GRID, Theme


class MessageBar(QFrame):
    """The latest notice, until it is closed or the next thing succeeds."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("message")
        self._icon, self.text, self.close_button = QLabel(), QLabel(), QToolButton()
        self.text.setWordWrap(True)
        self.text.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.text.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.close_button.setToolTip("Close this message")
        self.close_button.setProperty("quiet", True)
        self.close_button.clicked.connect(self.hide)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(2 * GRID, GRID, GRID, GRID)
        layout.setSpacing(GRID)
        layout.addWidget(self._icon)
        layout.addWidget(self.text, stretch=1)
        layout.addWidget(self.close_button)
        self.hide()

    def show_notice(self, notice: Notice) -> None:
        """Show the notice's text."""
        self.text.setText(notice.text)
        self.show()

    def show_theme(self, theme: Theme) -> None:
        """The bar in the theme's warning colour."""
        self._icon.setPixmap(icon("mdi6.alert-circle-outline", theme.danger).pixmap(18, 18))
        self.close_button.setIcon(icon("mdi6.close", theme.muted))
        self.setStyleSheet(
            f"#message {{ background: {theme.panel}; border: none; border-left: 4px solid {theme.danger};"
            f" border-bottom: 1px solid {theme.line}; }}"
        )
