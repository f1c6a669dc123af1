"""Words of a figure, broken into lines by how wide they are printed."""

# Matplotlib's figures have no types.
# mypy: disable-error-code=no-untyped-call

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

POINT = 25.4 / 72.0
"""Millimetres in a point."""


def wrapped(text: str, width: float, *, size: float, weight: str = "normal", most: int | None = None) -> list[str]:
    """`text` in lines of at most `width` millimetres, broken at spaces, and at `most` so many of them.

    What does not fit ends in an ellipsis: a word wider than a line, and what is left for the last line.
    size : of the letters, in points.
    """

    def fits(line: str) -> bool:
        return printed_width(line, size, weight) <= width

    lines: list[str] = []
    words = text.split(" ") if text else []
    for number, word in enumerate(words):
        if lines and fits(f"{lines[-1]} {word}"):
            lines[-1] += f" {word}"
        elif lines and len(lines) == most:
            lines[-1] = " ".join((lines[-1], *words[number:]))
            break
        else:
            lines.append(word)
    return [_cut(line, fits) for line in lines]


@cache
def printed_width(text: str, size: float, weight: str = "normal") -> float:
    """Width of `text` in millimetres, in letters of `size` points."""
    if not text.strip():
        return 0.0
    return float(TextPath((0, 0), text, size=size, prop=FontProperties(weight=weight)).get_extents().x1) * POINT


def _cut(line: str, fits: Callable[[str], bool]) -> str:
    if fits(line):
        return line
    shorter = (f"{line[:end].rstrip(' ,')}…" for end in range(len(line) - 1, 0, -1))
    return next((each for each in shorter if fits(each)), "…")
