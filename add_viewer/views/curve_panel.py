"""The curves at the picked points, linked to the θ dial and the t slider."""

# Matplotlib's Qt backend has no types.
# mypy: disable-error-code=no-untyped-call

from __future__ import annotations

from functools import cached_property
from math import pi, radians
from pathlib import Path
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import MouseEvent
from matplotlib.backends.backend_qtagg import FigureCanvasQTAgg
from matplotlib.figure import Figure
from PySide6.QtCore import QEvent, QSize, Qt, QTimer
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QStackedLayout, QVBoxLayout, QWidget

from ..models.captions import describe
from ..models.display import Display
from ..models.results import Results
from ..models.session import Session
from .curve_plots import CurvePlots, CurveScene
from .theme import GRID, LIGHT, Theme

_PATIENCE = 100
"""Milliseconds that the crosshair waits for the kernel's picture."""

_RENEWAL_PATIENCE, _FIRST_PATIENCE = 200, 300
"""Milliseconds that new axes wait for the shapes' next and first pictures: drawing them takes as long as a hundred
curves."""

_SWITCHES = ("relative_curves", "reflected_curves")

LEGEND = "Thick: the shown t.  Thin: t/10, dashed: 10 t.  Right: thick AHKS at θ, thin HKS (α = 0) at equal t·λ₁."


class CurvePanel(QWidget):
    """AHKS over θ (Cartesian and polar) and over t, with the HKS beside it; drag in a plot to turn θ or move t."""

    def __init__(self, session: Session, results: Results, display: Display, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._results, self._display, self._theme = session, results, display, LIGHT
        self.figure = Figure()
        self.canvas = _BlittedCanvas(self.figure)
        self._empty = QLabel("Pick a point to see how much heat stays there, for every direction and time")
        self._empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._empty.setWordWrap(True)
        self._empty.setProperty("role", "muted")
        self._legend = QLabel()
        self._legend.setProperty("role", "muted")
        self._lay_out()
        self._connect()

    @cached_property
    def plots(self) -> CurvePlots:
        """Made when they are drawn first: axes take a tenth of a second, which the first picture must not wait for."""
        made = CurvePlots(self.figure)
        self.canvas.place = self._place
        return made

    def _lay_out(self) -> None:
        plots = QWidget()
        column = QVBoxLayout(plots)
        column.setContentsMargins(0, 0, 0, GRID // 2)
        column.setSpacing(0)
        column.addWidget(self.canvas, 1)
        row = QHBoxLayout()
        row.setContentsMargins(2 * GRID, 0, 2 * GRID, 0)
        row.addWidget(self._legend, 1)
        column.addLayout(row)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self._empty)
        self._stack.addWidget(plots)

    def _connect(self) -> None:
        self._frame = QTimer(self, singleShot=True, interval=_PATIENCE)
        self._frame.timeout.connect(self._draw_moving)
        self._renewal = QTimer(self, singleShot=True)
        self._renewal.timeout.connect(self._draw_all)
        for event in ("button_press_event", "motion_notify_event"):
            self.canvas.mpl_connect(event, self._dragged)
        self.canvas.mpl_connect("button_release_event", lambda _event: self._session.end_gesture())
        self._session.picks_changed.connect(self._postpone)
        self._results.curves_changed.connect(self._show_curves)
        self._session.diffusion_changed.connect(self._move)
        self._results.kernel_changed.connect(self._move_with_kernel)
        self._display.changed.connect(lambda name: self._show_curves() if name in _SWITCHES else None)

    # -- models to view -----------------------------------------------------------------------------------------------

    def scene(self, theme: Theme | None = None) -> CurveScene:
        """What is shown now, for another theme if wanted."""
        diffusion = self._session.state.diffusion
        relative, reflected = (self._display[name] for name in _SWITCHES)
        curves = self._results.curves
        return CurveScene(curves, diffusion.theta, diffusion.reach, relative, theme or self._theme, reflected)

    def _show_curves(self) -> None:
        curves = self._results.curves
        self._stack.setCurrentIndex(1 if curves else 0)
        self._legend.setText(LEGEND)
        if not self.scene().shown:
            self._draw_moving()  # nothing to fit axes to yet, and a kernel is waited for
        else:
            self._renew()

    def _move(self) -> None:
        if not self._frame.isActive():
            self._frame.start()

    def _move_with_kernel(self) -> None:
        # Every repaint of any part composes the whole window: crosshair and kernel share one.
        if self._frame.isActive():
            self._frame.stop()
            self._draw_moving()

    def _renew(self, patience: int = _RENEWAL_PATIENCE) -> None:
        if not self.is_due:
            self._renewal.start(patience)

    @property
    def is_due(self) -> bool:
        """Whether there are curves that wait to be drawn."""
        return self._renewal.isActive()

    def _postpone(self) -> None:
        """Axes that are due for the last pick wait until the shapes show this one."""
        if self.is_due:
            self._renewal.start(_RENEWAL_PATIENCE)

    def _place(self) -> None:
        ratio = self.figure.dpi / self.canvas.device_pixel_ratio / 72.0  # device-independent pixels in a point
        width, height = self.canvas.get_width_height()
        self.plots.lay_out(width / ratio, height / ratio)

    def _draw_all(self) -> None:
        plots = self.plots
        self._place()
        plots.draw_static(self.scene())
        self.canvas.draw()
        self.canvas.draw_artists(self.plots.moving_artists(self.scene()))

    def _draw_moving(self) -> None:
        if self._results.curves and self.isVisible():
            scene = self.scene()
            if self.plots.fits(scene):
                self.canvas.draw_artists(self.plots.moving_artists(scene))
            else:
                self._renew()

    def show_theme(self, theme: Theme) -> None:
        """Draw the plots in the theme's colours."""
        self._theme = theme
        if self.isVisible():
            self._draw_all()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._renew(_FIRST_PATIENCE)

    # -- what a person does -------------------------------------------------------------------------------------------

    def _dragged(self, event: MouseEvent) -> None:
        if event.button != 1 or event.xdata is None or event.ydata is None or not self._results.curves:
            return
        if event.inaxes is self.plots.theta_axes:
            self._session.diffuse(theta=radians(event.xdata) % pi)
        elif event.inaxes is self.plots.polar_axes:
            self._session.diffuse(theta=event.xdata % pi)
        elif event.inaxes is self.plots.time_axes:
            self._session.diffuse(reach=event.xdata * self._results.curves[0].weyl_eigenvalue)

    def save(self, path: Path, theme: Theme) -> None:
        """Write the plots to a PNG, SVG or PDF, with a caption that says what they show."""
        shown = self.canvas.get_width_height()
        width, height = max(shown[0], 640), max(shown[1], 200) + 40
        figure = Figure(figsize=(width / 100, height / 100), dpi=100)
        self.draw_into(figure, 0.72 * width, 0.72 * height, theme)
        figure.savefig(path, dpi=300, format=path.suffix.lstrip(".").lower())

    def draw_into(self, figure: Any, width: float, height: float, theme: Theme) -> None:
        """Draw plots and caption into a figure, or a part of one, of this size in points."""
        plots = CurvePlots(figure)
        plots.lay_out(width, height, below=32.0)
        scene = self.scene(theme)
        plots.draw_static(scene)
        for axes, artist in plots.moving_artists(scene):
            artist.set_animated(False)
            axes.add_artist(artist)
        for line, text in enumerate((LEGEND, self._caption())):
            figure.text(0.02, (8 + 12 * line) / height, text, fontsize=7, color=theme.muted)
        figure.set_facecolor("white")

    def _caption(self) -> str:
        state, curves = self._session.state, self._results.curves
        name = "" if state.active is None else state.active.name
        points = ", ".join(str(each.pick.vertex) + (" (mirror)" if each.pick.is_mirror else "") for each in curves)
        vertices = "vertices" if len(curves) > 1 else "vertex"
        return (
            f"{name}, {vertices} {points}. {describe(state.diffusion, curves[0].weyl_eigenvalue)}" if curves else name
        )

    def sizeHint(self) -> QSize:
        return QSize(720, 240)


class _BlittedCanvas(FigureCanvasQTAgg):
    """Keeps the picture of the axes and draws what moves over it, a few milliseconds a time."""

    def __init__(self, figure: Figure) -> None:
        super().__init__(figure)
        self.place = lambda: None
        self._background: Any = None
        self._moving: list[tuple[Axes, Artist]] = []
        self.mpl_connect("draw_event", self._drawn)
        self.setMinimumSize(200, 120)

    def resizeEvent(self, event: QEvent) -> None:
        super().resizeEvent(event)
        self.place()

    def draw_artists(self, artists: list[tuple[Axes, Artist]]) -> None:
        """Show `artists`, pairs of axes and artist, instead of those shown before."""
        self._moving = artists
        if self._background is not None:
            self.restore_region(self._background)
            self._draw_moving()
            self.update()

    def _drawn(self, _event: object) -> None:
        self._background = self.copy_from_bbox(self.figure.bbox)
        self._draw_moving()

    def _draw_moving(self) -> None:
        renderer = self.get_renderer()
        for _axes, artist in self._moving:
            artist.set_figure(self.figure) if artist.get_figure() is None else None
            artist.draw(renderer)
