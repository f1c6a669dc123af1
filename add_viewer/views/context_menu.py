"""What a right click offers."""

from __future__ import annotations

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QApplication, QMenu, QWidget

from ..models.session import Session

_ALWAYS = ("fit", "front", "arrows", "wireframe", "clear", "screenshot")


def context_menu(parent: QWidget, session: Session, actions: dict[str, QAction], vertex: int) -> QMenu:
    """What makes sense at `vertex` of the shown shape, or beside it (-1)."""
    menu = QMenu(parent)
    if vertex >= 0 and session.state.active is not None:
        _offer_vertex(menu, session, vertex)
        menu.addSeparator()
    for name in _ALWAYS:
        menu.addAction(actions[name])
    menu.aboutToHide.connect(menu.deleteLater)
    return menu


def _offer_vertex(menu: QMenu, session: Session, vertex: int) -> None:
    shape = session.state.active
    menu.addAction(f"Drop heat on vertex {vertex}").triggered.connect(lambda: session.pick(vertex))
    if any(pick.vertex == vertex for pick in session.state.active_picks):
        menu.addAction("Remove this point").triggered.connect(lambda: session.unpick(vertex))
    else:
        menu.addAction("Add this point").triggered.connect(lambda: session.pick(vertex, add=True))
    if shape is not None and shape.mirror(vertex) is not None:
        menu.addAction("Add its mirror point").triggered.connect(lambda: session.pick_mirror(vertex))
    copy = menu.addAction(f"Copy the number {vertex}")
    copy.triggered.connect(lambda: QApplication.clipboard().setText(str(vertex)))
