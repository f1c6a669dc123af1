"""What a right click offers."""

from __future__ import annotations

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QApplication, QMenu, QWidget

from ..models.session import Session
from .menu_entry import add_entry

_ALWAYS = ("fit", "front", "arrows", "wireframe", "clear", "screenshot")


def context_menu(parent: QWidget, session: Session, actions: dict[str, QAction], key: str, vertex: int) -> QMenu:
    """What makes sense at `vertex` of the shape `key`, or beside it (-1)."""
    menu = QMenu(parent)
    if vertex >= 0 and session.state.shape(key) is not None:
        _offer_vertex(menu, session, key, vertex)
        menu.addSeparator()
    for name in _ALWAYS:
        menu.addAction(actions[name])
    menu.aboutToHide.connect(menu.deleteLater)
    return menu


def _offer_vertex(menu: QMenu, session: Session, key: str, vertex: int) -> None:
    state, pick = session.state, session.pick
    shape = state.shape(key)
    add_entry(menu, f"Pick vertex {vertex}").triggered.connect(lambda: pick(vertex, shape=key))
    if any(each.vertex == vertex for each in state.picks_on(key)):
        add_entry(menu, "Remove this point").triggered.connect(lambda: session.unpick(vertex))
    else:
        add_entry(menu, "Add this point").triggered.connect(lambda: pick(vertex, add=True, shape=key))
    if shape is not None and shape.mirror(vertex) is not None:
        add_entry(menu, "Add its mirror point").triggered.connect(lambda: session.pick_mirror(vertex, shape=key))
    copy = add_entry(menu, f"Copy the number {vertex}")
    copy.triggered.connect(lambda: QApplication.clipboard().setText(str(vertex)))
