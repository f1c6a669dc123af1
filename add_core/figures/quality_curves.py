"""Figures 7 and 8: CMC, ROC and Princeton side by side, symmetric solid and asymmetric dashed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..evaluation import Scores
from ..evaluation.scores import PROTOCOLS
from . import matching
from .compared import RIVALS, shipped_comparison
from .drawn import Drawn
from .methods import method, obtainable
from .page import INK, QUIET, blank, panel
from .studio import Studio

DESCRIPTORS = ("hks", "wks", "wft", "ahks")
AXES = {
    "cmc": ("Cumulative match", "rank k", "share found among the k nearest"),
    "roc": ("ROC", "share of false pairs accepted", "share of true pairs accepted"),
    "princeton": ("Princeton", "geodesic radius ÷ √area", "share of matches within it"),
}
WIDE, HIGH, LEFT, GAP = 2.7, 2.3, 1.15, 0.78
KEY = 1.55
"""Inches for the names of the methods on the right."""


def draw(studio: Studio) -> Drawn:
    """One row of panels for each collection of the cast: hand-made descriptors and the trained ones."""
    names, missing = obtainable([*DESCRIPTORS, *studio.cast.learned])
    contests = studio.cast.contests
    studio.expect(sum(matching.steps(studio, contest, names) for contest in contests))
    rows = [(contest.title, matching.scores(studio, contest, names)) for contest in contests]
    comparison = shipped_comparison()
    rivals = [] if comparison is None else comparison.of(RIVALS)
    if comparison is None or not rivals:
        missing = (*missing, f"{', '.join(RIVALS)}: no report on them ships with this installation")
        return Drawn(curve_rows(rows), _caption(studio, rows), missing, {"csv": curve_table(rows)})
    first, *others = rows
    rows = [(first[0], [*rivals, *first[1]]), *others]
    titles = ", ".join(method(score.method).title for score in rivals)
    said = f" {titles} are from {comparison.source}, on pairs of its own."
    return Drawn(curve_rows(rows), _caption(studio, rows) + said, missing, {"csv": curve_table(rows)})


def curve_rows(rows: Sequence[tuple[str, Sequence[Scores]]]) -> Figure:
    """A figure with one row of three panels for each title and its scores."""
    height = 0.35 + len(rows) * (HIGH + 0.85)
    figure = Figure(figsize=(LEFT + 3 * WIDE + 2 * GAP + KEY, height))
    for row, (title, found) in enumerate(rows):
        bottom = height - 0.35 - row * (HIGH + 0.85) - HIGH
        for column, protocol in enumerate(PROTOCOLS):
            axes = panel(figure, (LEFT + column * (WIDE + GAP), bottom, WIDE, HIGH))
            draw_protocol(axes, found, protocol)
            if row == 0:
                axes.set_title(AXES[protocol][0], loc="left")
        side = blank(figure, (0.05, bottom, 0.3, HIGH))
        side.text(0.5, 0.5, title, rotation=90, ha="center", va="center", fontsize=11)
        if row == 0:
            draw_key(figure, (LEFT + 3 * WIDE + 2 * GAP + 0.15, bottom, KEY - 0.2, HIGH), found)
    return figure


def draw_protocol(axes: Axes, found: Sequence[Scores], protocol: str) -> None:
    """All curves of a protocol; the axes stay empty of methods that were not judged by it."""
    _, across, up = AXES[protocol]
    axes.set(xlabel=across, ylabel=up, ylim=(0, 1.01))
    axes.set_yticks([0, 0.25, 0.5, 0.75, 1], ["0", "25 %", "50 %", "75 %", "100 %"])
    for score in found:
        look = method(score.method)
        for curve in score.curves:
            if curve.protocol == protocol:
                solid = curve.setting == "symmetric"
                width = 1.9 if look.is_ours else 1.4
                axes.plot(curve.x, curve.y, color=look.colour, ls="-" if solid else (0, (3.2, 1.6)), lw=width)
    if protocol == "roc":
        axes.set(xscale="log", xlim=(1e-3, 1))
        axes.set_xticks([1e-3, 1e-2, 1e-1, 1], ["0.1 %", "1 %", "10 %", "100 %"])
        axes.minorticks_off()
    elif protocol == "cmc":
        axes.set(xlim=(1, 100))
        axes.set_xticks([1, 25, 50, 75, 100])
    else:
        axes.set(xlim=(0, 0.3))


def draw_key(figure: Figure, box: tuple[float, float, float, float], found: Sequence[Scores]) -> None:
    """Names of the methods in their colours, and what solid and dashed mean."""
    axes = blank(figure, box)
    height = box[3]
    axes.set(xlim=(0, box[2]), ylim=(0, height))
    for number, score in enumerate(found):
        look, y = method(score.method), height - 0.12 - 0.21 * number
        axes.add_line(Line2D([0, 0.24], [y, y], color=look.colour, lw=2.2))
        axes.text(0.32, y, look.title, va="center", fontsize=9, color=INK)
    for number, (word, dashes) in enumerate((("symmetric", "-"), ("asymmetric", (0, (3.2, 1.6))))):
        y = 0.32 - 0.2 * number
        axes.add_line(Line2D([0, 0.3], [y, y], color=QUIET, lw=1.4, ls=dashes))
        axes.text(0.38, y, word, va="center", fontsize=8, color=QUIET)


def curve_table(rows: Sequence[tuple[str, Sequence[Scores]]]) -> str:
    """All curves as CSV."""
    lines = ["data,method,protocol,setting,x,y"]
    for title, found in rows:
        for score in found:
            for curve in score.curves:
                start = f"{title},{score.method},{curve.protocol},{curve.setting}"
                lines += [f"{start},{x:.6g},{y:.6g}" for x, y in zip(curve.x, curve.y, strict=True)]
    return "\n".join(lines) + "\n"


def drop(score: Scores) -> str:
    """CMC@1 in both settings and the share on the right side, in words."""
    numbers = score.numbers
    parts = [f"{100 * numbers[name]:.0f}" for name in ("CMC@1 symmetric", "CMC@1 asymmetric") if name in numbers]
    side = f", right side {numbers['P(right side)']:.0%}" if "P(right side)" in numbers else ""
    return f"{method(score.method).title} {' → '.join(parts)} %{side}"


def _caption(studio: Studio, rows: Sequence[tuple[str, Sequence[Scores]]]) -> str:
    quality = studio.quality
    asked = "all points" if quality.queries is None else f"{quality.queries} points"
    listed = ". ".join(f"{title}: " + "; ".join(drop(score) for score in found) for title, found in rows)
    pairs = int(np.max([score.pairs for _, found in rows for score in found]))
    return (
        f"Performance of descriptors on test shapes, mean over {pairs} pairs; {asked} of the first shape are looked "
        "for among all of the second. Solid: a mirror image counts as right; dashed: it does not. "
        f"K = {quality.eigenpairs}, {quality.angles} angles. All have 16 numbers a point but AHKS "
        f"({16 * (1 + quality.angles)}). CMC@1, symmetric → asymmetric. {listed}."
    )
