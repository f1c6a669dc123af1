"""The title of a panel: its name, and buttons that can be seen in every theme."""

from __future__ import annotations

from PySide6.QtWidgets import QDockWidget, QHBoxLayout, QLabel, QToolButton, QWidget

from .icons import icon
from .theme import GRID, Theme


class DockTitle(QWidget):
    """Takes the place of the style's own title bar; dragging it moves the panel as before."""

    def __init__(self, dock: QDockWidget) -> None:
        super().__init__(dock)
        self.float_button, self.close_button = QToolButton(), QToolButton()
        name = QLabel(dock.windowTitle())
        name.setProperty("role", "heading")
        row = QHBoxLayout(self)
        row.setContentsMargins(2 * GRID, 0, GRID // 2, 0)
        row.setSpacing(0)
        row.addWidget(name, 1)
        for button, verb, help_text in (
            (self.float_button, "Float", "Float this panel, or put it back"),
            (self.close_button, "Close", "Close this panel; View → Panels brings it back"),
        ):
            button.setAccessibleName(f"{verb} “{dock.windowTitle()}”")
            button.setProperty("quiet", True)
            button.setToolTip(help_text)
            row.addWidget(button)
        self.float_button.clicked.connect(lambda: dock.setFloating(not dock.isFloating()))
        self.close_button.clicked.connect(dock.close)

    def show_theme(self, theme: Theme) -> None:
        """Icons in the theme's colour."""
        self.float_button.setIcon(icon("mdi6.dock-window", theme.muted))
        self.close_button.setIcon(icon("mdi6.close", theme.muted))
