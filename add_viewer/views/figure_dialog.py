"""What a figure holds and how large it is, with a preview of the page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QImage, QPixmap
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFrame,
    QHBoxLayout,
    QLabel,
    QVBoxLayout,
    QWidget,
)

from .figure_page import PageChoice
from .forms import ROW, form_of
from .theme import GRID

WIDTHS = {85.0: "85 mm, one column", 120.0: "120 mm", 180.0: "180 mm, two columns", 254.0: "254 mm, a slide"}
DPIS = {150: "150 dpi, for the screen", 300: "300 dpi, for print", 600: "600 dpi, finest"}
FILTERS = {
    "PDF, for papers (*.pdf)": ".pdf",
    "SVG, to edit further (*.svg)": ".svg",
    "PNG, pixels alone (*.png)": ".png",
}
_PREVIEW = (52 * GRID, 46 * GRID)
_PAUSE = 120
"""Milliseconds without a change before the preview is drawn anew."""

Draw = Callable[[PageChoice], QImage]


class FigureDialog(QDialog):
    """Shows the page as it will be. draw : the page as a picture, about as large as the preview."""

    def __init__(self, draw: Draw, *, has_curves: bool, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Export figure")
        self._draw, self._has_curves = draw, has_curves
        self.width_box, self.dpi_box = QComboBox(), QComboBox()
        self.names, self.bars, self.curves = QCheckBox("Names"), QCheckBox("Colour bars"), QCheckBox("Curves")
        self.preview, self.size_label = QLabel(), QLabel()
        self._timer = QTimer(self, singleShot=True, interval=_PAUSE)
        self._timer.timeout.connect(self.show_preview)
        self._build()
        self._changed()
        self.show_preview()

    def _build(self) -> None:
        for box, entries in ((self.width_box, WIDTHS), (self.dpi_box, DPIS)):
            for value, words in entries.items():
                box.addItem(words, value)
            box.currentIndexChanged.connect(self._changed)
        self.width_box.setCurrentIndex(2)
        self.dpi_box.setCurrentIndex(1)
        for switch in (self.names, self.bars, self.curves):
            switch.setChecked(True)
            switch.toggled.connect(self._changed)
            switch.setMinimumHeight(ROW)
        self.curves.setToolTip("At the picked points; they need a width of 140 mm.")
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Save | QDialogButtonBox.StandardButton.Cancel)
        buttons.button(QDialogButtonBox.StandardButton.Save).setText("Save…")
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        form = form_of([("Width", self.width_box), ("Shapes", self.dpi_box), ("With", self.names)])
        for switch in (self.bars, self.curves):
            form.addRow("", switch)
        self.preview.setFixedSize(*_PREVIEW)
        self.preview.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.preview.setFrameShape(QFrame.Shape.StyledPanel)
        self.size_label.setProperty("role", "muted")
        note = QLabel("Text and curves stay vectors in PDF and SVG.")
        note.setProperty("role", "muted")
        note.setWordWrap(True)
        left = QVBoxLayout()
        left.addLayout(form)
        left.addWidget(self.size_label)
        left.addWidget(note)
        left.addStretch(1)
        left.addWidget(buttons)
        row = QHBoxLayout(self)
        row.setContentsMargins(2 * GRID, 2 * GRID, 2 * GRID, 2 * GRID)
        row.setSpacing(2 * GRID)
        row.addLayout(left)
        row.addWidget(self.preview)

    @property
    def choice(self) -> PageChoice:
        """What is chosen now."""
        switches = {"names": self.names, "bars": self.bars, "curves": self.curves}
        chosen = {name: switch.isChecked() for name, switch in switches.items()}
        return PageChoice(self.width_box.currentData(), self.dpi_box.currentData(), **chosen)

    def _changed(self) -> None:
        if self.dpi_box.currentData() is not None:
            self.curves.setEnabled(self._has_curves and self.choice.has_room_for_curves)
            self._timer.start()

    def show_preview(self) -> None:
        """Draw the page anew."""
        image = self._draw(self.choice)
        ratio = self.devicePixelRatioF()
        room = self.preview.contentsRect().size() * ratio
        fitting = image.scaled(room, Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation)
        fitting.setDevicePixelRatio(ratio)
        self.preview.setPixmap(QPixmap.fromImage(fitting))
        height = self.choice.width * image.height() / max(image.width(), 1)
        self.size_label.setText(f"{self.choice.width:.0f} × {height:.0f} mm")


def ask_figure(parent: QWidget, folder: str, name: str) -> Path | None:
    """Where to save a figure; the ending decides the format."""
    start = str(Path(folder) / f"{name}.pdf")
    chosen, kind = QFileDialog.getSaveFileName(parent, "Export figure", start, ";;".join(FILTERS))
    if not chosen:
        return None
    path = Path(chosen)
    return path if path.suffix.lower() in FILTERS.values() else path.with_suffix(FILTERS[kind])
