"""The best matches of the picked point, listed: where, how near in the descriptor, how far off on the surface."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from ..models.descriptor_names import descriptor_name
from ..models.insights import BestMatch, Insights
from ..models.session import Session
from .theme import GRID

ROWS = 3
HEADS = ("", "vertex", "distance", "off by")
HELP = (
    "Distance: in the descriptor, ÷ the median distance. Off by: along the surface from the true place, in geodesic "
    "diameters, where it is known; “mirror” is the wrong side."
)


class BestList(QWidget):
    """A block for each view with distances. chosen : the person wants to go on from that vertex of that shape."""

    chosen = Signal(str, int)

    def __init__(self, session: Session, insights: Insights) -> None:
        super().__init__()
        self._session, self._insights = session, insights
        self.buttons: list[QToolButton] = []
        self._blocks: list[QWidget] = []
        self._wanted = True
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(GRID)
        # Three shapes answer one after the other; the list waits until the pictures are drawn.
        self._later = QTimer(self, interval=0, singleShot=True)
        self._later.timeout.connect(self._show)
        insights.best_changed.connect(lambda: self._later.start())
        session.field_changed.connect(lambda: self._later.start())
        self._show()

    def _show(self) -> None:
        for block in self._blocks:
            self._column.removeWidget(block)
            block.hide()  # until it is deleted it would lie over the others
            block.deleteLater()
        self.buttons, self._blocks = [], []
        state = self._session.state
        places = [(panel, shape) for panel in range(len(state.choices)) for shape in state.shown]
        blocks = [(panel, shape, self._insights.best.get((panel, shape.key), ())) for panel, shape in places]
        for panel, shape, matches in blocks:
            if matches:
                split = f", {descriptor_name(state.choices[panel].descriptor).title}" if state.compare else ""
                self._blocks.append(self._block(f"{shape.name}{split}", matches))
                self._column.addWidget(self._blocks[-1])
        self.setVisible(bool(self._blocks) and self._wanted)

    def show_if(self, on: bool) -> None:
        """Whether there is room and reason for the list."""
        self._wanted = on
        self.setVisible(bool(self._blocks) and on)

    def _block(self, title: str, matches: tuple[BestMatch, ...]) -> QWidget:
        block = QWidget()
        block.setToolTip(HELP)
        grid = QGridLayout(block)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(GRID)
        grid.setVerticalSpacing(0)
        heading = QLabel(title)
        heading.setProperty("role", "heading")
        grid.addWidget(heading, 0, 0, 1, 4)
        for column, head in enumerate(HEADS):
            grid.addWidget(_cell(head, muted=True, right=column > 1), 1, column)
        for row, match in enumerate(matches[:ROWS]):
            self._add_row(grid, row, match)
        grid.setColumnStretch(1, 1)
        return block

    def _add_row(self, grid: QGridLayout, row: int, match: BestMatch) -> None:
        button = QToolButton()
        button.setText(str(match.vertex))
        button.setProperty("link", True)
        button.setCursor(Qt.CursorShape.PointingHandCursor)
        button.setToolTip("Compare everything with this point")
        button.clicked.connect(lambda: self.chosen.emit(match.shape, match.vertex))
        self.buttons.append(button)
        line = QHBoxLayout()
        line.setContentsMargins(0, 0, 0, 0)
        line.addWidget(button)
        line.addStretch(1)
        grid.addWidget(_cell(f"{row + 1}", muted=True), row + 2, 0)
        grid.addLayout(line, row + 2, 1)
        grid.addWidget(_cell(f"{match.distance:.2f}", right=True), row + 2, 2)
        grid.addWidget(_cell(_off_by(match), right=True), row + 2, 3)


def _off_by(match: BestMatch) -> str:
    if match.error is None:
        return "–"
    if match.is_mirror:
        return "mirror"
    return "exact" if match.error == 0 else f"{match.error:.3f} ⌀"


def _cell(text: str, *, muted: bool = False, right: bool = False) -> QLabel:
    label = QLabel(text)
    if muted:
        label.setProperty("role", "muted")
    if right:
        label.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
    return label
