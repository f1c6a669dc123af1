"""A few actions as icons in a corner of the views, in a row or in two columns."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QGridLayout, QToolButton, QWidget

from .theme import GRID

_SIDE, _GAP = 30, GRID // 2


class ToolStrip(QWidget):
    """Buttons for actions, in the upper right corner of its parent. extent : width of its row in pixels."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.extent = 0
        self._buttons: list[QToolButton] = []
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setSpacing(_GAP)

    def show_actions(self, actions: list[QAction]) -> None:
        """Offer these actions."""
        for action in actions:
            button = QToolButton()
            button.setDefaultAction(action)
            button.setIconSize(QSize(18, 18))
            button.setFixedSize(_SIDE, _SIDE)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            self._buttons.append(button)
        self.extent = _length(len(actions))
        self.place(narrow=False)

    def place(self, *, narrow: bool) -> None:
        """Stand in the corner, in two columns where there is no room for a row."""
        columns = 2 if narrow else max(len(self._buttons), 1)
        for number, button in enumerate(self._buttons):
            self._grid.addWidget(button, number // columns, number % columns)
        self.setFixedSize(QSize(_length(columns), _length(-(-len(self._buttons) // columns))))
        room = self.parentWidget()
        assert room is not None
        self.move(room.width() - self.width() - 2 * GRID, 2 * GRID)
        self.raise_()


def _length(count: int) -> int:
    return max(count, 1) * (_SIDE + _GAP) - _GAP
