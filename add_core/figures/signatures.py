"""Figure 2: anisotropic heat kernel signatures of three points in two poses of one body."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .._check import FloatArray
from ..drawing.colours import MARKERS
from .drawn import Drawn
from .page import QUIET, degrees_of_theta, panel
from .studio import Studio

ALPHA, REACH, ANGLES = 50.0, 0.03, 16
COLOURS = (MARKERS[1], MARKERS[0], MARKERS[2])
"""The paper's red, blue and green, in tones that the colour-blind tell apart."""


def draw(studio: Studio) -> Drawn:
    """Both bodies with the points, and their signatures over θ, solid and dotted."""
    cast, angles = studio.cast, np.pi * np.arange(ANGLES + 1) / ANGLES
    studio.expect(2 + 2 * len(cast.points))
    figure = Figure(figsize=(10.0, 4.4))
    stage = studio.stage(figure, (0.1, 0.15, 5.6, 4.1), studio.camera(18, 5), width=1.05, height=0.83)
    curves: list[list[FloatArray]] = [[], []]
    times = []
    for which, (index, x) in enumerate(((cast.hero, 0.25), (cast.second, 0.78))):
        mesh = studio.person(index)
        standing = stage.stand(mesh, (x * stage.width / 1.05, 0.0))
        studio.done()
        flow = studio.flow(mesh, ALPHA)
        times.append(REACH / flow.laplacian.weyl_eigenvalue(1))
        for vertex, colour in zip(dict(cast.points), COLOURS, strict=True):
            standing.mark(vertex, colour, size=8)
            curves[which].append(flow.autodiffusion(vertex, thetas=angles, times=times[-1])[:, 0])
            studio.done()
    axes = panel(figure, (6.45, 0.6, 2.95, 3.2))
    _curves(axes, np.degrees(angles), curves, [word for _, word in cast.points])
    return Drawn(figure, _caption(studio, times, curves), tables={"csv": _table(studio, angles, curves)})


def _curves(axes: Axes, degrees: FloatArray, curves: list[list[FloatArray]], words: list[str]) -> None:
    for number, (colour, word) in enumerate(zip(COLOURS, words, strict=True)):
        axes.plot(degrees, curves[0][number], color=colour)
        axes.plot(degrees, curves[1][number], color=colour, ls=":", lw=2.0)
        end = curves[0][number][-1]
        axes.annotate(word, (180, end), (5, 0), textcoords="offset points", color=colour, va="center", fontsize=8.5)
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("{x:g}")
    axes.tick_params(axis="y", which="minor", labelsize=7)
    degrees_of_theta(axes)
    axes.set_title("AHKS over θ, in 1/diameter²\n", loc="left")
    axes.text(0.0, 1.03, "solid: left pose, dotted: right pose", transform=axes.transAxes, color=QUIET, fontsize=8)


def _caption(studio: Studio, times: list[float], curves: list[list[FloatArray]]) -> str:
    drift = np.mean([np.abs(np.log(one / two)).mean() for one, two in zip(*curves, strict=True)])
    pairs = [(0, 1), (0, 2), (1, 2)]
    apart = np.mean([np.abs(np.log(curves[0][i] / curves[0][j])).mean() for i, j in pairs])
    names = [studio.cast.collection.names[index] for index in (studio.cast.hero, studio.cast.second)]
    return (
        f"Anisotropic heat kernel signatures at three points of one body in two poses ({names[0]}; {names[1]}): "
        f"α = {ALPHA:g}, L = {ANGLES} angles, t·λ₁ = {REACH:g} (t = {times[0]:.2g} and {times[1]:.2g}). "
        f"Between the poses a signature moves by {np.expm1(drift):.0%} on average, between the points by "
        f"{np.expm1(apart):.0%}."
    )


def _table(studio: Studio, angles: FloatArray, curves: list[list[FloatArray]]) -> str:
    rows = ["vertex,theta_degrees,first_pose,second_pose"]
    for number, vertex in enumerate(dict(studio.cast.points)):
        for angle, one, two in zip(np.degrees(angles), curves[0][number], curves[1][number], strict=True):
            rows.append(f"{vertex},{angle:.6g},{one:.6g},{two:.6g}")
    return "\n".join(rows) + "\n"
