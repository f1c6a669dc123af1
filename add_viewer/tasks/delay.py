"""Waiting until a person pauses."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer


class Delay(QObject):
    """Calls the newest of the functions it is given, once none has come for `milliseconds`."""

    def __init__(self, milliseconds: int, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._call: Callable[[], None] | None = None
        self._timer = QTimer(self, singleShot=True, interval=milliseconds)
        self._timer.timeout.connect(self._fire)

    def __call__(self, call: Callable[[], None]) -> None:
        self._call = call
        self._timer.start()

    def cancel(self) -> None:
        self._timer.stop()
        self._call = None

    def _fire(self) -> None:
        call, self._call = self._call, None
        if call is not None:
            call()
