"""The settings: a person's taste, what is kept, and the way back to how it all was."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from ..models.display import Display
from .forms import form_of
from .theme import GRID

_WORDS = 16 * GRID


@dataclass(frozen=True)
class Disk:
    """The spectra on disk. used : bytes. limit : gigabytes. clear : makes room, and says how many bytes it freed."""

    used: Callable[[], int]
    limit: Callable[[], float]
    set_limit: Callable[[float], None]
    clear: Callable[[], int]


LOOKS: dict[str, tuple[str, str, dict[str, str]]] = {
    "theme": ("Theme", "Colours of the window.", {"system": "As the system", "light": "Light", "dark": "Dark"}),
    "kernel_colours": (
        "Heat colours",
        "All rise evenly in darkness and are safe for colour-blind readers.",
        {"kernel": "Warm: amber to violet", "sequential": "Cool: green to blue", "grey": "Grey, for print"},
    ),
    "kernel_scale": (
        "Heat scale",
        "Linear shows where heat is; logarithmic shows how far it reaches.",
        {"linear": "Linear", "log": "Logarithmic, two decades"},
    ),
    "up_axis": (
        "Up axis",
        "Which axis of a file points up; shipped shapes know theirs.",
        {"auto": "Automatic", "+y": "Y", "+z": "Z"},
    ),
    "samples": (
        "Edges",
        "Smoothing of a picture at rest; without a graphics card it takes time.",
        {"4": "Smooth", "8": "Finest", "0": "Fast, not smoothed"},
    ),
}
"""Settings with a choice of values: words, one sentence, and the words of each value."""


class SettingsDialog(QDialog):
    """Every change counts at once; nothing has to be confirmed."""

    def __init__(
        self, display: Display, disk: Disk, reset_layout: Callable[[], None], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("Settings")
        self._display, self._disk, self._reset_layout = display, disk, reset_layout
        self.choices = {name: self._choice(name) for name in LOOKS}
        self.autosave = QCheckBox("Keep the session after every change")
        self.limit, self.used, self.clear = QDoubleSpinBox(), QLabel(), QPushButton("Empty")
        self.panels_button, self.all_button = QPushButton("Reset panels"), QPushButton("Reset all settings")
        self._build()
        self._connect()
        self._show_display()
        self._show_disk()

    # -- building -----------------------------------------------------------------------------------------------------

    def _choice(self, name: str) -> QComboBox:
        box = QComboBox()
        for value, words in LOOKS[name][2].items():
            box.addItem(words, value)
        box.setToolTip(LOOKS[name][1])
        box.activated.connect(lambda: self._display.set(name, box.currentData()))
        return box

    def _build(self) -> None:
        looks = form_of([(LOOKS[name][0], box) for name, box in self.choices.items()], _WORDS)
        self.autosave.setToolTip("In your own folder, so that it can be restored after a crash.")
        self.limit.setRange(0.5, 1000.0)
        self.limit.setDecimals(1)
        self.limit.setPrefix("up to ")
        self.limit.setSuffix(" GB")
        self.limit.setKeyboardTracking(False)
        self.limit.setToolTip("Spectra that were not used for longest make room. It counts from the next computation.")
        self.clear.setToolTip("Delete the spectra on disk; they are computed again when they are needed.")
        self.used.setProperty("role", "muted")
        room = QHBoxLayout()
        room.setSpacing(GRID)
        for widget in (self.limit, self.used, self.clear):
            room.addWidget(widget, int(widget is self.used))
        kept = form_of([("Session", self.autosave), ("Spectra on disk", room)], _WORDS)
        ways_back = QHBoxLayout()
        ways_back.addWidget(self.panels_button)
        ways_back.addWidget(self.all_button)
        ways_back.addStretch(1)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        column = QVBoxLayout(self)
        column.setContentsMargins(3 * GRID, 2 * GRID, 3 * GRID, 2 * GRID)
        column.setSpacing(GRID)
        for title, layout in (("Looks", looks), ("What is kept", kept), ("Back to the beginning", ways_back)):
            heading = QLabel(title)
            heading.setProperty("role", "heading")
            column.addWidget(heading)
            column.addLayout(layout)
            column.addSpacing(GRID)
        column.addWidget(buttons)
        self.setMinimumWidth(56 * GRID)

    def _connect(self) -> None:
        self._display.changed.connect(self._show_display)
        self.finished.connect(lambda: self._display.changed.disconnect(self._show_display, missing_ok=True))
        self.autosave.toggled.connect(lambda on: self._display.set("autosave", on))
        self.limit.valueChanged.connect(self._disk.set_limit)
        self.clear.clicked.connect(self._clear)
        self.panels_button.clicked.connect(self._reset_layout)
        self.all_button.clicked.connect(self._reset_all)

    # -- models to view -----------------------------------------------------------------------------------------------

    def _show_display(self, _name: str = "") -> None:
        for name, box in self.choices.items():
            with QSignalBlocker(box):
                box.setCurrentIndex(box.findData(self._display[name]))
        with QSignalBlocker(self.autosave):
            self.autosave.setChecked(self._display["autosave"])

    def _show_disk(self) -> None:
        with QSignalBlocker(self.limit):
            self.limit.setValue(self._disk.limit())
        used = self._disk.used()
        self.used.setText(f"{used / 1e9:.2g} GB used" if used else "nothing kept")
        self.clear.setEnabled(used > 0)

    # -- what a person does -------------------------------------------------------------------------------------------

    def _clear(self) -> None:
        self._disk.clear()
        self._show_disk()

    def _reset_all(self) -> None:
        self._display.reset()
        self._disk.set_limit(DEFAULT_LIMIT)
        self._reset_layout()
        self._show_disk()


DEFAULT_LIMIT = 8.0
"""Gigabytes of spectra, as the core has it."""
