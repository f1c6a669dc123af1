"""Every field to choose from, in groups, each with a sentence of help; typing a few letters finds one."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QModelIndex, QObject, QPersistentModelIndex, QPoint, QSize, Qt, Signal
from PySide6.QtGui import QFont, QKeyEvent, QPainter
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

from ..models.field_catalogue import FieldEntry, found_by
from ..models.fields import FieldChoice
from .theme import GRID, LIGHT, Theme

WIDTH, ROW, HEADING = 56 * GRID, 5 * GRID + 2, int(3.5 * GRID)
_ENTRY = Qt.ItemDataRole.UserRole
_PAGE = 6
_MOVES = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1, Qt.Key.Key_PageDown: _PAGE, Qt.Key.Key_PageUp: -_PAGE}


class FieldList(QFrame):
    """Lies over the window while a field is chosen. chosen : the choice of the entry."""

    chosen = Signal(FieldChoice)

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self.setObjectName("fieldList")
        self._window = window
        self._entries: tuple[FieldEntry, ...] = ()
        self.field, self.list = QLineEdit(), QListWidget()
        self._nothing = QLabel("No field is called that.")
        self.rows = _Rows(self.list)
        self._lay_out()
        self.field.installEventFilter(self)
        self.field.textChanged.connect(self._show_found)
        self.list.itemClicked.connect(self._choose)
        self.hide()

    def _lay_out(self) -> None:
        self.field.setPlaceholderText("Find a field: wks, curvature, mirror …")
        self.field.setAccessibleName("Find a field")
        self.field.setMinimumHeight(4 * GRID)
        self.list.setItemDelegate(self.rows)
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setVerticalScrollMode(QListWidget.ScrollMode.ScrollPerPixel)
        self._nothing.setProperty("role", "muted")
        self._nothing.setContentsMargins(GRID, GRID, GRID, GRID)
        column = QVBoxLayout(self)
        column.setContentsMargins(GRID, GRID, GRID, GRID)
        column.setSpacing(GRID)
        for widget in (self.field, self.list, self._nothing):
            column.addWidget(widget)

    # -- showing ------------------------------------------------------------------------------------------------------

    def open(self, entries: tuple[FieldEntry, ...], current: FieldChoice | None, beside: QWidget) -> None:
        """Offer `entries` next to a widget, with the line of `current` ready to be left by Enter."""
        self._entries = entries
        corner = beside.mapTo(self._window, QPoint(0, beside.height() + GRID // 2))
        width = min(WIDTH, self._window.width() - 2 * GRID)
        height = min(70 * GRID, max(30 * GRID, self._window.height() - corner.y() - 4 * GRID))
        self.setFixedSize(width, height)
        x = min(corner.x(), self._window.width() - width - GRID)
        self.move(x, min(corner.y(), self._window.height() - height - GRID))
        self.field.clear()
        self._show_found("")
        self._go_to(current)
        self.show()
        self.raise_()
        self.field.setFocus(Qt.FocusReason.ShortcutFocusReason)

    def _show_found(self, text: str) -> None:
        found = found_by(self._entries, text)
        self.list.clear()
        group = ""
        for entry in found:
            if entry.group != group and not text.strip():
                heading = QListWidgetItem(entry.group)
                heading.setFlags(Qt.ItemFlag.NoItemFlags)
                self.list.addItem(heading)
            group = entry.group
            item = QListWidgetItem(entry.title)
            item.setData(_ENTRY, entry)
            item.setToolTip(entry.help)
            self.list.addItem(item)
        self._nothing.setVisible(not found)
        self.list.setVisible(bool(found))
        self._move(0)

    def _go_to(self, current: FieldChoice | None) -> None:
        for row in range(self.list.count()):
            entry = self.list.item(row).data(_ENTRY)
            if entry is not None and current is not None and _alike(entry.choice, current):
                self.list.setCurrentRow(row)
                self.list.scrollToItem(self.list.item(row), QListWidget.ScrollHint.PositionAtCenter)
                return

    def _move(self, step: int) -> None:
        """To the next line that is no heading, in the direction of `step`."""
        rows = [row for row in range(self.list.count()) if self.list.item(row).data(_ENTRY) is not None]
        if rows:
            here = self.list.currentRow()
            at = rows.index(here) if here in rows else 0
            self.list.setCurrentRow(rows[min(max(at + step, 0), len(rows) - 1)])

    def show_theme(self, theme: Theme) -> None:
        """A panel that stands out from the window by its edge."""
        self.rows.theme = theme
        self.setStyleSheet(
            f"#fieldList {{ background: {theme.panel}; border: 1px solid {theme.muted}; border-radius: 8px; }}"
            f" QListWidget {{ background: {theme.panel}; }}"
        )

    # -- what a person does -------------------------------------------------------------------------------------------

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            event.accept()  # Esc, arrows and letters belong to the list while it is open
            return True
        if event.type() == QEvent.Type.FocusOut and not self.list.underMouse():
            self.hide()
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            return self._pressed(event.key())
        return super().eventFilter(watched, event)

    def _pressed(self, key: int) -> bool:
        if key in _MOVES:
            self._move(_MOVES[Qt.Key(key)])
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._choose(self.list.currentItem())
        elif key == Qt.Key.Key_Escape:
            self._leave()
        else:
            return False
        return True

    def _choose(self, item: QListWidgetItem | None) -> None:
        entry = None if item is None else item.data(_ENTRY)
        if isinstance(entry, FieldEntry):
            self._leave()
            self.chosen.emit(entry.choice)

    def _leave(self) -> None:
        self.hide()
        self._window.setFocus()


def _alike(one: FieldChoice, two: FieldChoice) -> bool:
    return (one.kind, one.descriptor, one.name) == (two.kind, two.descriptor, two.name)


class _Rows(QStyledItemDelegate):
    """A heading, or a title over a sentence of help."""

    theme: Theme = LIGHT

    def sizeHint(self, _option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        return QSize(WIDTH // 2, HEADING if index.data(_ENTRY) is None else ROW)

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        entry = index.data(_ENTRY)
        rect, state = option.rect, option.state
        chosen = bool(state & QStyle.StateFlag.State_Selected)
        painter.save()
        if chosen:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(self.theme.colour("accent"))
            painter.drawRoundedRect(rect.adjusted(0, 1, 0, -1), 4, 4)
        words = self.theme.colour("on_accent" if chosen else "text")
        quiet = self.theme.colour("on_accent" if chosen else "muted")
        place = rect.adjusted(GRID, 0, -GRID, 0)
        font = QFont(painter.font())
        if entry is None:
            font.setBold(True)
            font.setPointSizeF(0.9 * font.pointSizeF())
            painter.setFont(font)
            painter.setPen(self.theme.colour("muted"))
            low = Qt.AlignmentFlag.AlignBottom | Qt.AlignmentFlag.AlignLeft
            painter.drawText(place.adjusted(0, 0, 0, -4), low, index.data())
        else:
            painter.setPen(words)
            painter.drawText(place.adjusted(0, 3, 0, 0), Qt.AlignmentFlag.AlignTop, entry.title)
            font.setPointSizeF(0.88 * font.pointSizeF())
            painter.setFont(font)
            painter.setPen(quiet)
            help_text = painter.fontMetrics().elidedText(entry.help, Qt.TextElideMode.ElideRight, place.width())
            painter.drawText(place.adjusted(0, 0, 0, -4), Qt.AlignmentFlag.AlignBottom, help_text)
        painter.restore()
