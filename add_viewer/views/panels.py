"""The panels around the view: they float, close, and come back from the View menu."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow, QMenu, QWidget

from .dock_title import DockTitle
from .focus_keys import FocusKeys
from .reading_order import go
from .theme import Theme


class Panel(QDockWidget):
    """A dock that Tab goes through as one reads it while it is a window of its own."""

    def focusNextPrevChild(self, forward: bool) -> bool:
        return go(self, forward=forward) if self.isFloating() else super().focusNextPrevChild(forward)


class Panels:
    """Docks of a window. Those that belong to a shape hide together where none is shown."""

    def __init__(self, window: QMainWindow, menu: QMenu) -> None:
        self._window, self._menu = window, menu
        self._keys = FocusKeys(window)
        window.installEventFilter(self._keys)
        self._docks: list[QDockWidget] = []
        self._titles: list[DockTitle] = []
        self._hidden: list[QDockWidget] | None = None
        self._places: list[tuple[QDockWidget, Qt.DockWidgetArea | QDockWidget]] = []

    def add(self, title: str, widget: QWidget, area: Qt.DockWidgetArea) -> QDockWidget:
        """A new panel on one side of the window."""
        dock = self._made(title, widget)
        self._window.addDockWidget(area, dock)
        self._docks.append(dock)
        self._places.append((dock, area))
        return dock

    def add_beside(self, other: QDockWidget, title: str, widget: QWidget) -> QDockWidget:
        """A new panel that shares a place with another, closed until it is wanted; it needs no shape."""
        dock = self._made(title, widget)
        if not self._window.restoreDockWidget(dock):
            self._window.addDockWidget(self._window.dockWidgetArea(other), dock)
            self._window.tabifyDockWidget(other, dock)
            dock.hide()
        self._places.append((dock, other))
        return dock

    def reset(self) -> None:
        """Every panel where it was at the first start."""
        for dock, place in self._places:
            dock.setFloating(False)
            if isinstance(place, QDockWidget):
                self._window.tabifyDockWidget(place, dock)
                dock.hide()
            else:
                self._window.addDockWidget(place, dock)
                dock.setVisible(self._hidden is None)
        if self._hidden is not None:
            self._hidden = list(self._docks)

    def _made(self, title: str, widget: QWidget) -> QDockWidget:
        dock = Panel(title, self._window)
        dock.setObjectName(title)
        dock.setWidget(widget)
        dock.installEventFilter(self._keys)  # a floating one is a window of its own
        title_bar = DockTitle(dock)
        dock.setTitleBarWidget(title_bar)
        self._menu.addAction(dock.toggleViewAction())
        self._titles.append(title_bar)
        return dock

    def show(self, on: bool) -> None:
        """Hide all panels, or bring those back that were open."""
        if on and self._hidden is not None:
            for dock in self._hidden:
                dock.show()
            self._hidden = None
        elif not on and self._hidden is None:
            self._hidden = [dock for dock in self._docks if not dock.isHidden()]
            for dock in self._docks:
                dock.hide()

    def show_theme(self, theme: Theme) -> None:
        """Buttons in the theme's colours."""
        for title in self._titles:
            title.show_theme(theme)
