"""Figure 3: two mirror points. HKS cannot tell them apart; AHKS reads the one as the other backwards."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from .._check import FloatArray, IntArray
from ..drawing.colours import MARKERS, SKIN, oklab_to_srgb, srgb_to_oklab, theta_colour
from ..drawing.level_lines import level_lines, seen_faces
from ..errors import ParameterError
from ..geometry import TriangleMesh
from .drawn import Drawn
from .page import INK, QUIET, degrees_of_theta, fade, panel
from .stage import Standing
from .studio import Studio

ALPHA, REACH = 50.0, 0.008
LEVEL = 0.3
"""Of its maximum, where the line around a kernel runs."""
RAYS = 4
"""Kernels drawn at each point."""


def draw(studio: Studio) -> Drawn:
    """Kernels of several θ at two mirror points, and the curves of both signatures."""
    cast = studio.cast
    if cast.collection.symmetry is None:
        raise ParameterError(f"{cast.collection.title} has no mirror map, so Figure 3 cannot be drawn of it.")
    mesh = studio.person(cast.hero)
    pair = (cast.source, int(cast.collection.symmetry[cast.source]))
    studio.expect(2 * RAYS + 5)
    figure = Figure(figsize=(9.6, 5.2))
    _body(studio, figure, mesh, pair)
    angles = np.pi * np.arange(2 * studio.quality.angles + 1) / (2 * studio.quality.angles)
    times = np.geomspace(2e-3, 5.0, 40)
    isotropic, directed = studio.flow(mesh, 0.0), studio.flow(mesh, ALPHA)
    scale, time = isotropic.laplacian.weyl_eigenvalue(1), REACH / directed.laplacian.weyl_eigenvalue(1)
    hks, ahks = [], []
    for vertex in pair:
        hks.append(isotropic.autodiffusion(vertex, thetas=0.0, times=times / scale)[0])
        studio.done()
        ahks.append(directed.autodiffusion(vertex, thetas=angles, times=time)[:, 0])
        studio.done()
    _hks_curves(panel(figure, (5.75, 3.15, 3.6, 1.62)), times / scale, hks)
    _ahks_curves(panel(figure, (5.75, 0.6, 3.6, 1.62)), np.degrees(angles), ahks)
    return Drawn(figure, _caption(time, pair, hks, ahks), tables={"csv": _table(times / scale, hks, angles, ahks)})


def _body(studio: Studio, figure: Figure, mesh: TriangleMesh, pair: tuple[int, int]) -> None:
    """The lower body, close enough to see the kernels."""
    camera = studio.camera(0, 4)
    stage = studio.stage(figure, (0.1, 0.1, 4.9, 5.0), camera, width=0.42, height=0.43)
    kernels = {vertex: _kernels(studio, mesh, vertex) for vertex in pair}
    strength = np.max([np.max(list(found.values()), axis=0) for found in kernels.values()], axis=0)
    standing = stage.stand(mesh, (0.5 * stage.width, -0.14), colours=_rose(kernels, strength))
    faces = seen_faces(mesh, camera)
    for position, (vertex, found) in enumerate(kernels.items()):
        for theta, heat in found.items():
            _outline(standing, mesh, heat, faces, theta)
        standing.mark(vertex, MARKERS[0], size=7, ring=position == 1)
    fade(stage.axes)
    _name_angles(figure)


def _kernels(studio: Studio, mesh: TriangleMesh, vertex: int) -> dict[float, FloatArray]:
    """Kernels (n,) ÷ their maxima by θ."""
    flow = studio.flow(mesh, ALPHA)
    time = REACH / flow.laplacian.weyl_eigenvalue(1)
    found = {}
    for theta in np.pi * np.arange(RAYS) / RAYS:
        heat = np.maximum(flow.kernel(vertex, theta=float(theta), time=time), 0.0)
        found[float(theta)] = heat / heat.max()
        studio.done()
    return found


def _rose(kernels: dict[int, dict[float, FloatArray]], strength: FloatArray) -> FloatArray:
    """Colours (n, 3): the hue of the kernel that reaches farthest there, fading into skin."""
    lab = np.zeros((len(strength), 3))
    total = np.zeros(len(strength))
    for found in kernels.values():
        for theta, heat in found.items():
            weight = heat**4
            lab += weight[:, None] * srgb_to_oklab(theta_colour(theta))
            total += weight
    hue = lab / np.maximum(total, 1e-12)[:, None]
    share = np.clip(strength / LEVEL, 0.0, 1.0)[:, None] ** 1.5 * 0.8
    return oklab_to_srgb((1 - share) * srgb_to_oklab(SKIN) + share * hue)


def _outline(standing: Standing, mesh: TriangleMesh, heat: FloatArray, faces: IntArray, theta: float) -> None:
    segments = standing.seen(level_lines(mesh, heat, LEVEL, faces))
    colour = tuple(0.82 * theta_colour(theta))
    lines = LineCollection(list(segments), colors=[colour], linewidths=1.4, capstyle="round", zorder=5)
    standing.axes.add_collection(lines)


def _name_angles(figure: Figure) -> None:
    axes = panel(figure, (4.35, 0.6, 0.7, 0.7))
    axes.set_axis_off()
    axes.set(xlim=(-1.5, 1.5), ylim=(-1.5, 1.5))
    for theta in np.pi * np.arange(RAYS) / RAYS:
        x, y = np.cos(theta), np.sin(theta)
        axes.plot([-x, x], [-y, y], color=tuple(theta_colour(theta)), lw=2.4)
        axes.text(1.4 * x, 1.4 * y, f"{np.degrees(theta):.0f}°", ha="center", va="center", fontsize=7, color=QUIET)


def _hks_curves(axes: Axes, times: FloatArray, curves: list[FloatArray]) -> None:
    axes.set_title("HKS: both curves coincide", loc="left")
    axes.loglog(times, curves[0], color=MARKERS[0], lw=3.2, alpha=0.55)
    axes.loglog(times, curves[1], color=INK, ls=":", lw=1.6)
    axes.set_xlabel("time t, diameter²")
    axes.set_ylabel("h(x, x), 1/diameter²")


def _ahks_curves(axes: Axes, degrees: FloatArray, curves: list[FloatArray]) -> None:
    axes.set_title("AHKS: one is the other, read backwards", loc="left")
    axes.plot(degrees, curves[0], color=MARKERS[0])
    axes.plot(degrees, curves[1], color=MARKERS[0], ls=":", lw=2.0)
    degrees_of_theta(axes)
    axes.set_ylabel("h(x, x), 1/diameter²")
    axes.set_ylim(0, 1.15 * max(map(np.max, curves)))


def _caption(time: float, pair: tuple[int, int], hks: list[FloatArray], ahks: list[FloatArray]) -> str:
    differ = float(np.max(np.abs(hks[0] / hks[1] - 1)))
    apart = float(np.max(np.abs(ahks[0] / ahks[1] - 1)))
    reflected = float(np.max(np.abs(ahks[0][::-1] / ahks[1] - 1)))
    return (
        f"A point (vertex {pair[0]}, solid) and its mirror image (vertex {pair[1]}, dotted) with their anisotropic "
        f"heat kernels: α = {ALPHA:g}, t = {time:.2g}, lines at {LEVEL:.0%} of each maximum, one hue for each θ. "
        f"Right: over time, HKS differs between the two by at most {differ:.0%}; over θ, AHKS does by up to "
        f"{apart:.0%}. Read backwards, θ → 180° − θ, it differs by at most {reflected:.0%}: f_θ∘η = f_−θ."
    )


def _table(times: FloatArray, hks: list[FloatArray], angles: FloatArray, ahks: list[FloatArray]) -> str:
    rows = ["signature,at,point,mirror_point"]
    rows += [f"hks,{t:.6g},{one:.6g},{two:.6g}" for t, one, two in zip(times, *hks, strict=True)]
    rows += [f"ahks,{np.degrees(a):.6g},{one:.6g},{two:.6g}" for a, one, two in zip(angles, *ahks, strict=True)]
    return "\n".join(rows) + "\n"
