"""File → Export animation: ask, record with progress and a way out, write off the window's thread."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QVBoxLayout,
    QWidget,
)

from .animation import AnimationChoice, Recorder, write_gif
from .forms import form_of
from .slow_export import SlowExport
from .theme import GRID

if TYPE_CHECKING:
    from .main_window import MainWindow
    from .saving import Saving

KINDS = {
    "turntable": "Turntable: once around",
    "theta": "θ from 0° to 180°",
    "time": "t from local to global and back",
}
WIDTHS = {480: "480 pixels", 640: "640 pixels", 960: "960 pixels"}
LENGTHS = {2.0: "2 seconds", 4.0: "4 seconds", 8.0: "8 seconds"}
RATES = {10: "10 pictures a second", 15: "15 pictures a second", 25: "25 pictures a second"}


class AnimationDialog(QDialog):
    """What moves, how large and how long. sweeps : whether heat is shown, which a sweep of θ or t needs."""

    def __init__(self, *, sweeps: bool, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Export animation")
        self.kind, self.width_box, self.length, self.rate = QComboBox(), QComboBox(), QComboBox(), QComboBox()
        entries: tuple[tuple[str, QComboBox, dict[Any, str], int], ...] = (
            ("What moves", self.kind, KINDS if sweeps else {"turntable": KINDS["turntable"]}, 0),
            ("Width", self.width_box, WIDTHS, 1),
            ("Length", self.length, LENGTHS, 1),
            ("Smoothness", self.rate, RATES, 1),
        )
        for _, box, options, chosen in entries:
            for value, text in options.items():
                box.addItem(text, value)
            box.setCurrentIndex(chosen)
        form = form_of([(words, box) for words, box, _, _ in entries])
        if not sweeps:
            self.kind.setToolTip("Show heat and pick a point to sweep θ or t.")
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Save | QDialogButtonBox.StandardButton.Cancel)
        buttons.button(QDialogButtonBox.StandardButton.Save).setText("Save…")
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        column = QVBoxLayout(self)
        column.setContentsMargins(2 * GRID, 2 * GRID, 2 * GRID, 2 * GRID)
        column.setSpacing(2 * GRID)
        column.addLayout(form)
        column.addWidget(buttons)

    @property
    def choice(self) -> AnimationChoice:
        """What is chosen now."""
        boxes = (self.kind, self.width_box, self.length, self.rate)
        return AnimationChoice(*(box.currentData() for box in boxes))


class AnimationExport(SlowExport):
    """Wires dialog, recorder and writing. run : does work off the window's thread."""

    def __init__(self, window: MainWindow, saving: Saving, recorder: Recorder, run: Callable[..., None]) -> None:
        super().__init__(window, saving, run, "animation")
        self.recorder = recorder
        self.bar.cancel.clicked.connect(recorder.cancel)
        recorder.progressed.connect(self._show_progress)
        recorder.recorded.connect(self._recorded)
        recorder.stopped.connect(self._rest)

    def ask(self) -> None:
        self.dialog = AnimationDialog(sweeps=self._has_heat, parent=self._window)
        if self.dialog.exec() != QDialog.DialogCode.Accepted:
            return
        start = str(Path(self._window.settings.folder) / f"{self._saving.name}.gif")
        chosen = QFileDialog.getSaveFileName(self._window, "Export animation", start, "GIF (*.gif)")[0]
        if chosen:
            self.record(Path(chosen).with_suffix(".gif"), self.dialog.choice)

    def record(self, path: Path, choice: AnimationChoice) -> None:
        """Record and write; the window stays free. Nothing is recorded that could not be written."""
        self._window.message.begin()
        if not self._saving.may_write(path):
            return
        self._begin(path)
        self._show_progress(0, choice.count)
        self.recorder.start(choice)

    @property
    def _has_heat(self) -> bool:
        state = self._window.session.state
        moving = ("heat", "rose")
        return bool(state.picks) and any(choice.kind in moving for choice in state.choices)

    def _show_progress(self, done: int, total: int) -> None:
        self.bar.show_progress(f"Recording picture {done} of {total}", done, total)

    def _recorded(self, frames: list[Image.Image], choice: AnimationChoice) -> None:
        self._write(lambda temporary: write_gif(temporary, frames, choice.rate))
