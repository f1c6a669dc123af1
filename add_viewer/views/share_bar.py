"""A thin bar that shows how far something is."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt, QTimer
from PySide6.QtGui import QHideEvent, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import QProgressBar, QWidget

from .beat import PATIENCE

_STEPS, _PIECE = 1000, 5
"""The piece that walks along while nobody knows the share is one of so many parts of the bar."""


class ShareBar(QProgressBar):
    """Is painted with all else that changes: every paint composes the whole window.

    A QProgressBar paints at once whenever its value changes, and sixty times a second while it has none.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTextVisible(False)
        self.setRange(0, _STEPS)
        self._is_known, self._place = True, 0
        self._walk = QTimer(self, interval=PATIENCE)
        self._walk.timeout.connect(self._go_on)

    @property
    def is_walking(self) -> bool:
        """Whether it shows that something goes on, but not how far it is."""
        return bool(self._walk.isActive())

    def show_share(self, share: float | None) -> None:
        """From 0 to 1; None while nobody knows."""
        self._is_known = share is not None
        self.setUpdatesEnabled(False)
        self.setValue(0 if share is None else round(_STEPS * share))
        self.setUpdatesEnabled(True)
        self._walk_if_needed()

    def _walk_if_needed(self) -> None:
        if self._is_known or not self.isVisible():
            self._walk.stop()
        elif not self._walk.isActive():
            self._walk.start()

    def _go_on(self) -> None:
        self._place = (self._place + 1) % _PIECE
        self.update()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._walk_if_needed()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self._walk_if_needed()

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if self._is_known:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self.palette().highlight())
        width, radius = self.width() / _PIECE, self.height() / 2
        painter.drawRoundedRect(QRectF(self._place * width, 0, width, self.height()), radius, radius)
