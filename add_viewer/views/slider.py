"""A slider on any scale, with named ticks and a field to type into."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPalette, QPen, QWheelEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QSizePolicy, QWidget

from ..models.scales import Scale
from .number_field import NumberField
from .theme import GRID, round_pen

_HANDLE = 7.0
_KEY_STEPS = {
    Qt.Key.Key_Left: -0.01,
    Qt.Key.Key_Down: -0.01,
    Qt.Key.Key_Right: 0.01,
    Qt.Key.Key_Up: 0.01,
    Qt.Key.Key_PageDown: -0.1,
    Qt.Key.Key_PageUp: 0.1,
    Qt.Key.Key_Home: -1.0,
    Qt.Key.Key_End: 1.0,
}


class TickSlider(QWidget):
    """Emits `moved` with a number while a person drags, `released` afterwards, `reset` on a double click."""

    moved = Signal(float)
    released = Signal()
    reset = Signal()

    def __init__(self, scale: Scale, ticks: list[tuple[float, str]], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._scale, self._ticks = scale, ticks
        self._position = 0.0
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def sizeHint(self) -> QSize:
        return QSize(160, 2 * GRID + self.fontMetrics().height() + 8)

    def show_value(self, value: float) -> None:
        """Move the handle without announcing it."""
        self._position = self._scale.position(value)
        self.update()

    def place_of(self, value: float) -> QPointF:
        """Where the handle stands for `value`, in this widget."""
        return QPointF(self._x(self._scale.position(value)), _HANDLE + 2)

    def _x(self, position: float) -> float:
        return _HANDLE + 1 + position * (self.width() - 2 * _HANDLE - 2)

    def _go(self, position: float) -> None:
        self._position = min(max(position, 0.0), 1.0)
        self.update()
        self.moved.emit(self._scale.value(self._position))

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

    def wheelEvent(self, event: QWheelEvent) -> None:
        if self.hasFocus():
            self._go(self._position + 0.01 * event.angleDelta().y() / 120)
        else:
            event.ignore()  # scrolling the panel must not change numbers by accident

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = _KEY_STEPS.get(Qt.Key(event.key()))
        if step is None:
            event.ignore()
        else:
            self._go(self._position + step)

    def _follow(self, event: QMouseEvent) -> None:
        self._go((event.position().x() - _HANDLE - 1) / max(self.width() - 2 * _HANDLE - 2, 1))

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        palette, y = self.palette(), _HANDLE + 2
        line, accent = palette.color(QPalette.ColorRole.Mid), palette.color(QPalette.ColorRole.Highlight)
        if not self.isEnabled():
            accent = line
        painter.setPen(round_pen(line, 3))
        painter.drawLine(QPointF(self._x(0), y), QPointF(self._x(1), y))
        painter.setPen(round_pen(accent, 3))
        painter.drawLine(QPointF(self._x(0), y), QPointF(self._x(self._position), y))
        self._paint_ticks(painter, y)
        self._paint_handle(painter, QPointF(self._x(self._position), y), accent)

    def _paint_handle(self, painter: QPainter, place: QPointF, accent: QColor) -> None:
        if self.hasFocus():
            halo = QColor(accent)
            halo.setAlpha(70)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(halo)
            painter.drawEllipse(place, _HANDLE + 2, _HANDLE + 2)
        painter.setPen(QPen(accent, 2))
        painter.setBrush(self.palette().color(QPalette.ColorRole.Base))
        painter.drawEllipse(place, _HANDLE - 1, _HANDLE - 1)

    def _paint_ticks(self, painter: QPainter, y: float) -> None:
        muted = self.palette().color(QPalette.ColorRole.PlaceholderText)
        small = painter.font()
        small.setPointSizeF(0.85 * small.pointSizeF())
        painter.setFont(small)
        painter.setPen(QPen(muted, 1))
        for value, label in self._ticks:
            x = self._x(self._scale.position(value))
            painter.drawLine(QPointF(x, y + _HANDLE + 1), QPointF(x, y + _HANDLE + 4))
            width = painter.fontMetrics().horizontalAdvance(label) + 2
            left = min(max(x - width / 2, 0.0), self.width() - width)
            box = QRectF(left, y + _HANDLE + 5, width, painter.fontMetrics().height())
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, label)


class SliderRow(QWidget):
    """A name, a field and a slider for one number.

    changed : the person chose a number. finished : they let go. reset : they want the default.
    """

    changed = Signal(float)
    finished = Signal()
    reset = Signal()

    def __init__(
        self,
        name: str,
        unit: str,
        help_text: str,
        *,
        scale: Scale,
        ticks: list[tuple[float, str]],
        show_as: Callable[[float], str],
        step: Callable[[float, int], float],
    ) -> None:
        super().__init__()
        self.field = NumberField(show_as=show_as, step=step)
        self.slider = TickSlider(scale, ticks)
        self.label, self.unit = QLabel(name), QLabel(unit)
        self.label.setBuddy(self.field)
        self._lay_out()
        for widget in (self, self.field, self.slider):
            widget.setToolTip(help_text)
        self.field.setAccessibleName(name.replace("&", ""))
        self.slider.setAccessibleName(name.replace("&", "") + " slider")
        self._connect()

    def show_value(self, value: float | None, *, slider_value: float | None = None) -> None:
        """Show a number in the field and on the slider (its own number there, if it is of another kind)."""
        self.field.show_value(value)
        on_slider = value if slider_value is None else slider_value
        if on_slider is not None:
            self.slider.show_value(on_slider)

    def _lay_out(self) -> None:
        self.field.setFixedWidth(11 * GRID)
        self.unit.setProperty("role", "muted")
        self.unit.setFixedWidth(3 * GRID)
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(GRID // 2)
        grid.setVerticalSpacing(GRID // 2)
        grid.addWidget(self.label, 0, 0)
        grid.addWidget(self.field, 0, 1)
        grid.addWidget(self.unit, 0, 2)
        grid.addWidget(self.slider, 1, 0, 1, 3)
        grid.setColumnStretch(0, 1)

    def _connect(self) -> None:
        self.field.entered.connect(self.changed)
        self.field.entered.connect(self.finished)
        self.slider.released.connect(self.finished)
        self.slider.moved.connect(self._slid)
        self.slider.reset.connect(self.reset)

    def _slid(self, value: float) -> None:
        self.changed.emit(value)
