"""A few actions as icons in a corner of the views, side by side or one below the other."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QBoxLayout, QToolButton, QWidget

from .theme import GRID

_SIDE, _GAP = 30, GRID // 2


class ToolStrip(QWidget):
    """Buttons for actions, in the upper right corner of its parent. extent : its longer side in pixels."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.extent = 0
        self._row = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._row.setContentsMargins(0, 0, 0, 0)
        self._row.setSpacing(_GAP)

    def show_actions(self, actions: list[QAction]) -> None:
        """Offer these actions."""
        for action in actions:
            button = QToolButton()
            button.setDefaultAction(action)
            button.setIconSize(QSize(18, 18))
            button.setFixedSize(_SIDE, _SIDE)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            self._row.addWidget(button)
        self.extent = len(actions) * (_SIDE + _GAP) - _GAP
        self.place(upright=False)

    def place(self, *, upright: bool) -> None:
        """Stand in the corner, upright where there is no room for a row."""
        direction = QBoxLayout.Direction.TopToBottom if upright else QBoxLayout.Direction.LeftToRight
        self._row.setDirection(direction)
        self.setFixedSize(QSize(_SIDE, self.extent) if upright else QSize(self.extent, _SIDE))
        room = self.parentWidget()
        assert room is not None
        self.move(room.width() - self.width() - 2 * GRID, 2 * GRID)
        self.raise_()
