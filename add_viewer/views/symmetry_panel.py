"""The symmetry explorer: a point and its mirror image, and which descriptors know one from the other."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from ..models.display import Display
from ..models.fields import FieldChoice
from ..models.insights import Insights
from ..models.session import Session
from .telling_bars import TellingBars
from .theme import GRID, Theme

NEAR = 10.0
"""Percentile at which the explorer's distances saturate: only what is nearly the same stays cold."""

SCENES: dict[str, tuple[str, str, FieldChoice, FieldChoice | None]] = {
    "distances": (
        "&Distances",
        "What HKS takes the point for, and what AHKS does: cold is alike",
        FieldChoice("distance", "hks", saturation=NEAR),
        FieldChoice("distance", "ahks", saturation=NEAR),
    ),
    "everywhere": (
        "&Everywhere",
        "Where HKS and AHKS know a point from its mirror image: cold is mistaken",
        FieldChoice("ambiguity", "hks"),
        FieldChoice("ambiguity", "ahks"),
    ),
    "heat": (
        "&Heat ±θ",
        "θ at the point, −θ at its mirror image: play θ and watch them mirror each other",
        FieldChoice("rose", name="mirror"),
        None,
    ),
}
"""Name → words, help, and the fields of both panels."""


class SymmetryPanel(QWidget):
    """Shown while the explorer is on. find_wanted : look for the mirror map. compare_wanted : compute a descriptor."""

    find_wanted = Signal(str)
    compare_wanted = Signal(str)
    left = Signal()

    def __init__(self, session: Session, insights: Insights, display: Display) -> None:
        super().__init__()
        self._session, self._insights, self._display = session, insights, display
        self.heading, self.status = QLabel("Left from right?"), QLabel()
        self.find_button = QPushButton("Find its &mirror map")
        self.bars = TellingBars()
        self.scenes = {name: QPushButton(words) for name, (words, *_rest) in SCENES.items()}
        self._lay_out()
        self._connect()
        self._show()

    def _lay_out(self) -> None:
        self.heading.setProperty("role", "heading")
        self.status.setProperty("role", "muted")
        self.status.setWordWrap(True)
        row = QHBoxLayout()
        row.setSpacing(GRID // 2)
        for name, button in self.scenes.items():
            button.setCheckable(True)
            button.setToolTip(SCENES[name][1])
            row.addWidget(button)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GRID)
        column.addWidget(self.heading)
        column.addWidget(self.bars)
        column.addLayout(row)
        column.addWidget(self.status)
        column.addWidget(self.find_button)

    def _connect(self) -> None:
        for name, button in self.scenes.items():
            button.clicked.connect(lambda _checked=False, name=name: self.show_scene(name))
        self.bars.wanted.connect(self.compare_wanted)
        self.bars.chosen.connect(self._draw_everywhere)
        self.find_button.clicked.connect(lambda: self.find_wanted.emit(self._session.state.active_key or ""))
        for signal in (
            self._insights.tellings_changed,
            self._session.field_changed,
            self._session.active_changed,
            self._session.shapes_changed,
        ):
            signal.connect(self._show)

    def show_scene(self, name: str) -> None:
        """Draw one of the explorer's pictures."""
        _, _, field, compare = SCENES[name]
        self._session.set_scene(field=field, compare=compare)

    def _draw_everywhere(self, descriptor: str) -> None:
        self._session.set_scene(field=FieldChoice("ambiguity", descriptor), compare=None)

    def _show(self) -> None:
        state = self._session.state
        self.bars.show_tellings(self._insights.tellings)
        for name, button in self.scenes.items():
            button.setChecked(alike((state.field, state.compare), SCENES[name][2:]))
        shape = state.active
        unknown = shape is not None and shape.symmetry is None
        self.find_button.setVisible(unknown and not self._insights.mirror_message)
        words = self._insights.mirror_message
        if shape is not None and not words:
            words = _status(shape.symmetry is not None, shape.symmetry_confidence)
        self.status.setText(words)
        self.status.setVisible(bool(words))

    def show_theme(self, theme: Theme) -> None:
        """Colours of the bars."""
        self.bars.show_theme(theme)


def alike(one: tuple[FieldChoice, FieldChoice | None], two: tuple[FieldChoice, FieldChoice | None]) -> bool:
    """Whether the same fields are shown, wherever distances saturate."""
    plain = [[None if each is None else each.with_changes(saturation=NEAR) for each in pair] for pair in (one, two)]
    return plain[0] == plain[1]


def _status(known: bool, confidence: float | None) -> str:
    if not known:
        return "The mirror map of this shape is not known. Find it, or pick a point and Alt-click its partner."
    return "" if confidence is None else f"Mirror map found by the shape itself, confidence {confidence:.2f}."
