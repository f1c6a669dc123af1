"""Views, colour bars and curves on one page for a paper: text and curves as vectors, shapes as fine pixels."""

# Matplotlib's figures have no types.
# mypy: disable-error-code=no-untyped-call

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

from add_core.drawing.colour_maps import tone_map

from .figure_plates import Bar, Plate
from .figure_words import wrapped
from .theme import LIGHT

MM = 1.0 / 25.4
"""Inches in a millimetre."""
_MARGIN, _GAP = 1.5, 3.0
_LINE, _BAR = 3.1, 2.4
"""Heights in millimetres: of a line of 7-point text, and of a colour bar."""
_NAME: dict[str, Any] = {"size": 8, "weight": "bold", "color": LIGHT.text}
_NAME_LINE = 3.6
"""Height of a line of a name in millimetres."""
_TALLEST = {1: 105.0, 2: 85.0}
_CURVES, _NARROWEST = 58.0, 140.0
"""Height of the curves in millimetres, and the narrowest page that they fit on."""


@dataclass(frozen=True)
class PageChoice:
    """width : millimetres. dpi : of the shapes' pixels. names, bars, curves : whether they are there."""

    width: float = 180.0
    dpi: int = 300
    names: bool = True
    bars: bool = True
    curves: bool = True

    def cell(self, columns: int) -> float:
        """Width of one of so many views side by side, in millimetres."""
        return (self.width - 2 * _MARGIN - (columns - 1) * _GAP) / columns

    @property
    def has_room_for_curves(self) -> bool:
        return self.width >= _NARROWEST


class Page:
    """One figure, laid out in millimetres from its upper left corner."""

    def __init__(
        self, plates: Sequence[Plate], choice: PageChoice, draw_curves: Callable[[Any, float, float], None] | None
    ) -> None:
        self._plates, self._choice = plates, choice
        self.columns = 1 + max(plate.column for plate in plates)
        self.rows = 1 + max(plate.row for plate in plates)
        self.cell = choice.cell(self.columns)
        height, width = plates[0].pixels.shape[:2]
        self.picture = min(self.cell * height / width, _TALLEST.get(self.rows, 65.0))
        self._head = max(self._head_of(plate) for plate in plates) if choice.names else 0.0
        self._foot = max(self._foot_of(plate) for plate in plates)
        curves = draw_curves if choice.curves and choice.has_room_for_curves else None
        pictures = 2 * _MARGIN + self.rows * (self._head + self.picture + self._foot + _GAP) - _GAP
        self.height = pictures + (_CURVES if curves else 0.0)
        self.figure = Figure(figsize=(choice.width * MM, self.height * MM), facecolor="white")
        for plate in plates:
            self._draw(plate)
        if curves is not None:
            grid = self.figure.add_gridspec(2, 1, height_ratios=(pictures, _CURVES))
            curves(self.figure.add_subfigure(grid[1]), choice.width / 25.4 * 72, _CURVES / 25.4 * 72)

    def save(self, path: Path) -> None:
        """Write a PNG, SVG or PDF, as the ending says; text stays text that can be edited."""
        with rc_context({"svg.fonttype": "none", "pdf.fonttype": 42}):
            self.figure.savefig(path, dpi=self._choice.dpi, format=path.suffix.lstrip(".").lower(), facecolor="white")

    # -- layout -------------------------------------------------------------------------------------------------------

    def _head_of(self, plate: Plate) -> float:
        return len(self._named(plate)) * _NAME_LINE + len(self._wrapped(plate.caption)) * _LINE + 0.6

    def _foot_of(self, plate: Plate) -> float:
        if plate.bar is None or not self._choice.bars:
            return 0.0
        return 2.0 + _BAR + (len(self._wrapped(_words(plate.bar))) + 1.3) * _LINE

    def _named(self, plate: Plate) -> list[str]:
        """Three lines at most: names of neighbours never meet, and pictures keep their room."""
        return wrapped(plate.name, self.cell, most=3, size=_NAME["size"], weight=_NAME["weight"])

    def _wrapped(self, text: str) -> list[str]:
        return wrapped(text.replace(" = ", "\u00a0=\u00a0"), self.cell, size=7)  # "θ = 45°" stays on one line

    def _draw(self, plate: Plate) -> None:
        left = _MARGIN + plate.column * (self.cell + _GAP)
        top = _MARGIN + plate.row * (self._head + self.picture + self._foot + _GAP)
        if self._choice.names:
            name = self._named(plate)
            self._write(left, top, name, apart=_NAME_LINE, **_NAME)
            self._write(left, top + len(name) * _NAME_LINE, self._wrapped(plate.caption))
        axes = self._axes(left, top + self._head, self.cell, self.picture)
        axes.axis("off")
        axes.imshow(plate.pixels, interpolation="none", aspect="equal")
        if plate.bar is not None and self._choice.bars:
            self._draw_bar(plate.bar, left, top + self._head + self.picture + 2.0)

    def _draw_bar(self, bar: Bar, left: float, top: float) -> None:
        lines = self._wrapped(_words(bar))
        wide = min(0.8 * self.cell, 70.0)
        middle = left + self.cell / 2
        self._write(middle, top, lines, ha="center", color=LIGHT.text)
        axes = self._axes(middle - wide / 2, top + len(lines) * _LINE + 0.4, wide, _BAR)
        axes.imshow(tone_map(bar.tones)[None], aspect="auto", extent=(0.0, 1.0, 0.0, 1.0), interpolation="none")
        axes.set_yticks([])
        axes.set_xticks([at for at, _ in bar.ticks], [label for _, label in bar.ticks])
        axes.tick_params(length=2, width=0.5, labelsize=7, pad=1.5, colors=LIGHT.text)
        for spine in axes.spines.values():
            spine.set(linewidth=0.5, color=LIGHT.muted)

    def _axes(self, left: float, top: float, width: float, height: float) -> Any:
        whole = (self._choice.width, self.height)
        place = (left / whole[0], 1 - (top + height) / whole[1], width / whole[0], height / whole[1])
        return self.figure.add_axes(place)

    def _write(self, left: float, top: float, lines: list[str], apart: float = _LINE, **style: Any) -> None:
        look: dict[str, Any] = {"size": 7, "color": LIGHT.muted, "va": "top"} | style
        for number, line in enumerate(lines):
            height = 1 - (top + number * apart) / self.height
            self.figure.text(left / self._choice.width, height, line, **look)


def _words(bar: Bar) -> str:
    return ", ".join((bar.title, *bar.notes))
