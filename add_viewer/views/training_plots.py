"""Live curves of a training: its loss, and its scores on shapes that it does not see."""

from __future__ import annotations

from bisect import bisect_left

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from add_core.drawing.colours import MARKERS, hex_colour

from ..models.training_curves import SCORE_HELP, SCORES, TrainingCurves, Validation, binned
from .plot import Line, Plot, round_ticks
from .theme import LIGHT, Theme

_LEAST_WIDTH = 520
_POINTS = 80
_SHARES = (0.0, 0.5, 1.0)
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
        end, seen = max(self._curves.total, self._curves.last_step), self._seen()
        lines = self._loss_lines(seen)
        highest = 1.05 * max(max(line.y) for line in lines)
        loss = Plot(painter, left, self._theme, end, highest)
        loss.axes("Loss", round_ticks(0, highest, 4))
        loss.lines(lines)
        scores = Plot(painter, right, self._theme, end, 1.0)
        scores.axes(
            "On unseen shapes" + (f", after step {seen.step:,}" if self._hovered >= 0 and seen else ""), _SHARES
        )
        scores.lines(self._score_lines(seen))
        best = self._curves.best
        if best is not None:
            scores.ring(best.step, best.cmc1, QColor(hex_colour(_COLOURS["cmc1"])))
        self._plots = [loss, scores]
        if seen is not None and self._hovered >= 0:
            for plot in self._plots:
                plot.upright(seen.step, self._theme.colour("muted"))

    def _seen(self) -> Validation | None:
        """The validation whose numbers are shown: the one under the cursor, or the latest."""
        if self._hovered < 0 or not self._curves.validations:
            return self._curves.latest
        return min(self._curves.validations, key=lambda each: abs(each.step - self._hovered))

    def _halves(self) -> tuple[QRectF, QRectF]:
        """Side by side, or one above the other where there is no room."""
        whole = QRectF(self.rect()).adjusted(0, 2, 0, 0)
        if self.width() >= _LEAST_WIDTH or self.width() > 2 * self.height():
            half = whole.width() / 2
            return whole.adjusted(0, 0, -half, 0), whole.adjusted(half, 0, 0, 0)
        half = whole.height() / 2
        return whole.adjusted(0, 0, 0, -half), whole.adjusted(0, half, 0, 0)

    def _loss_lines(self, seen: Validation | None) -> list[Line]:
        curves, theme = self._curves, self._theme
        steps, losses = binned(curves.steps, curves.losses, _POINTS)
        where = len(steps) - 1 if seen is None or self._hovered < 0 else bisect_left(steps, seen.step)
        now = losses[min(where, len(losses) - 1)]
        training = Line(f"training {now:.2f}", steps, losses, theme.colour("muted"), 1.0, dots=False)
        if seen is None:
            return [training]
        x, y = [each.step for each in curves.validations], [each.loss for each in curves.validations]
        return [training, Line(f"unseen {seen.loss:.2f}", x, y, theme.colour("accent"))]

    def _score_lines(self, seen: Validation | None) -> list[Line]:
        lines = []
        for name, title in SCORES.items():
            known = [each for each in self._curves.validations if getattr(each, name) is not None]
            value = None if seen is None else getattr(seen, name)
            if known and value is not None:
                x, y = [each.step for each in known], [getattr(each, name) for each in known]
                lines.append(Line(f"{title} {value:.2f}", x, y, QColor(hex_colour(_COLOURS[name]))))
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


def _small(font: QFont) -> QFont:
    small = QFont(font)
    small.setPointSizeF(0.88 * font.pointSizeF())
    return small
