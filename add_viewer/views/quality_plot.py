"""The Princeton protocol of the shown matchings, as in the paper's Figure 9."""

from __future__ import annotations

from typing import Any

from matplotlib.backends.backend_qtagg import FigureCanvasQTAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QFont, QFontMetrics, QResizeEvent
from PySide6.QtWidgets import QLabel, QStackedLayout, QVBoxLayout, QWidget

from add_core.drawing.colours import MARKERS, hex_colour

from ..models.insights import Insights, MatchQuality
from ..models.session import Session
from .theme import GRID, LIGHT, Theme

LEGEND = (
    "Share of matches within a geodesic radius of the truth. Solid: a mirror image counts as right; dashed: as wrong. "
    "Thin: the other position of Refined. On the right: the share of exact matches."
)
_SWATCH = 2.0 * GRID


class QualityPlot(QWidget):
    """One colour for each target, solid symmetric and dashed asymmetric; what the switch does not show is thin."""

    def __init__(self, session: Session, insights: Insights) -> None:
        super().__init__()
        self._session, self._insights, self._theme = session, insights, LIGHT
        self.figure = Figure()
        self.canvas: QWidget = FigureCanvasQTAgg(self.figure)  # type: ignore[no-untyped-call]
        self.empty = QLabel("Choose a matching of shapes whose true correspondence is known to see how good it is")
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "muted")
        legend = QLabel(LEGEND)
        legend.setProperty("role", "muted")
        legend.setContentsMargins(2 * GRID, 0, 2 * GRID, GRID // 2)
        legend.setWordWrap(True)
        plot = QWidget()
        column = QVBoxLayout(plot)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.canvas, 1)
        column.addWidget(legend)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self.empty)
        self._stack.addWidget(plot)
        insights.qualities_changed.connect(self._show)
        session.matching_changed.connect(self._show)

    @property
    def shown(self) -> list[MatchQuality]:
        """The targets whose quality is known."""
        return [quality for quality in self._insights.qualities if quality.curves]

    def _show(self) -> None:
        self._stack.setCurrentIndex(1 if self.shown else 0)
        if self.isVisible():
            self._draw()

    def showEvent(self, event: Any) -> None:
        super().showEvent(event)
        self._draw()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self.isVisible():
            self._draw()  # the labels' share of the width has changed

    def _draw(self) -> None:
        theme = self._theme
        self.figure.clear()
        self.figure.set_facecolor(theme.window)
        labels = [self._label(quality) for quality in self.shown]
        axes = self.figure.add_axes((0.08, 0.24, 0.90 - self._room(labels), 0.62))
        axes.set_facecolor(theme.panel)
        axes.tick_params(colors=theme.muted, labelsize=8, length=3, width=0.8)
        axes.grid(True, color=theme.grid, linewidth=0.8)
        for spine in axes.spines.values():
            spine.set_color(theme.line)
        axes.set_xlim(0.0, 0.3)
        axes.set_ylim(0.0, 1.0)
        axes.set_yticks([0, 0.25, 0.5, 0.75, 1], ["0", "25 %", "50 %", "75 %", "100 %"])
        axes.set_xlabel("geodesic error ÷ √area", color=theme.muted, fontsize=8, labelpad=1)
        axes.set_title("Matches within that error", loc="left", fontsize=9, color=theme.text, pad=4)
        for number, (quality, label) in enumerate(zip(self.shown, labels, strict=True)):
            self._draw_curves(axes, _colour(number), quality)
            self._name(axes, number, label)
        self.canvas.draw()  # type: ignore[attr-defined]

    def _draw_curves(self, axes: Any, colour: str, quality: MatchQuality) -> None:
        refined = self._session.state.matching.refined
        for (stage, symmetric), curve in quality.curves.items():
            width, alpha = (2.0, 1.0) if stage == refined else (1.0, 0.5)
            axes.plot(curve.x, curve.y, color=colour, lw=width, alpha=alpha, ls="-" if symmetric else "--")

    def _name(self, axes: Any, number: int, label: str) -> None:
        """Beside the axes, after a swatch of the target's colour."""
        room, size = axes.get_position(), self.canvas.size()
        wide, high = _SWATCH / (room.width * max(size.width(), 1)), GRID / (room.height * max(size.height(), 1))
        middle = 1.0 - high - min(0.2, 1.0 / len(self.shown)) * number
        place: dict[str, Any] = {"transform": axes.transAxes, "clip_on": False}
        axes.add_patch(Rectangle((1.02, middle - high / 2), wide, high, color=_colour(number), **place))
        axes.text(1.02 + 1.4 * wide, middle, label, fontsize=8, color=self._theme.text, va="center", **place)

    def _label(self, quality: MatchQuality) -> str:
        state = self._session.state
        shape = state.shape(quality.target)
        name = "" if shape is None else self._small.elidedText(shape.name, Qt.TextElideMode.ElideMiddle, 20 * GRID)
        return f"{100 * quality.curves[state.matching.refined, False].exact:.0f} %  {name}"

    def _room(self, labels: list[str]) -> float:
        """Share of the width that the labels need."""
        widest = max((self._small.horizontalAdvance(label) for label in labels), default=0)
        return min((widest + 3 * GRID + 1.4 * _SWATCH) / max(self.canvas.width(), 1), 0.4)

    @property
    def _small(self) -> QFontMetrics:
        font = QFont(self.font())
        font.setPointSizeF(8.0 * self.figure.dpi / self.logicalDpiX())
        return QFontMetrics(font)

    def show_theme(self, theme: Theme) -> None:
        """Draw in the theme's colours."""
        self._theme = theme
        if self.isVisible():
            self._draw()

    def sizeHint(self) -> QSize:
        return QSize(720, 240)


def _colour(number: int) -> str:
    """Of the target `number`: told apart by colour-blind readers, on light and dark."""
    return hex_colour(MARKERS[number % len(MARKERS)])
