"""Ctrl+Shift+P: do anything by typing a few letters of its name."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from PySide6.QtCore import QEvent, QModelIndex, QObject, QPersistentModelIndex, QRect, QSize, Qt, QTimer
from PySide6.QtGui import QColor, QFont, QKeyEvent, QPainter
from PySide6.QtWidgets import (
    QFrame,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QMainWindow,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QVBoxLayout,
)

from ..models.commands import Command, find, remembered
from .action_tour import tour
from .settings import Settings
from .theme import GRID, LIGHT, Theme

Source = Callable[[], Iterable[Command]]
WIDTH, ROWS, ROW = 72 * GRID, 11, int(4.5 * GRID)
_COMMAND = Qt.ItemDataRole.UserRole
_MOVES = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1, Qt.Key.Key_PageDown: ROWS - 1, Qt.Key.Key_PageUp: 1 - ROWS}


class CommandPalette(QFrame):
    """A field to type into over the window, and what it finds: every action of the menus, and what `sources` offer."""

    def __init__(self, window: QMainWindow, settings: Settings) -> None:
        super().__init__(window)
        self.setObjectName("palette")
        self._window, self._settings = window, settings
        self.sources: list[Source] = [lambda: menu_commands(window)]
        self._commands: list[Command] = []
        self.field, self.list, self._nothing = QLineEdit(), QListWidget(), QLabel("Nothing is called that.")
        self.delegate = _Row(self.list)
        self._lay_out()
        self.field.installEventFilter(self)
        self.field.textChanged.connect(self._show_found)
        self.list.itemClicked.connect(self._choose)
        self.hide()

    def _lay_out(self) -> None:
        self.field.setPlaceholderText("What would you like to do?")
        self.field.setAccessibleName("Command palette")
        self.field.setMinimumHeight(4 * GRID)
        self.list.setItemDelegate(self.delegate)
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setMouseTracking(True)
        self._nothing.setProperty("role", "muted")
        self._nothing.setContentsMargins(GRID, GRID, GRID, GRID)
        column = QVBoxLayout(self)
        column.setContentsMargins(GRID, GRID, GRID, GRID)
        column.setSpacing(GRID)
        for widget in (self.field, self.list, self._nothing):
            column.addWidget(widget)

    # -- showing ------------------------------------------------------------------------------------------------------

    def open(self) -> None:
        """Show the palette with everything that can be done now."""
        self._commands = [command for source in self.sources for command in source()]
        self.field.clear()
        self._show_found("")
        self.show()
        self.raise_()
        self.field.setFocus(Qt.FocusReason.ShortcutFocusReason)

    def close_quietly(self) -> None:
        """Hide, and give the keyboard back to the window."""
        self.hide()
        self._window.setFocus()

    def _show_found(self, query: str) -> None:
        found = find(self._commands, query, self._settings.recent_commands)
        self.list.clear()
        for command in found:
            item = QListWidgetItem(command.title)
            item.setData(_COMMAND, command)
            item.setToolTip(command.help)
            self.list.addItem(item)
        self.list.setCurrentRow(0)
        self._nothing.setVisible(not found)
        self.list.setVisible(bool(found))
        self._place()

    def _place(self) -> None:
        rows = min(self.list.count(), ROWS)
        self.list.setFixedHeight(rows * ROW)
        width = min(WIDTH, self._window.width() - 4 * GRID)
        self.setFixedWidth(width)
        self.adjustSize()
        self.move((self._window.width() - width) // 2, self._window.menuBar().height() + 2 * GRID)

    def show_theme(self, theme: Theme) -> None:
        """A panel that stands out from the window by its edge."""
        self.delegate.theme = theme
        self.setStyleSheet(
            f"#palette {{ background: {theme.panel}; border: 1px solid {theme.muted}; border-radius: 8px; }}"
            f" QListWidget {{ background: {theme.panel}; }}"
        )

    # -- what a person does -------------------------------------------------------------------------------------------

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            event.accept()  # Esc, arrows and letters belong to the palette while it is open
            return True
        if event.type() == QEvent.Type.FocusOut and not self.list.underMouse():
            self.hide()
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            return self._pressed(event.key())
        return super().eventFilter(watched, event)

    def _pressed(self, key: int) -> bool:
        if key in _MOVES:
            last = self.list.count() - 1
            self.list.setCurrentRow(min(max(self.list.currentRow() + _MOVES[Qt.Key(key)], 0), last))
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._choose(self.list.currentItem())
        elif key == Qt.Key.Key_Escape:
            self.close_quietly()
        else:
            return False
        return True

    def _choose(self, item: QListWidgetItem | None) -> None:
        command = None if item is None else item.data(_COMMAND)
        if not isinstance(command, Command) or not command.enabled:
            return
        self._settings.recent_commands = remembered(command.name, self._settings.recent_commands)
        self.close_quietly()
        QTimer.singleShot(0, command.do)  # it may open a dialog, which must not wait inside this event


def menu_commands(window: QMainWindow) -> list[Command]:
    """Every action of the menus."""
    return [
        Command(
            name=f"{stop.menu}: {stop.title}",
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


class _Row(QStyledItemDelegate):
    """Title on the left, where it is found behind it, its key on the right."""

    theme: Theme = LIGHT

    def sizeHint(self, _option: QStyleOptionViewItem, _index: QModelIndex | QPersistentModelIndex) -> QSize:
        return QSize(WIDTH // 2, ROW)

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        command: Command = index.data(_COMMAND)
        rect: QRect = option.rect
        state: QStyle.StateFlag = option.state
        chosen = bool(state & QStyle.StateFlag.State_Selected)
        painter.save()
        if chosen:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(self.theme.colour("accent"))
            painter.drawRoundedRect(rect.adjusted(0, 1, 0, -1), 4, 4)
        words = self.theme.colour("on_accent" if chosen else "text" if command.enabled else "muted")
        quiet = self.theme.colour("on_accent" if chosen else "muted")
        self._write(painter, rect.adjusted(GRID, 0, -GRID, 0), command, words, quiet)
        painter.restore()

    def _write(self, painter: QPainter, rect: QRect, command: Command, words: QColor, quiet: QColor) -> None:
        left = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        painter.setPen(words)
        font = QFont(painter.font())
        mark = "✓ " if command.checked else ""
        title = painter.fontMetrics().elidedText(
            mark + command.title, Qt.TextElideMode.ElideRight, rect.width() - 26 * GRID
        )
        painter.drawText(rect, left, title)
        behind = rect.adjusted(painter.fontMetrics().horizontalAdvance(title) + 2 * GRID, 0, 0, 0)
        font.setPointSizeF(0.9 * font.pointSizeF())
        painter.setFont(font)
        painter.setPen(quiet)
        section = command.section if command.enabled else f"{command.section} · not now"
        painter.drawText(behind, left, section)
        painter.drawText(rect, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, command.key)
