"""The picked points as a list, and a field to pick one by its number."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPen, QPixmap
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from add_core.drawing.colours import MARKERS, hex_colour

from ..models.picks import Pick
from ..models.session import Session
from .icons import icon
from .number_field import NumberField
from .theme import GRID, LIGHT, Theme

_COLUMNS = 3


class PickList(QWidget):
    """Chips in the colours of the markers; a click on one removes that point."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._theme = session, LIGHT
        self.field = NumberField(show_as=lambda value: f"{value:.0f}", step=lambda value, step: value + step)
        self.clear_button, self.problem = QToolButton(), QLabel()
        self.chips: list[QToolButton] = []
        self._chip_grid = QGridLayout()
        self._build()
        self.field.entered.connect(self._typed)
        self.clear_button.clicked.connect(session.clear_picks)
        session.picks_changed.connect(self._show_picks)
        session.active_changed.connect(self._show_picks)
        self._show_picks()

    def _build(self) -> None:
        label = QLabel("&Vertex")
        label.setBuddy(self.field)
        help_text = "Number of the picked vertex, counted from 0. Click the shape, or type a number."
        for widget in (label, self.field):
            widget.setToolTip(help_text)
        self.field.setFixedWidth(11 * GRID)
        self.field.setPlaceholderText("none")
        self.clear_button.setToolTip("Clear the picked points (Esc)")
        self.clear_button.setAccessibleName("Clear the picked points")
        self.clear_button.setProperty("quiet", True)
        self.clear_button.setFixedWidth(3 * GRID)
        top = QHBoxLayout()
        top.setSpacing(GRID // 2)
        top.addWidget(label, 1)
        top.addWidget(self.field)
        top.addWidget(self.clear_button)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GRID)
        column.addLayout(top)
        self.problem.setWordWrap(True)
        self.problem.setProperty("role", "muted")
        column.addWidget(self.problem)
        self._chip_grid.setSpacing(GRID // 2)
        self._chip_grid.setColumnStretch(_COLUMNS, 1)
        column.addLayout(self._chip_grid)

    def _typed(self, value: float) -> None:
        shape = self._session.state.active
        if shape is None:
            return
        fits = -0.5 <= value <= shape.vertex_count - 0.5  # False for what is not a number, too
        if fits:
            self._session.pick(min(round(value), shape.vertex_count - 1))
        self._show_picks()
        if not fits:
            last = shape.vertex_count - 1
            self._tell(f"There is no vertex {value:.15g}: those of {shape.name} are numbered 0 to {last}.")

    def _tell(self, problem: str) -> None:
        self.problem.setText(problem)
        self.problem.setVisible(bool(problem))

    def _show_picks(self) -> None:
        self._tell("")
        picks = self._session.state.active_picks
        self.field.show_value(picks[-1].vertex if picks else None)
        self.clear_button.setEnabled(bool(picks))
        for chip in self.chips:
            self._chip_grid.removeWidget(chip)
            chip.hide()  # until it is deleted it would lie over the others
            chip.deleteLater()
        self.chips = [self._chip(pick) for pick in picks] if len(picks) > 1 else []
        for index, chip in enumerate(self.chips):
            self._chip_grid.addWidget(chip, index // _COLUMNS, index % _COLUMNS)

    def _chip(self, pick: Pick) -> QToolButton:
        chip = QToolButton()
        chip.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        chip.setText(str(pick.vertex))
        chip.setIcon(_disc(pick))
        chip.setIconSize(QSize(12, 12))
        mirror = f", mirror of {pick.mirror_of}" if pick.is_mirror else ""
        chip.setToolTip(f"Vertex {pick.vertex}{mirror}. Click to remove it.")
        chip.setAccessibleName(f"Remove vertex {pick.vertex}{mirror}")
        chip.clicked.connect(lambda: self._session.unpick(pick.vertex))
        return chip

    def show_theme(self, theme: Theme) -> None:
        """Icons in the theme's colour."""
        self._theme = theme
        self.clear_button.setIcon(icon("mdi6.close", theme.muted))


def _disc(pick: Pick) -> QIcon:
    """A disc in the marker's colour, a ring for a mirror point."""
    pixmap = QPixmap(24, 24)
    pixmap.fill(Qt.GlobalColor.transparent)
    painter = QPainter(pixmap)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    colour = QColor(hex_colour(MARKERS[pick.slot]))
    painter.setPen(QPen(colour, 5))
    painter.setBrush(Qt.BrushStyle.NoBrush if pick.is_mirror else colour)
    painter.drawEllipse(QRectF(5, 5, 14, 14))
    painter.end()
    return QIcon(pixmap)
