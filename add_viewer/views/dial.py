"""The angle θ as a pointer in the tangent plane."""

from __future__ import annotations

from functools import cache
from math import atan2, cos, pi, radians, sin

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QConicalGradient,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPalette,
    QPen,
    QWheelEvent,
)
from PySide6.QtWidgets import QSizePolicy, QWidget

from add_core.drawing.colours import hex_colour, theta_colour

from .theme import round_pen

SNAP = radians(15.0)
_ABOVE, _BELOW = 26.0, 10.0
"""Room around the plane: for "90°" above, and for the ring of hues alone below."""
_KEYS = {
    Qt.Key.Key_Left: 1.0,
    Qt.Key.Key_Up: 1.0,
    Qt.Key.Key_Right: -1.0,
    Qt.Key.Key_Down: -1.0,
    Qt.Key.Key_PageUp: 15.0,
    Qt.Key.Key_PageDown: -15.0,
}


class ThetaDial(QWidget):
    """The tangent plane seen from outside: maximum curvature across, minimum upright, θ counter-clockwise.

    Directions have no sign, so the pointer has two ends and the dial period 180°. Ctrl snaps to 15°; arrow keys turn by
    1°, with Ctrl to the next 15°; a double click resets.
    """

    turned = Signal(float)
    released = Signal()
    reset = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theta = 0.0
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setAccessibleName("Direction θ dial")

    def sizeHint(self) -> QSize:
        return QSize(264, 168)

    def show_theta(self, theta: float) -> None:
        """Turn the pointer without announcing it."""
        self._theta = theta
        self.update()

    def place_of(self, theta: float, share: float = 0.8) -> QPointF:
        """Where the pointer's end lies for `theta`, at a share of the radius."""
        reach = share * self._radius
        return self._centre + QPointF(reach * cos(theta), -reach * sin(theta))

    @property
    def _centre(self) -> QPointF:
        return QPointF(self.width() / 2, self.height() / 2 + 0.5 * (_ABOVE - _BELOW))

    @property
    def _radius(self) -> float:
        return min(self.width() / 2 - _ABOVE, 0.5 * (self.height() - _ABOVE - _BELOW))

    def _turn(self, theta: float) -> None:
        self.turned.emit(theta % pi)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._follow(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._follow(event)

    def mouseReleaseEvent(self, _event: QMouseEvent) -> None:
        self.released.emit()

    def mouseDoubleClickEvent(self, _event: QMouseEvent) -> None:
        self.reset.emit()

    def _follow(self, event: QMouseEvent) -> None:
        away = event.position() - self._centre
        if away.manhattanLength() < 4:
            return  # the centre has no direction
        theta = atan2(-away.y(), away.x())
        snaps = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        self._turn(round(theta / SNAP) * SNAP if snaps else theta)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = _KEYS.get(Qt.Key(event.key()))
        if step is None:
            event.ignore()
        elif event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            notch = round(self._theta / SNAP, 6)
            self._turn(SNAP * (int(notch) + 1 if step > 0 else -int(-notch // 1) - 1))
        else:
            self._turn(self._theta + radians(step))

    def wheelEvent(self, event: QWheelEvent) -> None:
        if self.hasFocus():
            self._turn(self._theta + radians(event.angleDelta().y() / 120))
        else:
            event.ignore()

    # -- painting -----------------------------------------------------------------------------------------------------

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint_plane(painter)
        self._paint_ticks(painter)
        self._paint_axes(painter)
        self._paint_pointer(painter)

    def _paint_plane(self, painter: QPainter) -> None:
        centre, radius = self._centre, self._radius
        hues = QConicalGradient(centre, 0.0)
        hues.setStops(_hue_stops())
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(hues)
        painter.drawEllipse(centre, radius + 5, radius + 5)
        painter.setBrush(self.palette().color(QPalette.ColorRole.Base))
        painter.drawEllipse(centre, radius, radius)

    def _paint_ticks(self, painter: QPainter) -> None:
        muted = self.palette().color(QPalette.ColorRole.PlaceholderText)
        small = painter.font()
        small.setPointSizeF(0.85 * small.pointSizeF())
        painter.setFont(small)
        painter.setPen(QPen(muted, 1))
        for step in range(24):
            angle = radians(15 * step)
            painter.drawLine(self.place_of(angle, 1.0), self.place_of(angle, 0.9 if step % 3 == 0 else 0.95))
        for label in (0, 45, 90, 135):
            middle = self.place_of(radians(label), 1.0 + 17.0 / self._radius)
            box = QRectF(middle.x() - 20, middle.y() - 9, 40, 18)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, f"{label}°")

    def _paint_axes(self, painter: QPainter) -> None:
        muted = self.palette().color(QPalette.ColorRole.PlaceholderText)
        painter.setPen(QPen(muted, 1, Qt.PenStyle.DashLine))
        painter.drawLine(self.place_of(0.0), self.place_of(pi))
        painter.drawLine(self.place_of(pi / 2), self.place_of(-pi / 2))
        centre, radius = self._centre, self._radius
        painter.setPen(muted)
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        painter.drawText(
            QRectF(centre.x() - 0.86 * radius, centre.y() + 2, 60, 16), Qt.AlignmentFlag.AlignLeft, "max κ"
        )
        painter.drawText(QRectF(centre.x() - 66, centre.y() + 0.66 * radius, 60, 16), right, "min κ")

    def _paint_pointer(self, painter: QPainter) -> None:
        colour = QColor(hex_colour(theta_colour(self._theta)))
        painter.setPen(round_pen(colour, 4))
        painter.drawLine(self.place_of(self._theta, 0.86), self.place_of(self._theta + pi, 0.86))
        painter.setBrush(self.palette().color(QPalette.ColorRole.Base))
        painter.setPen(QPen(colour, 3))
        painter.drawEllipse(self.place_of(self._theta, 0.86), 5.5, 5.5)
        painter.setBrush(colour)
        painter.drawEllipse(self._centre, 2.5, 2.5)
        if self.hasFocus():
            accent = QColor(self.palette().color(QPalette.ColorRole.Highlight))
            accent.setAlpha(110)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(accent, 2))
            painter.drawEllipse(self._centre, self._radius + 7, self._radius + 7)


@cache
def _hue_stops() -> list[tuple[float, QColor]]:
    return [(step / 48, QColor(hex_colour(theta_colour(2 * pi * step / 48)))) for step in range(49)]
