"""The numbers of a field: where distances saturate, which eigenfunction, which component."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from ..models.field_catalogue import catalogue, entry_of
from ..models.fields import FieldChoice
from ..models.scales import BrokenLine
from ..models.session import Session
from .number_field import NumberField
from .slider import SliderRow
from .theme import GRID

MEDIAN = 50.0
SATURATION_HELP = (
    "Distances beyond this percentile all look alike. The median, as in the paper's Figure 6, shows what is near; "
    "double click brings it back."
)
INDEX_HELP = "Number of the eigenfunction, or component of the descriptor. Up and Down step."


class FieldControls(QWidget):
    """Controls of the field of one panel; those that do not matter are hidden."""

    def __init__(self, session: Session, panel: int) -> None:
        super().__init__()
        self._session, self._panel = session, panel
        self.saturation = _saturation_row()
        self.index = NumberField(show_as=lambda value: f"{value:.0f}", step=lambda value, step: value + step)
        self.index_row = self._index_row()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GRID)
        column.addWidget(self.saturation)
        column.addWidget(self.index_row)
        self.saturation.changed.connect(session.saturate)
        self.saturation.reset.connect(lambda: session.saturate(MEDIAN))
        self.saturation.finished.connect(session.end_gesture)
        self.index.entered.connect(lambda value: self._go_to(round(value) - self._first))
        session.field_changed.connect(self._show)
        self._show()

    def _index_row(self) -> QWidget:
        row = QWidget()
        line = QHBoxLayout(row)
        line.setContentsMargins(0, 0, 0, 0)
        line.setSpacing(GRID // 2)
        label = QLabel("&Number")
        label.setBuddy(self.index)
        self.index.setFixedWidth(11 * GRID)
        for widget in (label, self.index):
            widget.setToolTip(INDEX_HELP)
        line.addWidget(label, 1)
        line.addWidget(self.index)
        line.addSpacing(3 * GRID + GRID // 2)
        return row

    @property
    def choice(self) -> FieldChoice | None:
        """The field of this panel."""
        return self._session.state.field if self._panel == 0 else self._session.state.compare

    @property
    def _first(self) -> int:
        """How the first one is counted: φ₀ is an eigenfunction, but components are counted from 1."""
        return 0 if self.choice is not None and self.choice.kind == "eigenfunction" else 1

    def _go_to(self, index: int) -> None:
        choice = self._session.state.compare
        if self._panel == 0:
            self._session.choose_field(index=max(0, index))
        elif choice is not None:
            self._session.choose_comparison(choice.with_changes(index=max(0, index)))

    def _show(self) -> None:
        choice = self.choice
        entry = None if choice is None else entry_of(catalogue(self._session.state, ()), choice)
        controls = frozenset() if entry is None else entry.controls
        repeated = self._panel == 1 and self._session.state.field.kind == "distance"
        saturates, counts = "saturation" in controls and not repeated, "index" in controls
        self.saturation.setVisible(saturates)
        self.index_row.setVisible(counts)
        self.setVisible(saturates or counts)
        if choice is not None:
            self.saturation.show_value(choice.saturation)
            self.index.show_value(choice.index + self._first)


def _saturation_row() -> SliderRow:
    return SliderRow(
        "&Saturation",
        "%",
        SATURATION_HELP,
        scale=BrokenLine(50.0, 100.0),
        ticks=[(1, "1"), (25, "25"), (50, "median"), (75, "75"), (100, "100")],
        show_as=lambda value: f"{value:.3g}",
        step=lambda value, step: value + step,
    )
