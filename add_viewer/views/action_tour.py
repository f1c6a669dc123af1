"""Every action of the window's menus, with where it stands: the palette and the shortcut sheet are made of these."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar


@dataclass(frozen=True, eq=False)
class Stop:
    """An action.

    menu : the words of the menu bar. title : its own, after those of a menu inside the menu. name : the same, without
    what it would be done to now.
    """

    menu: str
    title: str
    name: str
    action: QAction

    @property
    def keys(self) -> list[str]:
        """Its shortcuts as this platform writes them."""
        text = QKeySequence.SequenceFormat.NativeText
        return [sequence.toString(text) for sequence in self.action.shortcuts()]


def tour(bar: QMenuBar) -> Iterator[Stop]:
    """All actions below `bar`, in the order of the menus."""
    for top in bar.actions():
        menu = top.menu()
        if isinstance(menu, QMenu):
            yield from _inside(menu, plain(top.text()), "")


def plain(text: str) -> str:
    """An action's words without the mark of its mnemonic and the dots of a question to come."""
    return text.replace("&&", "\0").replace("&", "").replace("\0", "&").rstrip("…").strip()


def _inside(menu: QMenu, name: str, before: str) -> Iterator[Stop]:
    for action in menu.actions():
        inner = action.menu()
        words = plain(action.text())
        if isinstance(inner, QMenu):
            yield from _inside(inner, name, f"{before}{words}: ")
        elif not action.isSeparator() and words:
            always = plain(action.data() or action.text())
            yield Stop(name, f"{before}{words}", f"{before}{always}", action)
