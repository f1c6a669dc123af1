"""A quiet pair of axes with curves, painted by Qt: quick enough to repaint while somebody works."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, log10

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from .theme import Theme, round_pen

LEFT, RIGHT, ABOVE, BELOW = 36, 104, 20, 20
"""Room around a plot, in device-independent pixels."""
_LABEL_HEIGHT = 13.0


@dataclass(frozen=True)
class Line:
    """One curve: a label at its end, its points, and how it is drawn."""

    label: str
    x: Sequence[float]
    y: Sequence[float]
    colour: QColor
    width: float = 2.0
    dots: bool = True


def round_ticks(low: float, high: float, most: int) -> list[float]:
    """At most about `most` round numbers from `low` to `high`: multiples of 1, 2 or 5 times a power of ten."""
    if not high > low:
        return [low]
    rough = (high - low) / max(most, 1)
    power = 10.0 ** floor(log10(rough))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= rough * (1 - 1e-9))
    return [step * number for number in range(ceil(low / step - 1e-9), floor(high / step + 1e-9) + 1)]


class Plot:
    """One pair of axes in a rectangle."""

    def __init__(self, painter: QPainter, room: QRectF, theme: Theme, x_end: float, y_end: float) -> None:
        self._painter, self._theme = painter, theme
        self._x_end, self._y_end = max(x_end, 1.0), y_end
        self.inside = room.adjusted(LEFT, ABOVE, -RIGHT, -BELOW)

    def place(self, x: float, y: float) -> QPointF:
        """Where a point lies; what is above the top is drawn at the top."""
        share = min(y / self._y_end, 1.0)
        return QPointF(
            self.inside.left() + self.inside.width() * x / self._x_end,
            self.inside.bottom() - self.inside.height() * share,
        )

    def axes(self, title: str, y_ticks: Sequence[float]) -> None:
        """Grid, numbers and names."""
        painter, inside, theme = self._painter, self.inside, self._theme
        painter.fillRect(inside, theme.colour("panel"))
        for y in y_ticks:
            level = self.place(0, y).y()
            painter.setPen(QPen(theme.colour("grid"), 1))
            painter.drawLine(QPointF(inside.left(), level), QPointF(inside.right(), level))
            painter.setPen(theme.colour("muted"))
            room = QRectF(inside.left() - LEFT, level - 8, LEFT - 6, 16)
            painter.drawText(room, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, f"{y:g}")
        self._name_steps()
        painter.setPen(QPen(theme.colour("line"), 1))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(inside)
        painter.setPen(theme.colour("text"))
        room = QRectF(inside.left(), inside.top() - ABOVE, inside.width() + RIGHT, ABOVE - 2)
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter, title)

    def _name_steps(self) -> None:
        for x in round_ticks(0, self._x_end, max(int(self.inside.width() / 70), 2)):
            room = QRectF(self.place(x, 0).x() - 40, self.inside.bottom() + 4, 80, 14)
            self._painter.drawText(room, Qt.AlignmentFlag.AlignHCenter, f"{x:,.0f}")
        room = QRectF(self.inside.right() + 24, self.inside.bottom() + 4, 60, 14)
        self._painter.drawText(room, Qt.AlignmentFlag.AlignLeft, "step")

    def lines(self, lines: Sequence[Line]) -> None:
        """Curves with their labels at the right end, moved apart where they would touch."""
        ends: list[tuple[float, Line]] = []
        for line in lines:
            points = [self.place(x, y) for x, y in zip(line.x, line.y, strict=True)]
            if not points:
                continue
            self._painter.setPen(round_pen(line.colour, line.width))
            self._painter.setBrush(Qt.BrushStyle.NoBrush)
            self._painter.drawPolyline(QPolygonF(points))
            if line.dots:
                self._painter.setBrush(line.colour)
                for point in points:
                    self._painter.drawEllipse(point, 1.8, 1.8)
            ends.append((points[-1].y(), line))
        self._labels(ends)

    def _labels(self, ends: list[tuple[float, Line]]) -> None:
        ends = sorted(ends, key=lambda end: end[0])
        floor_of_last = self.inside.top()
        lowest = self.inside.bottom() - _LABEL_HEIGHT * (len(ends) - 1)
        for number, (level, line) in enumerate(ends):
            middle = min(max(level, floor_of_last), lowest + _LABEL_HEIGHT * number)
            floor_of_last = middle + _LABEL_HEIGHT
            self._painter.setPen(line.colour)
            room = QRectF(self.inside.right() + 6, middle - 8, RIGHT - 6, 16)
            self._painter.drawText(room, Qt.AlignmentFlag.AlignVCenter, line.label)

    def upright(self, x: float, colour: QColor) -> None:
        """A vertical line."""
        self._painter.setPen(QPen(colour, 1))
        self._painter.drawLine(self.place(x, 0), QPointF(self.place(x, 0).x(), self.inside.top()))

    def ring(self, x: float, y: float, colour: QColor) -> None:
        """A mark around one point."""
        self._painter.setPen(QPen(colour, 1.5))
        self._painter.setBrush(Qt.BrushStyle.NoBrush)
        self._painter.drawEllipse(self.place(x, y), 4.5, 4.5)
