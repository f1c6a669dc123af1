"""The three plots of the anisotropic heat kernel signature, as Matplotlib draws them on screen and into files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from add_core.drawing.colours import MARKERS, theta_colour

from ..models.curve_reading import once_around, over_theta, over_time, read_backwards
from ..models.diffusion import REACH_MAX, REACH_MIN
from ..models.results import AutodiffusionCurves
from .theme import Theme

OTHER_TIMES = ((0.1, 0.9, "t/10"), (10.0, 0.9, "10 t"))
"""Times beside the shown one: factor, line width, label."""


@dataclass(frozen=True, eq=False)
class CurveScene:
    """Everything that the plots show at one moment. Angles in radians, times in geodesic diameters squared.

    reflected : curves of mirror images are drawn at −θ, where they lie on those of the points that they mirror.
    """

    curves: tuple[AutodiffusionCurves, ...]
    theta: float
    reach: float
    relative: bool
    theme: Theme
    reflected: bool = False

    @property
    def shown(self) -> tuple[AutodiffusionCurves, ...]:
        return tuple(each for each in self.curves if len(each.thetas) >= 2)


class CurvePlots:
    """Axes that stay, and artists that are drawn anew: `draw_static` once, `moving_artists` for every picture."""

    def __init__(self, figure: Figure) -> None:
        self.figure = figure
        self.theta_axes = figure.add_axes((0.1, 0.2, 0.2, 0.6))
        self.polar_axes = figure.add_axes((0.4, 0.2, 0.2, 0.6), projection="polar")
        self.time_axes = figure.add_axes((0.7, 0.2, 0.2, 0.6))
        self._limits = (0.0, 1.0)

    def lay_out(self, width: float, height: float, *, below: float = 0.0) -> None:
        """Place the plots in a figure of this size in points, `below` of them left free at the bottom."""
        left, right, bottom, top, gap = 50.0, 14.0, 36.0 + below, 24.0, 58.0
        tall = height - bottom - top
        polar = min(tall + 8, 0.26 * width)
        wide = 0.5 * (width - left - right - polar - 2 * gap + 16)
        starts = (left, left + wide + gap - 16, left + wide + gap - 16 + polar + gap)
        sizes = ((wide, tall), (polar, polar), (wide, tall))
        lifts = (bottom, bottom + 0.5 * (tall - polar) - 4, bottom)
        for axes, start, (w, h), lift in zip(self.all_axes, starts, sizes, lifts, strict=True):
            axes.set_position((start / width, lift / height, max(w, 20) / width, max(h, 20) / height))

    @property
    def all_axes(self) -> tuple[Axes, Axes, Axes]:
        return self.theta_axes, self.polar_axes, self.time_axes

    def draw_static(self, scene: CurveScene) -> None:
        """Axes, labels and limits."""
        for axes in self.all_axes:
            axes.clear()
            _style(axes, scene.theme)
        self.figure.set_facecolor(scene.theme.window)
        self._static_theta(scene)
        self._static_polar(scene)
        self._static_time(scene)

    def _static_theta(self, scene: CurveScene) -> None:
        axes = self.theta_axes
        axes.set_xlim(0, 180)
        axes.set_xticks([0, 45, 90, 135, 180], ["0°", "45°", "90°", "135°", "180°"])
        axes.set_xlabel("direction θ", labelpad=1)
        axes.set_title(
            f"AHKS over θ, {'÷ mean' if scene.relative else '1/⌀²'}{', dotted at −θ' if scene.reflected else ''}",
            loc="left",
            fontsize=9,
            color=scene.theme.text,
            pad=4,
        )
        low, high = self._limits = _theta_limits(scene)
        axes.set_yscale("linear" if scene.relative else "log")
        axes.set_ylim(low, high)

    def _static_polar(self, scene: CurveScene) -> None:
        axes: Any = self.polar_axes
        labels = ["0°", "45°", "90°", "135°", "", "", "", ""]
        axes.set_thetagrids(range(0, 360, 45), labels)
        axes.tick_params(axis="x", pad=-3)
        axes.set_yticks([1.0])
        axes.set_yticklabels([])
        axes.set_ylim(0, max(1.3, 1.06 * _shown_range(scene)[1]))

    def _static_time(self, scene: CurveScene) -> None:
        axes = self.time_axes
        scale = scene.curves[0].weyl_eigenvalue if scene.curves else 1.0
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlim(REACH_MIN / scale, REACH_MAX / scale)
        axes.set_xlabel("time t in ⌀²", labelpad=1)
        axes.set_title("Heat left h(x, x) over t, 1/⌀²", loc="left", fontsize=9, color=scene.theme.text, pad=4)
        values = [row for each in scene.shown for row in (each.values, each.isotropic) if row is not None]
        if values:
            axes.set_ylim(0.6 * min(v.min() for v in values), 1.6 * max(v.max() for v in values))

    def fits(self, scene: CurveScene) -> bool:
        """Whether the drawn axes still suit the curves: none is cut, and they fill a good part of the plot."""
        low, high = _theta_limits(scene)
        drawn = self._limits[1] - self._limits[0]
        inside = low >= self._limits[0] - 1e-9 and high <= self._limits[1] + 1e-9
        return not scene.relative or not scene.shown or (inside and high - low >= 0.5 * drawn)

    # -- what moves ---------------------------------------------------------------------------------------------------

    def moving_artists(self, scene: CurveScene) -> list[tuple[Axes, Artist]]:
        """Curves and crosshairs, not yet part of the axes' lists when they are only blitted."""
        artists: list[tuple[Axes, Artist]] = []
        for curves in scene.shown:
            artists += self._theta_lines(scene, curves)
            artists += self._time_lines(scene, curves)
        artists += self._crosshairs(scene)
        return artists

    def _theta_lines(self, scene: CurveScene, curves: AutodiffusionCurves) -> list[tuple[Axes, Artist]]:
        colour, style = MARKERS[curves.pick.slot], ":" if curves.pick.is_mirror else "-"
        lines: list[tuple[Axes, Artist]] = []
        faded = 0.55 if scene.theme.name == "light" else 0.8  # thin lines sink into a dark ground
        looks = {1.0: (2.0, 1.0)} | {factor: (width, faded) for factor, width, _ in OTHER_TIMES}
        for factor in _factors(scene):
            width, alpha = looks[factor]
            values = over_theta(curves, scene.reach * factor)
            look = {"color": colour, "ls": style, "lw": width, "alpha": alpha, "animated": True}
            if factor > 1:
                look["dashes"], look["ls"] = (4, 2), "--"
            if scene.reflected and curves.pick.is_mirror:
                values = read_backwards(curves.thetas, values)
            angles, shares = once_around(curves, values / values.mean())
            shown = shares if scene.relative else once_around(curves, values)[1]
            wrapped = np.degrees(np.concatenate([angles - np.pi, angles]))
            lines += self._line(self.theta_axes, wrapped, np.tile(shown, 2), look)
            lines += self._line(self.polar_axes, np.append(angles, angles + np.pi), np.tile(shares, 2), look)
        return lines

    def _time_lines(self, scene: CurveScene, curves: AutodiffusionCurves) -> list[tuple[Axes, Artist]]:
        colour, style = MARKERS[curves.pick.slot], ":" if curves.pick.is_mirror else "-"
        look = {"color": colour, "ls": style, "lw": 2.0, "animated": True}
        lines = self._line(self.time_axes, curves.times, over_time(curves, scene.theta), look)
        if curves.isotropic is not None:
            look = {"color": colour, "ls": style, "lw": 1.0, "alpha": 0.7, "animated": True}
            lines += self._line(self.time_axes, curves.times, curves.isotropic, look)
        return lines

    def _crosshairs(self, scene: CurveScene) -> list[tuple[Axes, Artist]]:
        hue = tuple(theta_colour(scene.theta))
        look = {"color": hue, "lw": 1.6, "animated": True}
        low, high = self.theta_axes.get_ylim()
        degrees = float(np.degrees(scene.theta))
        lines = self._line(self.theta_axes, [degrees, degrees], [low, high], look)
        radius = self.polar_axes.get_ylim()[1]
        lines += self._line(self.polar_axes, [scene.theta, 0, scene.theta + np.pi], [radius, 0, radius], look)
        if scene.curves:
            time = scene.reach / scene.curves[0].weyl_eigenvalue
            low, high = self.time_axes.get_ylim()
            look = {"color": scene.theme.muted, "lw": 1.2, "animated": True}
            lines += self._line(self.time_axes, [time, time], [low, high], look)
        return lines

    @staticmethod
    def _line(axes: Axes, x: object, y: object, look: dict[str, object]) -> list[tuple[Axes, Artist]]:
        from matplotlib.lines import Line2D

        line = Line2D(x, y, **look)  # type: ignore[arg-type]
        line.set_transform(axes.transData)
        line.set_clip_path(axes.patch)
        line.axes = None
        return [(axes, line)]


def _style(axes: Axes, theme: Theme) -> None:
    axes.set_facecolor(theme.panel)
    axes.tick_params(colors=theme.muted, labelsize=8, length=3, width=0.8)
    axes.tick_params(which="minor", length=0)
    axes.grid(True, color=theme.grid, linewidth=0.8)
    for spine in axes.spines.values():
        spine.set_color(theme.line)
    axes.xaxis.label.set(color=theme.muted, size=8)
    axes.yaxis.label.set(color=theme.muted, size=8)


def _factors(scene: CurveScene) -> tuple[float, ...]:
    """Which multiples of the shown time are drawn: with many points only itself."""
    others = tuple(factor for factor, _, _ in OTHER_TIMES) if len(scene.shown) <= 2 else ()
    return tuple(factor for factor in (1.0, *others) if REACH_MIN <= scene.reach * factor <= REACH_MAX)


def _shown_range(scene: CurveScene) -> tuple[float, float]:
    """Least and greatest of what is drawn, each curve divided by its mean."""
    lines = [(each, over_theta(each, scene.reach * factor)) for each in scene.shown for factor in _factors(scene)]
    shares = [once_around(each, line / line.mean())[1] for each, line in lines]
    return (min(s.min() for s in shares), max(s.max() for s in shares)) if shares else (0.5, 1.5)


def _theta_limits(scene: CurveScene) -> tuple[float, float]:
    if scene.relative:
        low, high = _shown_range(scene)
        gap = 0.08 * max(high - low, 0.1)
        return max(0.0, low - gap), high + gap
    if not scene.shown:
        return 0.1, 10.0
    return 0.7 * min(each.values.min() for each in scene.shown), 1.4 * max(each.values.max() for each in scene.shown)
