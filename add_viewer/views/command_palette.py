"""Ctrl+Shift+P: do anything by typing a few letters of its name."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRect, QSize, Qt, QTimer
from PySide6.QtGui import QFont, QPainter
from PySide6.QtWidgets import QListWidgetItem, QMainWindow, QStyleOptionViewItem

from ..models.commands import Command, find, remembered
from .action_tour import tour
from .search_popup import SearchPopup, SearchRows
from .settings import Settings
from .theme import GRID

Source = Callable[[], Iterable[Command]]
WIDTH, ROWS, ROW = 72 * GRID, 11, int(4.5 * GRID)


class CommandPalette(SearchPopup):
    """Offers every action of the menus, and what `sources` offer."""

    def __init__(self, window: QMainWindow, settings: Settings) -> None:
        super().__init__(
            window,
            _Row(),
            name="palette",
            prompt="What would you like to do?",
            title="Command palette",
            nothing="Nothing is called that: try the name of a shape, or a field such as “AHKS”.",
            page=ROWS - 1,
        )
        self._main, self._settings = window, settings
        self.sources: list[Source] = [lambda: menu_commands(window)]
        self._commands: list[Command] = []

    def open(self) -> None:
        """Show the palette with everything that can be done now."""
        self._commands = [command for source in self.sources for command in source()]
        self.begin()

    def found(self, query: str) -> list[QListWidgetItem]:
        found = find(self._commands, query, self._settings.recent_commands)
        return [self.line(command.title, command.help, command) for command in found]

    def fit(self) -> None:
        rows = min(self.list.count(), ROWS)
        self.list.setFixedHeight(rows * ROW)
        width = min(WIDTH, self._main.width() - 4 * GRID)
        self.setFixedWidth(width)
        self.adjustSize()
        self.move((self._main.width() - width) // 2, self._main.menuBar().height() + 2 * GRID)

    def choose(self, entry: Command) -> None:
        if not entry.enabled:
            return
        self._settings.recent_commands = remembered(entry.name, self._settings.recent_commands)
        self.leave()
        QTimer.singleShot(0, entry.do)  # it may open a dialog, which must not wait inside this event


def menu_commands(window: QMainWindow) -> list[Command]:
    """Every action of the menus."""
    return [
        Command(
            name=f"{stop.menu}: {stop.name}",
            title=stop.title,
            section=stop.menu,
            do=stop.action.trigger,
            key=", ".join(stop.keys),
            help=stop.action.toolTip().partition("\n")[2],
            enabled=stop.action.isEnabled(),
            checked=stop.action.isChecked() if stop.action.isCheckable() else None,
        )
        for stop in tour(window.menuBar())
    ]


class _Row(SearchRows):
    """Title on the left, where it is found behind it, its key on the right."""

    def sizeHint(self, _option: QStyleOptionViewItem, _index: QModelIndex | QPersistentModelIndex) -> QSize:
        return QSize(WIDTH // 2, ROW)

    def write(self, painter: QPainter, room: QRect, title: str, entry: Command, chosen: bool) -> None:
        words = self.theme.colour("on_accent" if chosen else "text" if entry.enabled else "muted")
        quiet = self.theme.colour("on_accent" if chosen else "muted")
        left = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        metrics = painter.fontMetrics()
        shown = ("✓ " if entry.checked else "") + title
        shown = metrics.elidedText(shown, Qt.TextElideMode.ElideRight, room.width() - 26 * GRID)
        painter.setPen(words)
        painter.drawText(room, left, shown)
        font = QFont(painter.font())
        font.setPointSizeF(0.9 * font.pointSizeF())
        painter.setFont(font)
        painter.setPen(quiet)
        section = entry.section if entry.enabled else f"{entry.section} · not now"
        painter.drawText(room.adjusted(metrics.horizontalAdvance(shown) + 2 * GRID, 0, 0, 0), left, section)
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, entry.key)
