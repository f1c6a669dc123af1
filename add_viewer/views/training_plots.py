"""Live curves of a training: its loss, and its scores on shapes that it does not see."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from add_core.drawing.colours import MARKERS, hex_colour

from ..models.training_curves import SCORE_HELP, SCORES, TrainingCurves, Validation, binned
from .plot import ABOVE, RIGHT, Line, Plot, round_ticks
from .theme import LIGHT, Theme

_LEAST_WIDTH = 520
_POINTS = 80
_COLOURS = dict(zip(SCORES, MARKERS, strict=False))


class TrainingPlots(QWidget):
    """Draws `TrainingCurves`; a cursor over them shows the scores of the validation nearest to it."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._curves, self._theme, self._hovered = TrainingCurves(), LIGHT, -1.0
        self._plots: list[Plot] = []
        self.waiting_text = ""
        self.setMouseTracking(True)
        self.setToolTip(SCORE_HELP)
        self.setMinimumSize(200, 120)

    def show_curves(self, curves: TrainingCurves) -> None:
        """Draw these curves from now on."""
        self._curves = curves
        self.update()

    def show_theme(self, theme: Theme) -> None:
        """Draw in the theme's colours."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:
        return QSize(600, 200)

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(_small(self.font()))
        if not self._curves.steps:
            painter.setPen(self._theme.colour("muted"))
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, self.waiting_text)
        else:
            self._paint(painter)
        painter.end()

    def _paint(self, painter: QPainter) -> None:
        left, right = self._halves()
        end = max(self._curves.total, self._curves.last_step)
        lines = self._loss_lines()
        highest = max((max(line.y) for line in lines if line.y), default=1.0)
        loss = Plot(painter, left, self._theme, end, 1.05 * highest)
        loss.axes("Loss", round_ticks(0, 1.05 * highest, 4))
        loss.lines(lines)
        scores = Plot(painter, right, self._theme, end, 1.0)
        scores.axes("On unseen shapes", [0.0, 0.5, 1.0])
        scores.lines(self._score_lines())
        best = self._curves.best
        if best is not None:
            scores.ring(best.step, best.cmc1, QColor(hex_colour(_COLOURS["cmc1"])))
        self._plots = [loss, scores]
        self._paint_hovered(painter)

    def _halves(self) -> tuple[QRectF, QRectF]:
        """Side by side, or one above the other where there is no room."""
        whole = QRectF(self.rect()).adjusted(0, 2, 0, 0)
        if self.width() >= _LEAST_WIDTH or self.width() > 2 * self.height():
            half = whole.width() / 2
            return whole.adjusted(0, 0, -half, 0), whole.adjusted(half, 0, 0, 0)
        half = whole.height() / 2
        return whole.adjusted(0, 0, 0, -half), whole.adjusted(0, half, 0, 0)

    def _loss_lines(self) -> list[Line]:
        curves, theme = self._curves, self._theme
        steps, losses = binned(curves.steps, curves.losses, _POINTS)
        seen = Line(f"training {losses[-1]:.2f}", steps, losses, theme.colour("muted"), 1.0, dots=False)
        if not curves.validations:
            return [seen]
        x, y = [each.step for each in curves.validations], [each.loss for each in curves.validations]
        return [seen, Line(f"unseen {y[-1]:.2f}", x, y, theme.colour("accent"))]

    def _score_lines(self) -> list[Line]:
        lines = []
        for name, title in SCORES.items():
            known = [each for each in self._curves.validations if getattr(each, name) is not None]
            if known:
                x, y = [each.step for each in known], [getattr(each, name) for each in known]
                lines.append(Line(f"{title} {y[-1]:.2f}", x, y, QColor(hex_colour(_COLOURS[name]))))
        return lines

    # -- hovering -----------------------------------------------------------------------------------------------------

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        end = max(self._curves.total, self._curves.last_step)
        over = next((plot for plot in self._plots if plot.inside.contains(event.position())), None)
        self._hovered = (
            -1.0 if over is None else end * (event.position().x() - over.inside.left()) / over.inside.width()
        )
        self.update()

    def leaveEvent(self, _event: object) -> None:
        self._hovered = -1.0
        self.update()

    def _paint_hovered(self, painter: QPainter) -> None:
        if self._hovered < 0 or not self._curves.validations:
            return
        nearest = min(self._curves.validations, key=lambda each: abs(each.step - self._hovered))
        for plot in self._plots:
            plot.upright(nearest.step, self._theme.colour("muted"))
        inside = self._plots[1].inside
        room = QRectF(inside.left(), inside.top() - ABOVE, inside.width() + RIGHT, ABOVE - 2)
        painter.setPen(self._theme.colour("muted"))
        words = QFontMetricsF(painter.font()).elidedText(
            _scores_of(nearest), Qt.TextElideMode.ElideRight, room.width() - 110
        )
        painter.drawText(room.adjusted(110, 0, 0, 0), Qt.AlignmentFlag.AlignVCenter, words)


def _scores_of(validation: Validation) -> str:
    known = {title: getattr(validation, name) for name, title in SCORES.items()}
    scores = ", ".join(f"{title} {value:.3f}" for title, value in known.items() if value is not None)
    return f"step {validation.step:,}: {scores}"


def _small(font: QFont) -> QFont:
    small = QFont(font)
    small.setPointSizeF(0.88 * font.pointSizeF())
    return small
