"""The open shapes: which is the source, which are shown, in what order and how."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QSignalBlocker, Qt
from PySide6.QtGui import QAction, QFont
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QMenu, QWidget

from add_core.geometry import TriangleMesh

from ..models.session import Session
from .theme import GRID

_KEY = Qt.ItemDataRole.UserRole
_MOST_ROWS = 5
HELP = "Click makes a shape the source; drag puts it elsewhere; the box shows or hides it; right click for more."
SIZES = {"Small points": 0.5, "Usual points": 1.0, "Large points": 2.0}


class ShapeList(QListWidget):
    """A line for each open shape. Shows the session and changes it only when a person acts."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._showing = session, False
        self.setAccessibleName("Open shapes")
        self.setDragDropMode(QListWidget.DragDropMode.InternalMove)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.customContextMenuRequested.connect(lambda place: self._show_menu(place))
        self.currentItemChanged.connect(self._chosen)
        self.itemChanged.connect(self._checked)
        self.model().rowsMoved.connect(self._moved)
        for signal in (session.shapes_changed, session.active_changed, session.looks_changed):
            signal.connect(self._show)
        self._show()

    # -- model to view ------------------------------------------------------------------------------------------------

    def _show(self) -> None:
        self._showing = True  # the list's own model tells of rows too, and must, or nothing is painted
        state = self._session.state
        with QSignalBlocker(self):
            self._fit([shape.key for shape in state.shapes])
            for row, shape in enumerate(state.shapes):
                item, active = self.item(row), shape.key == state.active_key
                item.setText(shape.name)
                item.setFont(_font(self, bold=active and len(state.shapes) > 1))
                item.setToolTip(HELP)
                if len(state.shapes) > 1:
                    shown = active or state.look(shape.key).visible
                    item.setCheckState(Qt.CheckState.Checked if shown else Qt.CheckState.Unchecked)
                if active:
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

    def _chosen(self, item: QListWidgetItem | None) -> None:
        if item is not None:
            self._session.show_shape(item.data(_KEY))

    def _checked(self, item: QListWidgetItem) -> None:
        self._session.set_look(item.data(_KEY), visible=item.checkState() == Qt.CheckState.Checked)
        self._show()  # the source cannot be hidden

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
        """What a right click on a shape offers."""
        session, menu = self._session, QMenu(self)
        shape, look = session.state.shape(key), session.state.look(key)
        assert shape is not None
        menu.addAction("Make it the source").triggered.connect(lambda: session.show_shape(key))
        if isinstance(shape.shape, TriangleMesh):
            wires = QAction("Wireframe", menu, checkable=True, checked=look.wireframe)
            wires.toggled.connect(lambda on: session.set_look(key, wireframe=on))
            menu.addAction(wires)
        else:
            for words, size in SIZES.items():
                action = QAction(words, menu, checkable=True, checked=look.point_size == size)
                action.triggered.connect(lambda _on, size=size: session.set_look(key, point_size=size))
                menu.addAction(action)
        menu.addSeparator()
        menu.addAction(f"Close {shape.name}").triggered.connect(lambda: session.close_shape(key))
        menu.aboutToHide.connect(menu.deleteLater)
        return menu


def _font(widget: QWidget, *, bold: bool) -> QFont:
    font = QFont(widget.font())
    font.setBold(bold)
    return font
