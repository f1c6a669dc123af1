"""Bars that show how far each descriptor tells a point from its mirror image: the paper's point at one glance."""

from __future__ import annotations

from math import log10

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from add_core.drawing.colour_maps import distance_map
from add_core.drawing.colours import hex_colour

from ..models.descriptor_names import descriptor_name
from ..models.insights import Telling
from .theme import GRID, LIGHT, Theme

_ROW, _LABEL, _NUMBER, _SCALE = 3 * GRID, 12 * GRID, 7 * GRID, 3 * GRID

_PRESSES = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space)


class TellingBars(QWidget):
    """One row a descriptor, from 0 (mistaken for its mirror image) to 1 (as far apart as any two points).

    wanted : the person clicks a descriptor that is not computed yet. chosen : or one that is. With the keyboard, arrows
    go to a row, and Enter or Space is the click.
    """

    wanted = Signal(str)
    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._tellings: tuple[Telling, ...] = ()
        self._row = 0
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("How far descriptors tell left from right")
        self._theme = LIGHT
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setToolTip("Click a descriptor to draw it over the whole body; what is not computed yet is computed.")

    def show_tellings(self, tellings: tuple[Telling, ...]) -> None:
        """Draw these rows."""
        self._tellings = tellings
        self.setFixedHeight(_ROW * len(tellings) + _SCALE)
        words = [f"{descriptor_name(each.descriptor).title}: {_number(each)}" for each in tellings]
        self.setAccessibleDescription("; ".join(words))
        self.update()

    def show_theme(self, theme: Theme) -> None:
        """Colours of words and tracks."""
        self._theme = theme
        self.update()

    def row_centre(self, descriptor: str) -> QPointF:
        """Where a descriptor's row is, in this widget."""
        row = [each.descriptor for each in self._tellings].index(descriptor)
        return QPointF(self.width() / 2, (row + 0.5) * _ROW)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._press(int(event.position().y() // _ROW))

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and event.key() in _PRESSES:
            event.accept()  # Space plays elsewhere
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        steps = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}
        if event.key() in steps:
            self._row = min(max(self._row + steps[Qt.Key(event.key())], 0), max(len(self._tellings) - 1, 0))
            self.update()
        elif event.key() in _PRESSES:
            self._press(self._row)
        else:
            super().keyPressEvent(event)

    def _press(self, row: int) -> None:
        if 0 <= row < len(self._tellings):
            self._row, telling = row, self._tellings[row]
            known = telling.ratio is not None or telling.message.startswith("Pick")
            (self.chosen if known else self.wanted).emit(telling.descriptor)

    def sizeHint(self) -> QSize:
        return QSize(32 * GRID, _ROW * max(1, len(self._tellings)) + _SCALE)

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for row, telling in enumerate(self._tellings):
            self._paint_row(painter, QRectF(0, row * _ROW, self.width(), _ROW), telling)
        self._paint_scale(painter, _ROW * len(self._tellings))
        if self.hasFocus() and self._tellings:
            painter.setPen(QPen(self._theme.colour("accent"), 2))
            below = _ROW * (min(self._row, len(self._tellings) - 1) + 1) - 1
            painter.drawLine(0, below, self.width(), below)

    def _track(self, y: float) -> QRectF:
        return QRectF(_LABEL, y - 5, self.width() - _LABEL - _NUMBER - GRID, 10)

    def _paint_row(self, painter: QPainter, row: QRectF, telling: Telling) -> None:
        known = telling.ratio is not None
        middle = Qt.AlignmentFlag.AlignVCenter
        painter.setPen(self._theme.colour("text" if known else "muted"))
        name = painter.fontMetrics().elidedText(
            descriptor_name(telling.descriptor).title, Qt.TextElideMode.ElideRight, _LABEL - GRID
        )
        painter.drawText(row, middle | Qt.AlignmentFlag.AlignLeft, name)
        track = self._track(row.center().y())
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self._theme.colour("line"))
        painter.drawRoundedRect(track, 5, 5)
        if telling.ratio is not None:
            share = position(telling.ratio)
            painter.setBrush(QColor(hex_colour(distance_map(101)[round(100 * share)])))
            painter.drawRoundedRect(QRectF(track.left(), track.top(), max(10.0, share * track.width()), 10), 5, 5)
        painter.setPen(self._theme.colour("text" if known else "accent"))
        painter.drawText(row, middle | Qt.AlignmentFlag.AlignRight, _number(telling))

    def _paint_scale(self, painter: QPainter, y: float) -> None:
        small = QFont(painter.font())
        small.setPointSizeF(0.85 * small.pointSizeF())
        painter.setFont(small)
        painter.setPen(QPen(self._theme.colour("muted"), 1))
        track = self._track(y)
        words = QRectF(0, y, track.right(), _SCALE - 4)
        painter.drawText(words.adjusted(track.left(), 0, 0, 0), Qt.AlignmentFlag.AlignLeft, "mistaken")
        painter.drawText(words, Qt.AlignmentFlag.AlignRight, "told apart")


def position(ratio: float) -> float:
    """0 to 1 along a bar, as in the colours of the body: equal ratios take equal room, from 0.01 to 1."""
    return min(max(1.0 + log10(max(ratio, 1e-9)) / 2.0, 0.0), 1.0)


def _number(telling: Telling) -> str:
    if telling.ratio is not None:
        return f"{telling.ratio:.2f}" if telling.ratio >= 0.01 else "< 0.01"
    if telling.message.startswith("Computing"):
        return telling.message.rpartition("…")[2].strip() or "…"
    return "–" if telling.message.startswith("Pick") else "failed" if telling.message else "compute"
