"""Paper, type and the few things that every figure writes the same way."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from .._check import FloatArray

INK, QUIET, RULE = "#22252a", "#6b7078", "#d9dade"
"""Text, quiet text, and lines that only guide the eye."""

TYPE: Any = {
    "font.family": "sans-serif",
    "font.size": 9.0,
    "mathtext.fontset": "stix",
    "axes.titlesize": 10.0,
    "axes.titleweight": "regular",
    "axes.labelsize": 9.0,
    "axes.edgecolor": "#9a9ea6",
    "axes.linewidth": 0.8,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": False,
    "grid.color": RULE,
    "grid.linewidth": 0.6,
    "text.color": INK,
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.linewidth": 1.6,
    "lines.solid_capstyle": "round",
    "svg.fonttype": "path",
    "pdf.fonttype": 42,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}
"""Of matplotlib, while a figure is drawn and saved."""


def blank(figure: Figure, box: tuple[float, float, float, float]) -> Axes:
    """Axes without frame or ticks. box : left, bottom, width and height in inches from the lower left corner."""
    width, height = figure.get_size_inches()
    left, bottom, wide, high = box
    axes = figure.add_axes((left / width, bottom / height, wide / width, high / height))
    axes.set_axis_off()
    return axes


def panel(figure: Figure, box: tuple[float, float, float, float]) -> Axes:
    """Axes for curves, in inches as `blank`."""
    axes = blank(figure, box)
    axes.set_axis_on()
    axes.grid(True)
    axes.set_axisbelow(True)
    return axes


def fade(axes: Axes, *, share: float = 0.1, sides: bool = False) -> None:
    """Let a picture that goes on above and below dissolve into the page, over a `share` of the height each.

    sides : to the left and right too.
    """
    left, right = axes.get_xlim()
    low, high = axes.get_ylim()
    up, across = share * (high - low), share * (right - left)
    veil = np.ones((64, 1, 4))
    veil[:, 0, 3] = np.linspace(1.0, 0.0, 64) ** 1.5
    look: Any = {"aspect": "auto", "interpolation": "bilinear", "zorder": 7}
    axes.imshow(veil, extent=(left, right, low + up, low), **look)
    axes.imshow(veil, extent=(left, right, high - up, high), **look)
    if sides:
        turned = veil.transpose(1, 0, 2)
        axes.imshow(turned, extent=(left, left + across, low, high), **look)
        axes.imshow(turned, extent=(right, right - across, low, high), **look)
    axes.set(xlim=(left, right), ylim=(low, high))


def colour_bar(
    figure: Figure,
    box: tuple[float, float, float, float],
    colours: FloatArray,
    *,
    title: str,
    ends: tuple[str, str],
) -> None:
    """A level bar on `colours` (k, 3) with words at both ends and what it means above. box : as for `blank`."""
    axes = blank(figure, box)
    ramp = [[step / 255 for step in range(256)]]
    axes.imshow(ramp, aspect="auto", cmap=ListedColormap(colours.tolist()), extent=(0, 1, 0, 1))
    place: dict[str, Any] = {"transform": axes.transAxes, "fontsize": 8.0, "color": QUIET}
    axes.text(0.0, -0.35, ends[0], ha="left", va="top", **place)
    axes.text(1.0, -0.35, ends[1], ha="right", va="top", **place)
    axes.text(0.0, 1.45, title, ha="left", va="bottom", **(place | {"color": INK}))


def degrees_of_theta(axes: Axes, *, label: str = "direction θ") -> None:
    """θ from 0° to 180° along x, marked at the quarters."""
    axes.set_xlim(0, 180)
    axes.set_xticks([0, 45, 90, 135, 180], ["0°", "45°", "90°", "135°", "180°"])
    axes.set_xlabel(label)
