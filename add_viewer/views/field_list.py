"""Every field to choose from, in groups, each with a sentence of help; typing a few letters finds one."""

from __future__ import annotations

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QFont, QPainter
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QStyleOptionViewItem, QWidget

from ..models.field_catalogue import FieldEntry, found_by
from ..models.fields import FieldChoice
from .search_popup import ENTRY, SearchPopup, SearchRows
from .theme import GRID

WIDTH, ROW, HEADING = 56 * GRID, 5 * GRID + 2, int(3.5 * GRID)


class FieldList(SearchPopup):
    """Lies over the window while a field is chosen. chosen : the choice of the entry."""

    chosen = Signal(FieldChoice)

    def __init__(self, window: QWidget) -> None:
        super().__init__(
            window,
            _Rows(),
            name="fieldList",
            prompt="Find a field: wks, curvature, mirror …",
            title="Find a field",
            nothing="No field is called that: try “curvature” or “AHKS”.",
            page=6,
        )
        self._entries: tuple[FieldEntry, ...] = ()
        self._room = QSize()

    def open(self, entries: tuple[FieldEntry, ...], current: FieldChoice | None, beside: QWidget) -> None:
        """Offer `entries` next to a widget, with the line of `current` ready to be left by Enter."""
        self._entries = entries
        corner = beside.mapTo(self._window, QPoint(0, beside.height() + GRID // 2))
        width = min(WIDTH, self._window.width() - 2 * GRID)
        height = min(70 * GRID, max(30 * GRID, self._window.height() - corner.y() - 4 * GRID))
        self._room = QSize(width, height)
        x = min(corner.x(), self._window.width() - width - GRID)
        self.move(x, min(corner.y(), self._window.height() - height - GRID))
        self.begin()
        self._go_to(current)

    def fit(self) -> None:
        lines = sum(self.list.sizeHintForRow(row) for row in range(self.list.count()))
        words = 0 if lines else self._nothing.sizeHint().height()
        wanted = self.field.sizeHint().height() + lines + words + 4 * GRID
        self.setFixedSize(self._room.width(), min(wanted, self._room.height()))

    def found(self, query: str) -> list[QListWidgetItem]:
        lines, group = [], ""
        for entry in found_by(self._entries, query):
            if entry.group != group and not query.strip():
                lines.append(self.heading(entry.group))
            group = entry.group
            lines.append(self.line(entry.title, entry.help, entry))
        return lines

    def choose(self, entry: FieldEntry) -> None:
        self.leave()
        self.chosen.emit(entry.choice)

    def _go_to(self, current: FieldChoice | None) -> None:
        for row in range(self.list.count()):
            entry = self.list.item(row).data(ENTRY)
            if entry is not None and current is not None and _alike(entry.choice, current):
                self.list.setCurrentRow(row)
                self.list.scrollToItem(self.list.item(row), QListWidget.ScrollHint.PositionAtCenter)
                return


def _alike(one: FieldChoice, two: FieldChoice) -> bool:
    return (one.kind, one.descriptor, one.name) == (two.kind, two.descriptor, two.name)


class _Rows(SearchRows):
    """A heading, or a title over a sentence of help."""

    def sizeHint(self, _option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        return QSize(WIDTH // 2, HEADING if index.data(ENTRY) is None else ROW)

    def write(self, painter: QPainter, room: QRect, title: str, entry: FieldEntry | None, chosen: bool) -> None:
        quiet = self.theme.colour("on_accent" if chosen else "muted")
        font = QFont(painter.font())
        if entry is None:
            font.setBold(True)
            font.setPointSizeF(0.9 * font.pointSizeF())
            painter.setFont(font)
            painter.setPen(quiet)
            low = Qt.AlignmentFlag.AlignBottom | Qt.AlignmentFlag.AlignLeft
            painter.drawText(room.adjusted(0, 0, 0, -4), low, title)
            return
        painter.setPen(self.theme.colour("on_accent" if chosen else "text"))
        painter.drawText(room.adjusted(0, 3, 0, 0), Qt.AlignmentFlag.AlignTop, title)
        font.setPointSizeF(0.88 * font.pointSizeF())
        painter.setFont(font)
        painter.setPen(quiet)
        help_text = painter.fontMetrics().elidedText(entry.help, Qt.TextElideMode.ElideRight, room.width())
        painter.drawText(room.adjusted(0, 0, 0, -4), Qt.AlignmentFlag.AlignBottom, help_text)
