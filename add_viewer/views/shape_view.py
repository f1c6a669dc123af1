"""The centre of the window: the canvas, its labels, and what they show of the models."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QSize, Qt, Signal
from PySide6.QtGui import QAction, QImage, QPainter, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from ..models.display import Display
from ..models.kernel_scale import KernelScale
from ..models.results import Results
from ..models.session import Session
from ..models.shapes import OpenShape
from .canvas import Canvas
from .captions import describe
from .overlays import AxesTriad, ColourBar, CornerLabel, Hint, Overlay
from .theme import GRID, Theme

_TOOL = 30
IDLE_TEXT = "Click picks a point · drag turns · wheel zooms · right click for more"
_FRONTS = {"y": "+z", "z": "-y"}


class ShapeView(QWidget):
    """Shows the active shape, its kernel and its picks; a click picks.

    hovered : text for the status line. menu_requested : global place and vertex (-1 beside the shape).
    """

    hovered = Signal(str)
    menu_requested = Signal(QPoint, int)

    def __init__(self, session: Session, results: Results, display: Display, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._results, self._display = session, results, display
        self.canvas = Canvas(self)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.canvas)
        self.colour_bar, self.label = ColourBar(self), CornerLabel(self)
        self.triad, self.hint = AxesTriad(self), Hint(self)
        self._overlays: tuple[Overlay, ...] = (self.colour_bar, self.label, self.triad, self.hint)
        self._tools = QWidget(self)
        self._connect()
        self._show_shape()

    def _connect(self) -> None:
        self.canvas.vertex_clicked.connect(self._clicked)
        self.canvas.vertex_hovered.connect(self._hover)
        self.canvas.menu_requested.connect(self.menu_requested)
        self.canvas.camera_moved.connect(self._show_axes)
        self._session.active_changed.connect(self._show_shape)
        self._session.picks_changed.connect(self._show_picks)
        self._session.diffusion_changed.connect(self._turn)
        self._results.kernel_changed.connect(self._show_kernel)
        self._results.directions_changed.connect(self._show_directions)
        self._display.changed.connect(self._show_display)

    # -- models to view -----------------------------------------------------------------------------------------------

    def _show_shape(self) -> None:
        shape = self._session.state.active
        up, front = self._axes(shape)
        self.canvas.show_shape(shape, up, front)
        self.canvas.show_wireframe(self._display["wireframe"])
        if shape is None:
            self.label.show_text("", "")
        else:
            faces = getattr(shape.shape, "faces", None)
            kind = "points" if faces is None else "vertices"
            self.label.show_text(shape.name, f"{shape.vertex_count:,} {kind}")
        self._show_picks()
        self._show_kernel()
        self._show_directions()

    def _axes(self, shape: OpenShape | None) -> tuple[str, str]:
        chosen = self._display["up_axis"]
        if shape is None:
            return "+y", "+z"
        if chosen == "auto" and shape.up and shape.front:
            return shape.up, shape.front
        if chosen == "auto":  # most things in files stand along y, unless they are clearly taller along z
            _, deep, tall = shape.shape.vertices.max(axis=0) - shape.shape.vertices.min(axis=0)
            chosen = "+z" if tall > 1.2 * deep else "+y"
        return chosen, _FRONTS[chosen[-1]]

    def _show_picks(self) -> None:
        picks = self._session.state.active_picks
        self.canvas.show_picks(picks)
        invites = self._session.state.active is not None and not picks
        self.hint.show_text("Click the body to drop heat on it" if invites else "")

    def _show_kernel(self) -> None:
        field = self._results.kernel
        shape = self._session.state.active
        shown = field if field is not None and shape is not None and field.shape == shape.key else None
        self.colour_bar.setVisible(shown is not None and self._display["colour_bar"])
        self.label.show_parameters(
            "" if shown is None else describe(shown.diffusion, shown.diffusion.reach / shown.time)
        )
        if shown is None:
            self.canvas.show_field(None)
            return
        single = len(shown.picks) == 1
        values = shown.values if single else shown.shares
        scale = KernelScale.of(values, self._display["kernel_scale"])
        self.canvas.show_field(scale.position(values))
        kind = "log scale" if scale.kind == "log" else "linear scale"
        if single:
            self.colour_bar.show_scale("Heat kernel h(x, ·)", ("unit 1/⌀²", kind), scale.ticks())
        else:
            self.colour_bar.show_scale("Heat kernels h(x, ·)", ("each ÷ its maximum", kind), scale.ticks())

    def _show_directions(self) -> None:
        directions, shape = self._results.directions, self._session.state.active
        fits = directions is not None and shape is not None and directions.shape == shape.key
        self.canvas.show_directions(directions if fits and self._display["arrows"] else None)
        self._turn()

    def _turn(self) -> None:
        self.canvas.turn_directions(self._session.state.diffusion.theta)

    def _show_display(self, name: str) -> None:
        if name == "wireframe":
            self.canvas.show_wireframe(self._display["wireframe"])
        elif name in ("colour_bar", "kernel_scale"):
            self._show_kernel()
        elif name == "arrows":
            self._show_directions()
        elif name == "up_axis":
            self._show_shape()

    def _show_axes(self) -> None:
        self.triad.show_axes(self.canvas.camera_model.axes)

    def show_theme(self, theme: Theme) -> None:
        """Colours of background and labels."""
        self.canvas.show_theme(theme)
        for overlay in self._overlays:
            overlay.show_theme(theme)

    def show_tools(self, actions: list[QAction]) -> None:
        """Offer `actions` as icons in the upper right corner of the view."""
        row = QHBoxLayout(self._tools)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(GRID // 2)
        for action in actions:
            button = QToolButton()
            button.setDefaultAction(action)
            button.setIconSize(QSize(18, 18))
            button.setFixedSize(_TOOL, _TOOL)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            row.addWidget(button)
        self._tools.setFixedSize(len(actions) * (_TOOL + GRID // 2), _TOOL)

    # -- what a person does -------------------------------------------------------------------------------------------

    def _clicked(self, vertex: int, modifiers: Qt.KeyboardModifier) -> None:
        if vertex < 0:
            return
        if modifiers & Qt.KeyboardModifier.AltModifier:
            self._session.pick_mirror(vertex)
        else:
            self._session.pick(vertex, add=bool(modifiers & Qt.KeyboardModifier.ShiftModifier))

    def _hover(self, vertex: int) -> None:
        if vertex < 0:
            self.hovered.emit(IDLE_TEXT)
            return
        field = self._results.kernel
        symbol = "h" if field is None or len(field.picks) == 1 else "Σ h"
        value = f"   {symbol} = {field.values[vertex]:.4g} /⌀²" if field is not None else ""
        self.hovered.emit(f"Vertex {vertex}{value}")

    # -- layout and pictures ------------------------------------------------------------------------------------------

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        width, height, gap = self.width(), self.height(), 2 * GRID
        self.label.move(gap, gap)
        self._tools.move(width - self._tools.width() - gap, gap)
        self.triad.move(gap - 4, height - self.triad.height() - gap + 4)
        self.colour_bar.move(width - self.colour_bar.width() - gap, height - self.colour_bar.height() - gap)
        self.hint.move(width - self.hint.width() - gap, height - self.hint.height() - gap)

    def picture(self, scale: float, *, transparent: bool = False, labels: bool = True) -> QImage:
        """What the view shows at `scale` times its size, without the hint."""
        image = self.canvas.picture(scale, transparent=transparent)
        if labels:
            painter = QPainter(image)
            painter.scale(image.width() / self.width(), image.height() / self.height())
            for overlay in (self.colour_bar, self.label, self.triad):
                if overlay.isVisibleTo(self):
                    painter.save()
                    painter.translate(overlay.pos())
                    overlay.draw(painter)
                    painter.restore()
            painter.end()
        return image

    def sizeHint(self) -> QSize:
        return QSize(720, 560)
