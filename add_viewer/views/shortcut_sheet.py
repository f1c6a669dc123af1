"""What mouse and keyboard do: the mouse's gestures, and every action that has a key."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import (
    QDialog,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QMainWindow,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from .action_tour import tour
from .theme import GRID

Rows = list[tuple[str, str]]
_KEYS = int(14.5 * GRID)
"""Width of the column of keys: words begin at one line in every group."""
_COLUMN = 48 * GRID

GESTURES: dict[str, tuple[tuple[str, str], ...]] = {
    "Mouse on the shape": (
        ("Click", "Drop heat on a point"),
        ("Shift + click", "Add a point, up to eight"),
        ("Alt + click", "Add the mirror image of a point"),
        ("Right click", "What can be done here"),
        ("Drag", "Turn the shape"),
        ("Shift + drag", "Move it (or middle button)"),
        ("Wheel", "Come closer (or right drag)"),
        ("Drop a file", "Open it"),
    ),
    "Keys on the shape": (
        ("← → ↑ ↓", "Turn it by 15°; with Shift move it"),
        ("+ −", "Come closer, go away"),
    ),
    "Mouse on the controls": (
        ("Double click", "Back to the default, on sliders and dial"),
        ("Ctrl + drag", "Snap θ to 15°, on the dial"),
        ("Drag in a curve", "Turn θ, or move t"),
    ),
    "Keys in the list of shapes": (
        ("↑ ↓", "Another line"),
        ("Enter", "Make it the source"),
        ("Space", "Show or hide it"),
        ("Alt + ↑ ↓", "Move it up or down"),
        ("Delete", "Close it"),
        ("Shift + F10", "Wireframe, point size and more"),
    ),
    "Keys in the controls": (
        ("← →", "A step; with Ctrl on the dial 15°"),
        ("Page ↑ ↓", "A larger step"),
        ("Tab", "The next control"),
    ),
}


def keyboard(window: QMainWindow) -> dict[str, Rows]:
    """The actions that have a key, by menu: pairs of key and words."""
    groups: dict[str, Rows] = {}
    for stop in tour(window.menuBar()):
        if stop.keys:
            groups.setdefault(stop.menu, []).append((" or ".join(stop.keys), stop.name))
    return groups


class ShortcutSheet(QDialog):
    """All of it on one sheet, in columns of about equal length."""

    def __init__(self, window: QMainWindow) -> None:
        super().__init__(window)
        self.setWindowTitle("Mouse and keyboard")
        groups: dict[str, Iterable[tuple[str, str]]] = {**GESTURES, **keyboard(window)}
        sheet = QWidget()
        row = QHBoxLayout(sheet)
        row.setContentsMargins(2 * GRID, 2 * GRID, 2 * GRID, 2 * GRID)
        row.setSpacing(3 * GRID)
        columns = min(max(window.width() // _COLUMN, 1), 3)
        for names in _split({name: len(list(rows)) + 2 for name, rows in groups.items()}, columns):
            column = QVBoxLayout()
            column.setSpacing(2 * GRID)
            for name in names:
                column.addLayout(_group(name, groups[name]))
            column.addStretch(1)
            row.addLayout(column)
        scroll = QScrollArea()
        scroll.setWidget(sheet)
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(scroll)
        wanted = sheet.sizeHint() + QSize(2 * GRID, 2 * GRID)  # a scroll bar's width more
        self.resize(wanted.boundedTo(window.size() - QSize(2 * GRID, 2 * GRID)))


def _split(lengths: dict[str, int], columns: int) -> list[list[str]]:
    """The groups in their order, cut into columns of about equal length."""
    whole = sum(lengths.values())
    parts: list[list[str]] = [[] for _ in range(columns)]
    before = 0
    for name, length in lengths.items():
        parts[min(int((before + length / 2) * columns / whole), columns - 1)].append(name)
        before += length
    return [part for part in parts if part]


def _group(name: str, rows: Iterable[tuple[str, str]]) -> QGridLayout:
    grid = QGridLayout()
    grid.setHorizontalSpacing(2 * GRID)
    grid.setVerticalSpacing(GRID // 2)
    heading = QLabel(name)
    heading.setProperty("role", "heading")
    grid.addWidget(heading, 0, 0, 1, 2)
    for index, (key, words) in enumerate(rows, start=1):
        cap = QLabel(key)
        cap.setProperty("role", "key")
        grid.addWidget(cap, index, 0, Qt.AlignmentFlag.AlignLeft)
        grid.addWidget(QLabel(words), index, 1)
    grid.setColumnMinimumWidth(0, _KEYS)
    grid.setColumnStretch(1, 1)
    return grid
