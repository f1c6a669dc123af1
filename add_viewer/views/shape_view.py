"""One shape in one view: the canvas, its labels, and what they show of the models."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QImage, QPainter, QResizeEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from ..models.captions import invitation
from ..models.display import Display
from ..models.fields import ShapeField, in_common_range
from ..models.results import Results
from ..models.session import Session
from ..models.shapes import OpenShape
from .canvas import Canvas
from .overlays import AxesTriad, ColourBar, CornerLabel, FocusFrame, Hint, Overlay
from .theme import GRID, LIGHT, Theme

IDLE_TEXT = "Click picks a point · drag turns · wheel zooms · right click for more"
_FRONTS = {"y": "+z", "z": "-y"}
_SMALL = QSize(460, 380)
"""Views smaller than this in one direction have smaller labels."""


class ShapeView(QWidget):
    """Shows one open shape, the field of its panel and its picks; a click picks.

    key : of the shape, None before one is open. panel : 0, or 1 for the second field of a split view.
    hovered : text for the status line. menu_requested : global place, key and vertex (-1 beside the shape).
    """

    hovered = Signal(str)
    menu_requested = Signal(QPoint, str, int)

    def __init__(self, session: Session, results: Results, display: Display, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._results, self._display = session, results, display
        self.key: str | None = None
        self.panel = 0
        self._shown: OpenShape | None = None
        self._theme = LIGHT
        self._tools = QSize()
        self.canvas = Canvas(self)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.canvas)
        self.colour_bar, self.label = ColourBar(self), CornerLabel(self)
        self.triad, self.hint, self.frame = AxesTriad(self), Hint(self), FocusFrame(self)
        self._overlays: tuple[Overlay, ...] = (self.colour_bar, self.label, self.triad, self.hint, self.frame)
        self._connect()
        self._smooth()

    def _connect(self) -> None:
        session, results = self._session, self._results
        self.canvas.vertex_clicked.connect(self._clicked)
        self.canvas.vertex_hovered.connect(self._hover)
        self.canvas.menu_requested.connect(
            lambda place, vertex: self.menu_requested.emit(place, self.key or "", vertex)
        )
        self.canvas.camera_moved.connect(self._show_axes)
        self.canvas.reached.connect(self.frame.setVisible)
        for signal in (session.picks_changed, session.active_changed, results.carried_changed):
            signal.connect(self._show_picks)
        session.field_changed.connect(self._show_hint)
        session.diffusion_changed.connect(self._turn)
        session.looks_changed.connect(self._show_look)
        session.arrangement_changed.connect(self._show_field)
        results.fields_changed.connect(self._field_came)
        results.directions_changed.connect(self._show_directions)
        self._display.changed.connect(self._show_display)

    def bind(self, key: str | None, panel: int) -> bool:
        """Show another shape or panel; True if the camera looks at another shape now."""
        shape = None if key is None else self._session.state.shape(key)
        fresh = shape is not self._shown
        if fresh or panel != self.panel or key != self.key:
            self.key, self.panel, self._shown = key, panel, shape
            self._show_shape(fresh=fresh)
        return fresh

    @property
    def shape(self) -> OpenShape | None:
        """The shape that is shown."""
        return self._shown

    @property
    def field(self) -> ShapeField | None:
        """What is drawn, in the range that all views share if they do."""
        if self.key is None:
            return None
        state = self._session.state
        mine = self._results.fields.get((self.panel, self.key))
        if mine is None:
            return None
        if mine.tones == "kernel":
            mine = replace(mine, tones=self._display["kernel_colours"])
        if not state.arrangement.common_range:
            return mine
        others = [self._results.fields.get((self.panel, shape.key)) for shape in state.shown if shape.key != self.key]
        alike = [replace(each, tones=mine.tones) for each in others if each is not None and each.choice == mine.choice]
        return in_common_range([mine, *alike])[0]

    # -- models to view -----------------------------------------------------------------------------------------------

    def _show_shape(self, *, fresh: bool) -> None:
        shape = self._shown
        if fresh:
            self.canvas.show_shape(shape, *self._axes(shape))
        if shape is None:
            self.label.show_text("", "")
        else:
            kind = "points" if getattr(shape.shape, "faces", None) is None else "vertices"
            self.label.show_text(shape.name, f"{shape.vertex_count:,} {kind}")
        self.canvas.setAccessibleName("No shape" if shape is None else f"View of {shape.name}")
        self._show_look()
        self._show_picks()
        self._show_field()
        self._show_directions()

    def _axes(self, shape: OpenShape | None) -> tuple[str, str]:
        chosen = self._display["up_axis"]
        if shape is None:
            return "+y", "+z"
        if chosen == "auto" and shape.up and shape.front:
            return shape.up, shape.front
        if chosen == "auto":  # most things in files stand along y, unless they are clearly taller along z
            _, deep, tall = np.ptp(shape.outline, axis=0)
            chosen = "+z" if tall > 1.2 * deep else "+y"
        return chosen, _FRONTS[chosen[-1]]

    def _show_look(self) -> None:
        if self.key is not None:
            look = self._session.state.look(self.key)
            self.canvas.show_wireframe(look.wireframe or self._display["wireframe"])
            self.canvas.show_point_size(look.point_size)

    def _show_picks(self) -> None:
        state = self._session.state
        own = state.picks_on(self.key)
        self.canvas.show_picks(own or self._results.carried.get(self.key or "", ()))
        self._show_hint()

    def _show_hint(self) -> None:
        state, field = self._session.state, self.field
        is_empty = field is None or field.values is None
        invites = is_empty and self.key == state.active_key and self.panel == 0
        message = "" if field is None else field.message
        self.hint.show_text(self._without_name(message) or (invitation(state) if invites else ""))
        self.setToolTip(message)  # a small view may not have room for all of it

    def _without_name(self, message: str) -> str:
        """The shape's own name stands in the corner of its view."""
        name = "" if self._shown is None else re.escape(self._shown.name)
        return re.sub(rf" of {name}(?= …| is not known|: )", "", message)

    def _field_came(self, panel: int, key: str) -> None:
        if panel == self.panel and (key == self.key or self._session.state.arrangement.common_range):
            self._show_field()

    def _show_field(self) -> None:
        field = self.field
        self.canvas.show_field(field)
        self._show_hint()
        shows_bar = field is not None and field.values is not None and self._display["colour_bar"]
        self.colour_bar.setVisible(shows_bar)
        self.label.show_parameters("" if field is None else field.caption)
        self._leave_room()
        if field is not None and field.values is not None:
            self.colour_bar.show_scale(field.title, field.notes, field.scale.ticks(), field.tones)

    def _show_directions(self) -> None:
        directions = self._results.directions.get(self.key or "")
        self.canvas.show_directions(directions if self._display["arrows"] else None)
        self._turn()

    def _turn(self) -> None:
        self.canvas.turn_directions(self._session.state.diffusion.theta)

    def _show_display(self, name: str) -> None:
        if name == "wireframe":
            self._show_look()
        elif name in ("colour_bar", "kernel_colours"):
            self._show_field()
        elif name == "samples":
            self._smooth()
        elif name == "arrows":
            self._show_directions()
        elif name == "up_axis":
            self._show_shape(fresh=True)

    def _smooth(self) -> None:
        self.canvas.samples = int(self._display["samples"])
        self.canvas.draw_moving()

    def _show_axes(self) -> None:
        self.triad.show_axes(self.canvas.camera_model.axes)

    def show_theme(self, theme: Theme) -> None:
        """Colours of background and labels."""
        self._theme = theme
        self.canvas.show_theme(theme)
        for overlay in self._overlays:
            overlay.show_theme(theme)

    def leave_corner(self, size: QSize) -> None:
        """Keep the upper right corner free for buttons of this size, beside the name."""
        self._tools = size
        self._place_labels()

    def show_as_source(self, on: bool) -> None:
        """Mark the view of the active shape among several."""
        self.label.show_source(on)

    # -- what a person does -------------------------------------------------------------------------------------------

    def _clicked(self, vertex: int, modifiers: Qt.KeyboardModifier) -> None:
        if vertex < 0 or self.key is None:
            return
        if modifiers & Qt.KeyboardModifier.AltModifier:
            self._session.pick_mirror(vertex, shape=self.key)
        else:
            self._session.pick(vertex, add=bool(modifiers & Qt.KeyboardModifier.ShiftModifier), shape=self.key)

    def _hover(self, vertex: int) -> None:
        if vertex < 0:
            self.hovered.emit(IDLE_TEXT)
            return
        reading = "" if self.field is None else self.field.reading(vertex)
        name = f"{self._shown.name}: " if self._shown is not None and len(self._session.state.shown) > 1 else ""
        self.hovered.emit(f"{name}Vertex {vertex}   {reading}".rstrip())

    @property
    def _room_right(self) -> int:
        return 0 if self._tools.isEmpty() else self._tools.width() + GRID

    # -- layout and pictures ------------------------------------------------------------------------------------------

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.frame.setFixedSize(self.size())
        self._place_labels()

    def _place_labels(self) -> None:
        width, height, gap = self.width(), self.height(), 2 * GRID
        small = width < _SMALL.width() or height < _SMALL.height()
        self.colour_bar.show_small(small, max(10 * GRID, width - 2 * gap))
        self.label.show_small(small)
        self.label.setFixedWidth(max(40, min(400, width - 2 * gap - self._room_right)))
        self.triad.setVisible(not small)
        self.label.move(gap, gap)
        self._leave_room()
        self.triad.move(gap - 4, height - self.triad.height() - gap + 4)
        left = (width - self.colour_bar.width()) // 2 if small else width - self.colour_bar.width() - gap
        self.colour_bar.move(left, height - self.colour_bar.height() - (GRID // 2 if small else gap))
        self.hint.fit(width - 2 * gap if small else int(0.3 * width), small=small)  # beside what stands in the middle
        edge = GRID // 2 if small else gap
        self.hint.move(width - self.hint.width() - gap, height - self.hint.height() - edge)

    def _leave_room(self) -> None:
        """Keep the fitted shape clear of name and buttons, and of the bar below it; of small views, all do alike."""
        gap, small = 2 * GRID, self.colour_bar.is_small
        name = QRect(self.label.pos(), QSize(self.width() if small else self.label.reach, self.label.height()))
        tools = QRect(self.width() - gap - self._room_right, gap, self._room_right, max(self._tools.height(), 0))
        self.canvas.leave_room((name, tools), self.colour_bar.height() if small else 0)

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
