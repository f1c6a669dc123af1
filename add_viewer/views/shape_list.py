"""The open shapes: which is the source, which are shown, in what order and how."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtCore import QPoint, QSignalBlocker, Qt
from PySide6.QtGui import QAction, QFocusEvent, QFont, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QMenu, QToolTip, QWidget

from add_core.geometry import TriangleMesh

from ..models.session import Session
from ..models.shapes import OpenShape
from .menu_entry import add_entry
from .theme import GRID

_KEY = Qt.ItemDataRole.UserRole
_MOST_ROWS = 5
_PLAIN, _ALT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.AltModifier
_KEYS = {
    (Qt.Key.Key_Return, _PLAIN): "_make_source",
    (Qt.Key.Key_Enter, _PLAIN): "_make_source",
    (Qt.Key.Key_Up, _ALT): "_raise",
    (Qt.Key.Key_Down, _ALT): "_lower",
    (Qt.Key.Key_Delete, _PLAIN): "_close",
    (Qt.Key.Key_Menu, _PLAIN): "_open_menu",
    (Qt.Key.Key_F10, Qt.KeyboardModifier.ShiftModifier): "_open_menu",
}
"""Space ticks the box of a line in every list."""
HELP = (
    "Click makes a shape the source; drag puts it elsewhere; the box shows or hides it; right click for more.\n"
    "Keys: Enter makes it the source, Space shows or hides it, Alt+↑ and Alt+↓ move it, Delete closes it."
)
ALONE = "Open a second shape to compare, to hide one of them, or to carry colours from this one."
ALWAYS_SHOWN = "The source is always shown: make another shape the source first."
SIZES = {"Sma&ll points": 0.5, "Usual &points": 1.0, "Lar&ge points": 2.0}


class ShapeList(QListWidget):
    """A line for each open shape. Shows the session and changes it only when a person acts.

    Arrow keys go from line to line and change nothing yet; without the focus the line of the source is marked.
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._showing, self._ticked = session, False, False
        self._active: str | None = None
        self._cursor: str | None = None
        self.setAccessibleName("Open shapes")
        self.setDragDropMode(QListWidget.DragDropMode.InternalMove)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.customContextMenuRequested.connect(lambda place: self._show_menu(place))
        self.currentItemChanged.connect(self._go_to)
        self.itemClicked.connect(self._clicked)
        self.itemChanged.connect(self._checked)
        self.model().rowsMoved.connect(self._moved)
        for signal in (session.shapes_changed, session.active_changed, session.looks_changed):
            signal.connect(self._show)
        self._show()

    # -- model to view ------------------------------------------------------------------------------------------------

    def _show(self) -> None:
        self._showing = True  # the list's own model tells of rows too, and must, or nothing is painted
        state = self._session.state
        if self._active != state.active_key or state.shape(self._cursor or "") is None or not self.hasFocus():
            self._cursor = state.active_key
        self._active = state.active_key
        with QSignalBlocker(self):
            self._fit([shape.key for shape in state.shapes])
            for row, shape in enumerate(state.shapes):
                item, active = self.item(row), shape.key == state.active_key
                item.setText(shape.name)
                item.setFont(_font(self, bold=active and len(state.shapes) > 1))
                item.setToolTip(HELP if len(state.shapes) > 1 else ALONE)
                if len(state.shapes) > 1:
                    shown = active or state.look(shape.key).visible
                    item.setCheckState(Qt.CheckState.Checked if shown else Qt.CheckState.Unchecked)
                if shape.key == self._cursor:
                    self.setCurrentItem(item)
        rows = min(max(len(state.shapes), 1), _MOST_ROWS)
        self.setFixedHeight(rows * max(self.sizeHintForRow(0), 2 * GRID) + 4)
        self._showing = False

    def _fit(self, keys: list[str]) -> None:
        if keys == [self.item(row).data(_KEY) for row in range(self.count())] and len(keys) > 1:
            return
        self.clear()
        for key in keys:
            item = QListWidgetItem()
            item.setData(_KEY, key)
            item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsDropEnabled | Qt.ItemFlag.ItemIsUserCheckable)
            self.addItem(item)

    # -- what a person does -------------------------------------------------------------------------------------------

    def _go_to(self, item: QListWidgetItem | None) -> None:
        self._cursor = None if item is None else item.data(_KEY)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._ticked = False
        super().mousePressEvent(event)

    def _clicked(self, item: QListWidgetItem) -> None:
        if not self._ticked:  # a click on the box shows or hides, and leaves the source what it is
            self._session.show_shape(item.data(_KEY))

    def _checked(self, item: QListWidgetItem) -> None:
        self._ticked = True
        self._set_visible(item.data(_KEY), item.checkState() == Qt.CheckState.Checked)

    def _set_visible(self, key: str, on: bool) -> None:
        if key != self._session.state.active_key:
            self._session.set_look(key, visible=on)
            return
        self._show()  # with its tick
        if self.isVisible():
            below = self.visualItemRect(self.currentItem()).bottomLeft()
            QToolTip.showText(self.viewport().mapToGlobal(below), ALWAYS_SHOWN, self)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        item = self.currentItem()
        key = (event.key(), event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier)
        if item is None or key not in _KEYS:
            super().keyPressEvent(event)
        elif not event.isAutoRepeat():
            getattr(self, _KEYS[key])(item.data(_KEY))

    def _make_source(self, key: str) -> None:
        self._session.show_shape(key)

    def _raise(self, key: str) -> None:
        self._session.move_shape(key, max(self._row(key) - 1, 0))

    def _lower(self, key: str) -> None:
        self._session.move_shape(key, self._row(key) + 1)

    def _close(self, key: str) -> None:
        row = self._row(key)
        neighbour = self.item(row + 1) or self.item(row - 1)
        self._cursor = None if neighbour is None else neighbour.data(_KEY)
        self._session.close_shape(key)

    def _open_menu(self, key: str) -> None:
        place = self.visualItemRect(self.item(self._row(key))).bottomLeft()
        self.menu(key).popup(self.viewport().mapToGlobal(place))

    def _row(self, key: str) -> int:
        return [shape.key for shape in self._session.state.shapes].index(key)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        if event.reason() != Qt.FocusReason.PopupFocusReason:  # its own menu
            self._show()

    def _moved(self) -> None:
        before = [shape.key for shape in self._session.state.shapes]
        after = [self.item(row).data(_KEY) for row in range(self.count())]
        if self._showing:
            return
        moved = next((key for key in before if [k for k in before if k != key] == [k for k in after if k != key]), None)
        if moved is not None and before != after:
            self._session.move_shape(moved, after.index(moved))

    def _show_menu(self, place: QPoint) -> None:
        item = self.itemAt(place)
        if item is not None:
            self.menu(item.data(_KEY)).popup(self.viewport().mapToGlobal(place))

    def menu(self, key: str) -> QMenu:
        """What can be done with a shape, with the keys that do it."""
        session, menu = self._session, QMenu(self)
        state, row = session.state, self._row(key)
        is_source, is_shown = key == state.active_key, state.look(key).visible
        shape = state.shapes[row]
        offers = (
            ("&Make it the source\tEnter", not is_source, lambda: session.show_shape(key)),
            (
                "&Hide\tSpace" if is_source or is_shown else "&Show\tSpace",
                not is_source,
                lambda: session.set_look(key, visible=not is_shown),
            ),
            ("Move &up\tAlt+Up", row > 0, lambda: self._raise(key)),
            ("Move &down\tAlt+Down", row < len(state.shapes) - 1, lambda: self._lower(key)),
        )
        for words, can, do in offers:
            action = add_entry(menu, words)
            action.setEnabled(can)
            action.triggered.connect(do)
        menu.addSeparator()
        for action in self._look_actions(shape, menu):
            menu.addAction(action)
        menu.addSeparator()
        closing = add_entry(menu, f"&Close {shape.name.replace('&', '&&')}\tDel")
        closing.triggered.connect(lambda: session.close_shape(key))
        menu.aboutToHide.connect(menu.deleteLater)
        return menu

    def _look_actions(self, shape: OpenShape, menu: QMenu) -> Iterator[QAction]:
        """Edges of a mesh, or sizes of a cloud's points."""
        key, look = shape.key, self._session.state.look(shape.key)
        if isinstance(shape.shape, TriangleMesh):
            wires = QAction("&Wireframe", menu, checkable=True, checked=look.wireframe)
            wires.toggled.connect(lambda on: self._session.set_look(key, wireframe=on))
            yield wires
            return
        for words, size in SIZES.items():
            action = QAction(words, menu, checkable=True, checked=look.point_size == size)
            action.triggered.connect(lambda _on, size=size: self._session.set_look(key, point_size=size))
            yield action


def _font(widget: QWidget, *, bold: bool) -> QFont:
    font = QFont(widget.font())
    font.setBold(bold)
    return font
