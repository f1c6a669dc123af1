"""The centre of the window: a view for each shown shape, twice in a split view, with linked cameras."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QAction, QImage, QPainter, QResizeEvent
from PySide6.QtWidgets import QGridLayout, QWidget

from ..models.arrangement import columns
from ..models.display import Display
from ..models.results import Results
from ..models.session import Session
from .shape_view import ShapeView
from .theme import LIGHT, Theme
from .tool_strip import ToolStrip

_NAME = 180
"""Width that the name of a view should have."""
_GAP = 1
_NARROWEST = 200
"""Width of a view below which two rows are better than one."""


class SceneView(QWidget):
    """Lays out the views of the session. A view that is not needed is kept for the next shape: graphics contexts are
    dear, and drivers do not like them to come and go.

    camera_moved : in whichever view. hovered : text for the status line.
    menu_requested : global place, key and vertex (-1 beside the shape).
    """

    camera_moved = Signal()
    hovered = Signal(str)
    menu_requested = Signal(QPoint, str, int)

    def __init__(self, session: Session, results: Results, display: Display, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._results, self._display = session, results, display
        self._theme = LIGHT
        self._pool: list[ShapeView] = []
        self._used = 1
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setSpacing(_GAP)
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self._tools = ToolStrip(self)
        self._grid.addWidget(self._view(0), 0, 0)
        for signal in (session.shapes_changed, session.active_changed, session.looks_changed, session.field_changed):
            signal.connect(self._lay_out)
        session.arrangement_changed.connect(self._arranged)

    @property
    def views(self) -> list[ShapeView]:
        """The views in use, row by row."""
        return self._pool[: self._used]

    @property
    def active_view(self) -> ShapeView:
        """The view of the active shape, in the first panel."""
        key = self._session.state.active_key
        return next((view for view in self.views if view.key == key and view.panel == 0), self._pool[0])

    # -- layout -------------------------------------------------------------------------------------------------------

    def _lay_out(self) -> None:
        state = self._session.state
        panels = range(len(state.choices))
        keys: list[str | None] = [shape.key for shape in state.shown] or [None]
        wanted = [(panel, key) for panel in panels for key in keys]
        self._bind(wanted)
        wide = self._columns(len(wanted))
        for view in self._pool:
            self._grid.removeWidget(view)
        for place, view in enumerate(self.views):
            self._grid.addWidget(view, place // wide, place % wide)
            view.show()
            view.show_as_source(len(state.shown) > 1 and view.key == state.active_key)
        for line in range(max(self._grid.columnCount(), self._grid.rowCount())):
            self._grid.setColumnStretch(line, int(line < wide))
            self._grid.setRowStretch(line, int(line < -(-len(wanted) // wide)))
        self._place_tools()

    def _bind(self, wanted: list[tuple[int, str | None]]) -> None:
        """Give each wanted panel and shape a view, the one that has it already if there is one."""
        before = {(view.panel, view.key): view for view in self._pool}
        kept = {place: before[place] for place in wanted if place in before}
        free = [view for view in self._pool if view not in kept.values()]
        chosen = [kept.get(place) or (free.pop(0) if free else self._view(len(self._pool))) for place in wanted]
        self._pool, self._used = [*chosen, *free], len(chosen)
        for view in free:
            view.bind(None, 0)
            self._grid.removeWidget(view)
            view.hide()
        old = [view for view in chosen if view.shape is not None and view in kept.values()]
        for view, (panel, key) in zip(chosen, wanted, strict=True):
            fresh = view.bind(key, panel)
            if fresh and old and self._session.state.arrangement.linked:
                view.canvas.face(old[0].canvas)

    def _columns(self, count: int) -> int:
        state, aspect = self._session.state, self.width() / max(self.height(), 1)
        if state.compare is None:
            return columns(count, state.arrangement.layout, aspect)
        shapes = count // 2
        wide = columns(count, "grid", aspect, step=shapes)
        return shapes if shapes > 1 and self.width() < _NARROWEST * wide else wide

    def _arranged(self) -> None:
        self._lay_out()
        if self._session.state.arrangement.linked:
            for view in self.views:
                if view is not self.active_view and view.shape is not None:
                    view.canvas.face(self.active_view.canvas)

    def _view(self, number: int) -> ShapeView:
        """A new view, the `number`th of the pool."""
        view = ShapeView(self._session, self._results, self._display, self)
        view.show_theme(self._theme)
        view.hovered.connect(self.hovered)
        view.menu_requested.connect(self.menu_requested)
        view.canvas.camera_moved.connect(self.camera_moved)
        view.canvas.steered.connect(lambda move, arguments: self._follow(view, move, arguments))
        self._pool.insert(number, view)
        return view

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._place_tools()
        if self._used > 1 and self._grid.itemAtPosition(0, self._columns(self._used) - 1) is None:
            self._lay_out()

    # -- cameras ------------------------------------------------------------------------------------------------------

    def _follow(self, leader: ShapeView, move: str, arguments: tuple[float, ...]) -> None:
        if self._session.state.arrangement.linked:
            for view in self.views:
                if view is not leader and view.shape is not None:
                    view.canvas.steer(move, arguments)

    def look(self, side: str) -> None:
        """Look at the shapes from "front", "back", "left", "right" or "top"; only at the active one if not linked."""
        for view in self._steered():
            view.canvas.look(side)

    def fit(self) -> None:
        """Bring whole shapes into view, from the same side."""
        for view in self._steered():
            view.canvas.fit()

    def _steered(self) -> list[ShapeView]:
        return self.views if self._session.state.arrangement.linked else [self.active_view]

    # -- looks --------------------------------------------------------------------------------------------------------

    def show_theme(self, theme: Theme) -> None:
        """Colours of backgrounds, labels and the lines between views."""
        self._theme = theme
        self.setStyleSheet(f"SceneView {{ background: {theme.line}; }}")
        for view in self._pool:
            view.show_theme(theme)

    def show_tools(self, actions: list[QAction]) -> None:
        """Offer `actions` as icons in the upper right corner."""
        self._tools.show_actions(actions)
        self._place_tools()

    def _place_tools(self) -> None:
        """In a row beside the name of the view in that corner, or in two columns where the name needs the room."""
        corner = self.views[min(self._columns(self._used), self._used) - 1]
        narrow = self._used > 1 and self.width() / self._columns(self._used) < self._tools.extent + _NAME
        self._tools.place(narrow=narrow)
        for view in self.views:
            view.leave_corner(self._tools.size() if view is corner else QSize())

    def picture(self, scale: float, *, transparent: bool = False, labels: bool = True) -> QImage:
        """All views as they stand, at `scale` times their size."""
        if self._used == 1:
            return self.views[0].picture(scale, transparent=transparent, labels=labels)
        size = self.size() * scale
        image = QImage(size, QImage.Format.Format_ARGB32)
        image.fill(Qt.GlobalColor.transparent if transparent else self._theme.colour("line"))
        painter = QPainter(image)
        for view in self.views:
            place = QRect(view.pos() * scale, view.size() * scale)
            painter.drawImage(place, view.picture(scale, transparent=transparent, labels=labels))
        painter.end()
        return image

    def close_views(self) -> None:
        """Let VTK go of its graphics contexts while they still exist."""
        for view in self._pool:
            view.canvas.close()
