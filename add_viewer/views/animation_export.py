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
    QFrame,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from ..models.results import Notice
from .animation import AnimationChoice, Recorder, write_gif
from .forms import form_of
from .theme import GRID, Theme

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


class RecordingBar(QFrame):
    """How far the recording is, and the way out."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("recording")
        self.text, self.progress, self.cancel = QLabel(), QProgressBar(), QPushButton("Cancel")
        self.progress.setTextVisible(False)
        row = QHBoxLayout(self)
        row.setContentsMargins(2 * GRID, GRID, 2 * GRID, GRID)
        row.setSpacing(2 * GRID)
        row.addWidget(self.text)
        row.addWidget(self.progress, 1)
        row.addWidget(self.cancel)
        self.hide()

    def show_progress(self, done: int, total: int) -> None:
        """So many pictures of so many."""
        self.text.setText(f"Recording picture {done} of {total}")
        self.progress.setRange(0, total)
        self.progress.setValue(done)

    def show_theme(self, theme: Theme) -> None:
        """A bar with the accent colour at its edge."""
        self.setStyleSheet(
            f"#recording {{ background: {theme.panel}; border: none; border-left: 4px solid {theme.accent};"
            f" border-bottom: 1px solid {theme.line}; }}"
        )


class AnimationExport:
    """Wires dialog, recorder and writing. run : does work off the window's thread."""

    def __init__(self, window: MainWindow, saving: Saving, recorder: Recorder, run: Callable[..., None]) -> None:
        self._window, self._saving, self.recorder, self._run = window, saving, recorder, run
        self._path = Path()
        self.bar = RecordingBar()
        window.add_above(self.bar)
        window.menus.on("animation", self.ask)
        self.bar.cancel.clicked.connect(recorder.cancel)
        recorder.progressed.connect(self.bar.show_progress)
        recorder.recorded.connect(self._recorded)
        recorder.stopped.connect(self._rest)

    def ask(self) -> None:
        """Ask what moves and where to save it, then record."""
        self.dialog = AnimationDialog(sweeps=self._has_heat, parent=self._window)
        if self.dialog.exec() != QDialog.DialogCode.Accepted:
            return
        start = str(Path(self._window.settings.folder) / f"{self._saving.name}.gif")
        chosen = QFileDialog.getSaveFileName(self._window, "Export animation", start, "GIF (*.gif)")[0]
        if chosen:
            self.record(Path(chosen).with_suffix(".gif"), self.dialog.choice)

    def record(self, path: Path, choice: AnimationChoice) -> None:
        """Record and write; the window stays free."""
        self._path = path
        self._window.menus.actions["animation"].setEnabled(False)
        self.bar.show_progress(0, choice.count)
        self.bar.show()
        self.recorder.start(choice)

    @property
    def _has_heat(self) -> bool:
        state = self._window.session.state
        moving = ("heat", "rose")
        return bool(state.picks) and any(choice.kind in moving for choice in state.choices)

    def _recorded(self, frames: list[Image.Image], choice: AnimationChoice) -> None:
        path = self._path
        self.bar.text.setText(f"Writing {path.name} …")
        self._run(
            "export",
            lambda: self._saving.write_whole(path, lambda temporary: write_gif(temporary, frames, choice.rate)),
            done=lambda _answer: self._written(path),
            failed=self._failed,
            queue=True,
        )

    def _written(self, path: Path) -> None:
        self._rest()
        self._saving.tell_saved(path)

    def _failed(self, error: BaseException) -> None:
        self._rest()
        reason = self._saving.explain(error)
        self._window.results.noticed.emit(Notice(f"{self._path.name} was not saved: {reason}"))

    def _rest(self) -> None:
        self.bar.hide()
        self._window.menus.actions["animation"].setEnabled(bool(self._window.session.state.shapes))
