"""Rows of words and controls, on common lines."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFormLayout, QLabel, QLayout, QWidget

from .theme import GRID

ROW = int(3.5 * GRID)
"""Height of a row's words: that of a box, so that both are centred on one line."""


def form_of(rows: list[tuple[str, QWidget | QLayout]], words_width: int = 0) -> QFormLayout:
    """A form with these rows; `words_width` > 0 lets several forms share their columns."""
    form = QFormLayout()
    form.setHorizontalSpacing(2 * GRID)
    form.setVerticalSpacing(GRID)
    form.setLabelAlignment(Qt.AlignmentFlag.AlignLeft)
    form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
    for words, control in rows:
        label = QLabel(words)
        label.setFixedHeight(ROW)
        if words_width:
            label.setFixedWidth(words_width)
        if isinstance(control, QWidget):
            label.setBuddy(control)
            control.setMinimumHeight(ROW)
        form.addRow(label, control)
    return form
