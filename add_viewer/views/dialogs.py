"""Questions that need an answer before something is done."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QVBoxLayout,
    QWidget,
)

from .theme import GRID

SHAPE_FILTER = (
    "Shapes and sessions (*.off *.obj *.ply *.stl *.vtk *.vtp *.glb *.gltf *.xyz *.addsession);;All files (*)"
)
CURVE_FILTERS = {
    "SVG, for papers (*.svg)": ".svg",
    "PDF, for papers (*.pdf)": ".pdf",
    "PNG, 300 dpi (*.png)": ".png",
    "CSV, the numbers (*.csv)": ".csv",
}


@dataclass(frozen=True)
class PictureChoice:
    """How a picture of the view is saved."""

    scale: int
    transparent: bool
    labels: bool


class PictureDialog(QDialog):
    """Size, background and labels of a picture."""

    def __init__(self, width: int, height: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Save picture")
        self.scale = QComboBox()
        for factor in (1, 2, 4):
            self.scale.addItem(f"{factor}×   {factor * width} × {factor * height} pixels", factor)
        self.scale.setCurrentIndex(1)
        self.transparent = QCheckBox("Transparent background")
        self.labels = QCheckBox("Colour bar, name and axes")
        self.labels.setChecked(True)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Save | QDialogButtonBox.StandardButton.Cancel)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        form = QFormLayout()
        form.setSpacing(GRID)
        form.addRow("Size", self.scale)
        form.addRow("", self.transparent)
        form.addRow("", self.labels)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(2 * GRID, 2 * GRID, 2 * GRID, 2 * GRID)
        layout.setSpacing(2 * GRID)
        layout.addLayout(form)
        layout.addWidget(buttons)

    @property
    def choice(self) -> PictureChoice:
        return PictureChoice(self.scale.currentData(), self.transparent.isChecked(), self.labels.isChecked())


def ask_open(parent: QWidget, folder: str) -> list[str]:
    """Files to open; none if the person thought better of it."""
    return QFileDialog.getOpenFileNames(parent, "Open shapes", folder, SHAPE_FILTER)[0]


def ask_picture(parent: QWidget, folder: str, name: str) -> Path | None:
    """Where to save a PNG."""
    chosen = QFileDialog.getSaveFileName(parent, "Save picture", str(Path(folder) / f"{name}.png"), "PNG (*.png)")[0]
    return Path(chosen).with_suffix(".png") if chosen else None


def ask_curves(parent: QWidget, folder: str, name: str) -> Path | None:
    """Where to save curves; the ending decides the format."""
    start = str(Path(folder) / f"{name}.svg")
    chosen, kind = QFileDialog.getSaveFileName(parent, "Export curves", start, ";;".join(CURVE_FILTERS))
    if not chosen:
        return None
    path = Path(chosen)
    return path if path.suffix.lower() in CURVE_FILTERS.values() else path.with_suffix(CURVE_FILTERS[kind])
