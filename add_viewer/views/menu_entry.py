"""Entries of menus that are made anew each time."""

from __future__ import annotations

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu


def add_entry(menu: QMenu, words: str) -> QAction:
    """A new entry at the end of `menu`.

    Made here and not by Qt: for what Qt makes, PySide may answer with what was once known at the same place in memory,
    such as the surface of a window that is gone.
    """
    action = QAction(words, menu)
    menu.addAction(action)
    return action
