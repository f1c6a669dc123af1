"""The paper's Figure 7: CMC, ROC and Princeton side by side, symmetric solid and asymmetric dashed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..errors import ParameterError
from .scores import PROTOCOLS, Scores

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = (
    *("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#999999"),
    *("#882255", "#332288", "#999933", "#8c510a", "#e31a1c", "#66c2a5", "#b15bff"),
)
"""Okabe and Ito's colours, told apart by the colour-blind, and seven more: a report compares up to fifteen methods."""
AXES = {
    "cmc": ("CMC", "rank k", "share found among the k nearest"),
    "roc": ("ROC", "share of false pairs accepted", "share of true pairs accepted"),
    "princeton": ("Princeton", "geodesic radius ÷ √area", "share of matches within it"),
}


def panels(scores: Sequence[Scores], *, title: str = "") -> Figure:
    """A matplotlib figure of all curves of all methods, with a panel for each protocol that was evaluated.

    Raises ParameterError if matplotlib is not installed.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:  # an extra: whoever only needs numbers need not install it
        raise ParameterError("Figures need matplotlib, which is not installed. Run: pip install matplotlib") from None
    evaluated = {curve.protocol for score in scores for curve in score.curves}
    protocols = [protocol for protocol in PROTOCOLS if protocol in evaluated] or list(PROTOCOLS)
    figure = Figure(figsize=(max(7.5, 2.2 + 3.6 * len(protocols)), 4.4), layout="constrained")
    for axes, protocol in zip(figure.subplots(1, len(protocols), squeeze=False)[0], protocols, strict=True):
        heading, across, up = AXES[protocol]
        axes.set(title=heading, xlabel=across, ylabel=up, ylim=(0, 1.02))
        axes.grid(color="#dddddd", linewidth=0.6)
        for colour, score in zip(COLOURS * (1 + len(scores) // len(COLOURS)), scores, strict=False):
            for curve in score.curves:
                if curve.protocol == protocol:
                    solid = curve.setting == "symmetric"
                    label = score.method if solid else None
                    axes.plot(curve.x, curve.y, color=colour, linestyle="-" if solid else "--", label=label)
    shown = {str(line.get_label()): line for axes in figure.axes for line in axes.lines}
    names = [score.method for score in scores if score.method in shown]
    figure.legend([shown[name] for name in names], names, loc="outside right center", frameon=False)
    if title:
        figure.suptitle(f"{title} (solid: symmetric, dashed: asymmetric)", fontsize=11)
    return figure
