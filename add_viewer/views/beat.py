"""When the window tells how background work gets on: all of it at once, a few times a second."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer

PATIENCE = 300
"""Milliseconds between two beats: every repaint of any part composes the whole window."""


class Beat(QObject):
    """Calls what shows background work, all of it at the same moment, so that the window is composed once for all."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._waiting: dict[Callable[[], None], None] = {}
        self._timer = QTimer(self, singleShot=True, interval=PATIENCE)
        self._timer.timeout.connect(self._strike)

    def ask(self, show: Callable[[], None]) -> None:
        """Call `show` at the next beat; once, however often it is asked for."""
        self._waiting[show] = None
        if not self._timer.isActive():
            self._timer.start()

    def _strike(self) -> None:
        waiting, self._waiting = tuple(self._waiting), {}
        for show in waiting:
            show()
