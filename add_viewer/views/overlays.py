"""Quiet labels over the 3-D view, drawn by Qt so that text is sharp at every scale and in exports."""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, QSize, QSizeF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QLinearGradient, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from add_core.drawing.colour_maps import Tones, tone_map
from add_core.drawing.colours import hex_colour

from .theme import GRID, LIGHT, Theme, round_pen

FloatArray = NDArray[np.float64]
_INDENT = 14
"""Of the name of the source, for its dot."""


class Overlay(QWidget):
    """Something drawn in a corner of the view; the mouse passes through."""

    def __init__(self, parent: QWidget, size: QSize) -> None:
        super().__init__(parent)
        self.theme = LIGHT
        self.setFixedSize(size)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)

    def show_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        self.draw(QPainter(self))

    def draw(self, painter: QPainter) -> None:
        """Draw at the painter's origin: on the widget, or on a picture for a file."""
        raise NotImplementedError

    def _pen(self, painter: QPainter, name: str, *, size: float = 1.0, bold: bool = False) -> None:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        font = QFont(self.font())
        font.setPointSizeF(size * font.pointSizeF())
        font.setBold(bold)
        painter.setFont(font)
        painter.setPen(self.theme.colour(name))


class ColourBar(Overlay):
    """What the colours mean: quantity, unit, scale."""

    LARGE, SMALL = QSize(208, 232), QSize(220, 46)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, self.LARGE)
        self._title, self._lines, self._ticks = "", ("", ""), list[tuple[float, str]]()
        self._tones: Tones = "kernel"

    def show_scale(
        self, title: str, lines: tuple[str, str], ticks: list[tuple[float, str]], tones: Tones = "kernel"
    ) -> None:
        """`title` names the quantity, `lines` its unit and scale, `ticks` are positions in [0, 1] and labels."""
        self._title, self._lines, self._ticks, self._tones = title, lines, ticks, tones
        self.update()

    def show_small(self, on: bool, width: int) -> None:
        """Lie below the shape, at most `width` wide, instead of standing beside it."""
        wide = min(self.SMALL.width(), max(width, 0))
        self.setFixedSize(QSize(wide, self.SMALL.height()) if on else self.LARGE)

    @property
    def is_small(self) -> bool:
        """Whether it lies below the shape."""
        return self.height() == self.SMALL.height()

    def draw(self, painter: QPainter) -> None:
        if self.is_small:
            self._draw_small(painter)
            return
        width = self.width()
        flags = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        self._pen(painter, "text", bold=True)
        title = painter.fontMetrics().elidedText(self._title, Qt.TextElideMode.ElideRight, width)
        painter.drawText(QRectF(0, 0, width, 18), flags, title)
        self._pen(painter, "muted", size=0.9)
        for row, line in enumerate(self._lines):
            painter.drawText(QRectF(0, 18 + 16 * row, width, 16), flags, line)
        bar = QRectF(width - 17, 60, 16, self.height() - 68)
        self._draw_ramp(painter, bar, QLinearGradient(bar.bottomLeft(), bar.topLeft()))
        self._pen(painter, "text", size=0.9)
        for at, label in self._ticks:
            y = bar.bottom() - at * bar.height()
            painter.drawLine(QPointF(bar.left() - 4, y), QPointF(bar.left(), y))
            painter.drawText(QRectF(0, y - 9, bar.left() - 8, 18), flags, label)

    def _draw_small(self, painter: QPainter) -> None:
        """A lying bar: the quantity over it, the values at its ends."""
        self._pen(painter, "text", size=0.9)
        low, high = self._ticks[0][1], self._ticks[-1][1]
        metrics = painter.fontMetrics()
        left, right = metrics.horizontalAdvance(low) + 8, metrics.horizontalAdvance(high) + 8
        bar = QRectF(left, 26, self.width() - left - right, 12)
        self._draw_ramp(painter, bar, QLinearGradient(bar.topLeft(), bar.topRight()))
        self._pen(painter, "text", size=0.9)
        middle = Qt.AlignmentFlag.AlignVCenter
        painter.drawText(QRectF(0, 23, left - 6, 18), middle | Qt.AlignmentFlag.AlignRight, low)
        painter.drawText(QRectF(self.width() - right + 6, 23, right - 6, 18), middle, high)
        words = f"{self._title}, {self._lines[0]}" if self._lines[0] else self._title
        fitting = metrics.elidedText(words, Qt.TextElideMode.ElideRight, self.width())
        painter.drawText(QRectF(0, 2, self.width(), 18), Qt.AlignmentFlag.AlignHCenter, fitting)

    def _draw_ramp(self, painter: QPainter, bar: QRectF, ramp: QLinearGradient) -> None:
        for at, colour in zip(np.linspace(0, 1, 33), tone_map(self._tones, 33), strict=True):
            ramp.setColorAt(float(at), QColor(hex_colour(colour)))
        painter.setPen(QPen(self.theme.colour("muted"), 0.75))
        painter.setBrush(ramp)
        painter.drawRect(bar)


class CornerLabel(Overlay):
    """Which shape this is, and how many vertices it has."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, QSize(400, 60))
        self._name = self._detail = self._parameters = ""
        self._is_source = False

    def show_text(self, name: str, detail: str) -> None:
        self._name, self._detail = name, detail
        self.update()

    def show_parameters(self, text: str) -> None:
        """What the shown field was computed for."""
        self._parameters = text
        self.update()

    def show_small(self, on: bool) -> None:
        """Leave out what the field was computed for: the panel on the left says it too."""
        self.setFixedHeight(38 if on else 60)

    def show_source(self, on: bool) -> None:
        """Mark the shape as the source among several: a dot in the accent colour before its name."""
        self._is_source = on
        self.update()

    @property
    def reach(self) -> int:
        """How wide the text is, in steps that a change of a digit does not leave."""
        bold = QFont(self.font())
        bold.setBold(True)
        parameters = self._parameters if self.height() > 40 else ""
        plain = max(self.fontMetrics().horizontalAdvance(line) for line in (self._detail, parameters))
        wide = max(plain, _INDENT + QFontMetrics(bold).horizontalAdvance(self._name))
        return min(5 * GRID * ceil(wide / (5 * GRID)), self.width())

    def draw(self, painter: QPainter) -> None:
        self._pen(painter, "text", bold=True)
        indent = _INDENT if self._is_source else 0
        self._line(painter, 0, self._name, indent)
        self._pen(painter, "muted", size=0.95)
        self._line(painter, 19, self._detail)
        if self.height() > 40:
            self._line(painter, 36, self._parameters)
        if self._is_source:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(self.theme.colour("accent"))
            painter.drawEllipse(QPointF(4, 9), 4, 4)

    def _line(self, painter: QPainter, y: int, text: str, indent: int = 0) -> None:
        width = self.width() - indent
        fitting = painter.fontMetrics().elidedText(text, Qt.TextElideMode.ElideMiddle, width)
        painter.drawText(QRectF(indent, y, width, 18), Qt.AlignmentFlag.AlignLeft, fitting)


class AxesTriad(Overlay):
    """Where the shape's x, y and z point."""

    COLOURS = ("#c0504d", "#4f8f4f", "#3f6fb5")

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, QSize(64, 64))
        self._axes = np.eye(3)

    def show_axes(self, axes: FloatArray) -> None:
        """`axes` (3, 3): rows are the picture's right, up and towards the eye, in the shape's space."""
        if not np.allclose(axes, self._axes):
            self._axes = axes
            self.update()

    def draw(self, painter: QPainter) -> None:
        self._pen(painter, "muted", size=0.85)
        centre = QPointF(self.width() / 2, self.height() / 2)
        for index in np.argsort(self._axes[2]):  # the farthest first
            right, up, near = self._axes[:, index]
            end = centre + QPointF(21 * right, -21 * up)
            colour = QColor(self.COLOURS[index])
            colour.setAlpha(255 if near > -0.2 else 120)
            painter.setPen(round_pen(colour, 2))
            painter.drawLine(centre, end)
            label = centre + QPointF(28 * right, -28 * up)
            if abs(near) < 0.93:
                box = QRectF(label.x() - 8, label.y() - 8, 16, 16)
                painter.drawText(box, Qt.AlignmentFlag.AlignCenter, "xyz"[index])


class FocusFrame(Overlay):
    """Shows that keys go to the view."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, QSize(1, 1))
        self.hide()

    def draw(self, painter: QPainter) -> None:
        painter.setPen(QPen(self.theme.colour("accent"), 2))
        painter.drawRect(self.rect().adjusted(1, 1, -1, -1))


class Hint(Overlay):
    """What to do next, or what is being done, where there is nothing to see yet; long words take several lines."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, QSize(320, 36))
        self._text, self._is_small = "", False

    def show_text(self, text: str) -> None:
        self._text = text
        self.setVisible(bool(text))
        self.update()

    def fit(self, width: int, *, small: bool) -> None:
        """Take up at most `width`; a small one lies in the strip that is kept free for a small colour bar."""
        self._is_small = small
        self.setFixedSize(
            QSize(max(width, 1), ColourBar.SMALL.height()) if small else QSize(max(140, min(400, width)), 128)
        )
        self.update()

    def draw(self, painter: QPainter) -> None:
        self._pen(painter, "text", size=0.9 if self._is_small else 1.0)
        across, down = (10, 3) if self._is_small else (16, 7)
        flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
        room = QSizeF(self.width() - 2 * across - 2, self.height() - 2 * down - 1)
        text = _cut(painter, flags, room, self._text)
        words = _balanced(painter, flags, room.width(), text)
        width, height = words.width() + 2 * across, words.height() + 2 * down
        left = self.width() - width - 1
        box = QRectF(0.5 * left if self._is_small else left, self.height() - height - 1, width, height)
        painter.setBrush(self.theme.colour("panel"))
        painter.setPen(QPen(self.theme.colour("line"), 1))
        painter.drawRoundedRect(box, min(16.0, 0.5 * height), min(16.0, 0.5 * height))
        painter.setPen(self.theme.colour("text"))
        painter.drawText(box.adjusted(across - 1, 0, 1 - across, 0), flags, text)


def _wrapped(painter: QPainter, flags: int, width: float, text: str) -> QSizeF:
    """Size of `text` broken into lines of at most `width`."""
    return painter.boundingRect(QRectF(0, 0, width, 1000), flags, text).size()


def _cut(painter: QPainter, flags: int, room: QSizeF, text: str) -> str:
    """As many words as there is room for."""
    words = text.split()
    for count in range(len(words), 0, -1):
        shown = " ".join(words[:count]) + ("" if count == len(words) else "…")
        if _wrapped(painter, flags, room.width(), shown).height() <= room.height():
            return shown
    return "…"


def _balanced(painter: QPainter, flags: int, width: float, text: str) -> QSizeF:
    """Size of `text` in as few lines as this width needs, each about as long as the others."""
    usual = _wrapped(painter, flags, width, text)
    for share in (0.5, 0.6, 0.7, 0.8, 0.9):
        narrower = _wrapped(painter, flags, share * width, text)
        if narrower.height() <= usual.height() and narrower.width() <= share * width:
            return narrower
    return usual
