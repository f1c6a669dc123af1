"""A field to type into that lies over the window, and a list of what it finds."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QEvent, QModelIndex, QObject, QPersistentModelIndex, QRect, Qt
from PySide6.QtGui import QKeyEvent, QPainter
from PySide6.QtWidgets import (
    QFrame,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QVBoxLayout,
    QWidget,
)

from .theme import GRID, LIGHT, Theme

ENTRY = Qt.ItemDataRole.UserRole
"""What a line stands for; headings have none."""


class SearchPopup(QFrame):
    """Keys go to the field, arrows move in the list, Enter chooses, Esc leaves, and so does a click elsewhere.

    name : for the style sheet. prompt : shown while the field is empty. title : for screen readers. nothing : said when
    nothing is found. page : lines that Page Down moves by. Subclasses say what is found, and what choosing it does.
    """

    def __init__(
        self, window: QWidget, rows: SearchRows, *, name: str, prompt: str, title: str, nothing: str, page: int
    ) -> None:
        super().__init__(window)
        self.setObjectName(name)
        self._window, self.rows = window, rows
        self._moves = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1, Qt.Key.Key_PageDown: page, Qt.Key.Key_PageUp: -page}
        self.field, self.list, self._nothing = QLineEdit(), QListWidget(), QLabel(nothing)
        self.field.setPlaceholderText(prompt)
        self.field.setAccessibleName(title)
        self._lay_out()
        self.field.installEventFilter(self)
        self.field.textChanged.connect(self._show_found)
        self.list.itemClicked.connect(self._enter)
        self.hide()

    def _lay_out(self) -> None:
        self.field.setMinimumHeight(4 * GRID)
        self.rows.setParent(self.list)
        self.list.setItemDelegate(self.rows)
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setVerticalScrollMode(QListWidget.ScrollMode.ScrollPerPixel)
        self.list.setMouseTracking(True)
        self._nothing.setProperty("role", "muted")
        self._nothing.setContentsMargins(GRID, GRID, GRID, GRID)
        column = QVBoxLayout(self)
        column.setContentsMargins(GRID, GRID, GRID, GRID)
        column.setSpacing(GRID)
        for widget in (self.field, self.list, self._nothing):
            column.addWidget(widget)

    def found(self, query: str) -> list[QListWidgetItem]:
        """Lines for what is typed, made by `line` and `heading`."""
        raise NotImplementedError

    def choose(self, entry: Any) -> None:
        """Do what a line stands for."""
        raise NotImplementedError

    def fit(self) -> None:
        """Take the size and the place that what is found needs."""

    @staticmethod
    def line(title: str, help_text: str, entry: Any) -> QListWidgetItem:
        """A line that can be chosen."""
        item = QListWidgetItem(title)
        item.setData(ENTRY, entry)
        item.setToolTip(help_text)
        return item

    @staticmethod
    def heading(title: str) -> QListWidgetItem:
        """A line that cannot."""
        item = QListWidgetItem(title)
        item.setFlags(Qt.ItemFlag.NoItemFlags)
        return item

    def begin(self) -> None:
        """Show everything, ready to be typed into."""
        self.field.clear()
        self._show_found("")
        self.show()
        self.raise_()
        self.field.setFocus(Qt.FocusReason.ShortcutFocusReason)

    def leave(self) -> None:
        """Hide, and give the keyboard back to the window."""
        self.hide()
        self._window.setFocus()

    def show_theme(self, theme: Theme) -> None:
        """A panel that stands out from the window by its edge."""
        self.rows.theme = theme
        edge = f"border: 1px solid {theme.muted}; border-radius: 8px;"
        self.setStyleSheet(
            f"#{self.objectName()} {{ background: {theme.panel}; {edge} }} QListWidget {{ background: {theme.panel}; }}"
        )

    def _show_found(self, query: str) -> None:
        self.list.clear()
        for item in self.found(query):
            self.list.addItem(item)
        self._nothing.setVisible(not self.list.count())
        self.list.setVisible(bool(self.list.count()))
        self._move(0)
        self.fit()

    def _move(self, step: int) -> None:
        """To another line that is no heading, in the direction of `step`."""
        rows = [row for row in range(self.list.count()) if self.list.item(row).data(ENTRY) is not None]
        if rows:
            here = self.list.currentRow()
            at = rows.index(here) if here in rows else 0
            self.list.setCurrentRow(rows[min(max(at + step, 0), len(rows) - 1)])

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            event.accept()  # Esc, arrows and letters belong to the popup while it is open
            return True
        if event.type() == QEvent.Type.FocusOut and not self.list.underMouse():
            self.hide()
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            return self._pressed(event.key())
        return super().eventFilter(watched, event)

    def _pressed(self, key: int) -> bool:
        if key in self._moves:
            self._move(self._moves[Qt.Key(key)])
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._enter(self.list.currentItem())
        elif key == Qt.Key.Key_Escape:
            self.leave()
        else:
            return False
        return True

    def _enter(self, item: QListWidgetItem | None) -> None:
        if item is not None and item.data(ENTRY) is not None:
            self.choose(item.data(ENTRY))


class SearchRows(QStyledItemDelegate):
    """Draws the chosen line in the accent's colour; what stands in a line is written by a subclass."""

    theme: Theme = LIGHT

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        rect: QRect = option.rect
        state: QStyle.StateFlag = option.state
        chosen = bool(state & QStyle.StateFlag.State_Selected)
        painter.save()
        if chosen:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(self.theme.colour("accent"))
            painter.drawRoundedRect(rect.adjusted(0, 1, 0, -1), 4, 4)
        self.write(painter, rect.adjusted(GRID, 0, -GRID, 0), index.data(), index.data(ENTRY), chosen)
        painter.restore()

    def write(self, painter: QPainter, room: QRect, title: str, entry: Any, chosen: bool) -> None:
        """Write one line. entry : None for a heading."""
        raise NotImplementedError
