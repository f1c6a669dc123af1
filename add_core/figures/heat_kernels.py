"""Figure 1: what α, θ and t do to a heat kernel, on a mesh and on a cloud."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from .._check import FloatArray
from ..drawing.colours import kernel_map, theta_colour
from ..geometry import PointCloud, TriangleMesh
from .drawn import Drawn
from .page import INK, QUIET, RULE, blank, colour_bar
from .studio import Studio

ALPHA, REACH, DEGREES = 50.0, 0.04, 90
"""What the columns have where they do not say otherwise; reach is t·λ₁."""
WIDE, HIGH, GAP = 0.39, 0.83, 0.1


@dataclass(frozen=True)
class _Column:
    alpha: float
    degrees: float
    reach: float
    label: str


GROUPS: tuple[tuple[str, tuple[_Column, ...]], ...] = (
    ("isotropic", (_Column(0, 0, REACH, "α = 0"),)),
    ("direction θ", tuple(_Column(ALPHA, angle, REACH, f"{angle}°") for angle in (0, 45, 90, 135))),
    ("anisotropy α", tuple(_Column(alpha, DEGREES, REACH, f"{alpha:g}") for alpha in (0.1, 2.0))),
    (
        "time t",
        tuple(_Column(ALPHA, DEGREES, REACH * factor, label) for factor, label in ((0.2, "t/5"), (10.0, "10 t"))),
    ),
)


def draw(studio: Studio) -> Drawn:
    """Kernels at one point of a mesh (top) and of a cloud made from it (bottom)."""
    columns = [column for _, group in GROUPS for column in group]
    studio.expect(2 * len(columns))
    cloud = studio.cloud(studio.cast.hero)[0]
    mesh = studio.person(studio.cast.hero)
    on_cloud = int(np.linalg.norm(cloud.points - mesh.vertices[studio.cast.source], axis=1).argmin())
    figure = Figure(figsize=(11.0, 5.85))
    centres = _centres()
    width = centres[-1] + WIDE / 2
    for shape, source, bottom in ((mesh, studio.cast.source, 2.84), (cloud, on_cloud, 0.5)):
        stage = studio.stage(figure, (0.45, bottom, 10.4, 2.3), studio.camera(8, 5), width=width, height=HIGH)
        for column, centre in zip(columns, centres, strict=True):
            heat = _kernel(studio, shape, source, column)
            stage.stand(shape, (centre, 0.01), positions=heat / heat.max()).mark(source, size=3.5)
            studio.done()
    _write(figure, centres, width)
    return Drawn(figure, _caption(studio, mesh, cloud))


def _kernel(studio: Studio, shape: TriangleMesh | PointCloud, source: int, column: _Column) -> FloatArray:
    flow = studio.flow(shape, column.alpha)
    time = column.reach / flow.laplacian.weyl_eigenvalue(1)
    return np.maximum(flow.kernel(source, theta=float(np.radians(column.degrees)), time=time), 0.0)


def _centres() -> list[float]:
    """Where each column stands, in diameters from the left."""
    centres, x = [], 0.0
    for _, group in GROUPS:
        for _ in group:
            centres.append(x + WIDE / 2)
            x += WIDE
        x += GAP
    return centres


def _write(figure: Figure, centres: list[float], width: float) -> None:
    """Headings above the columns, a word before each row, the colour bar below."""
    axes = blank(figure, (0.45, 5.17, 10.4, 0.66))
    axes.set(xlim=(0, width), ylim=(0, 1))
    at = iter(centres)
    for title, group in GROUPS:
        places = [next(at) for _ in group]
        axes.text(float(np.mean(places)), 0.92, title, ha="center", va="top", fontsize=10, color=INK)
        if len(group) > 1:
            axes.plot([places[0] - 0.15, places[-1] + 0.15], [0.55, 0.55], color=RULE, lw=1.0)
        for x, column in zip(places, group, strict=True):
            colour = tuple(theta_colour(np.radians(column.degrees))) if title.endswith("θ") else INK
            axes.text(x, 0.38, column.label, ha="center", va="top", fontsize=9, color=colour)
    side = blank(figure, (0.0, 0.5, 0.45, 4.6))
    for y, word in ((0.77, "mesh"), (0.27, "points")):
        side.text(0.5, y, word, rotation=90, ha="center", va="center", color=QUIET)
    box = (4.45, 0.26, 2.4, 0.09)
    colour_bar(figure, box, kernel_map(), title="", ends=("no heat", "each kernel's maximum"))


def _caption(studio: Studio, mesh: TriangleMesh, cloud: PointCloud) -> str:
    anisotropic, isotropic = (REACH / studio.flow(mesh, alpha).laplacian.weyl_eigenvalue(1) for alpha in (ALPHA, 0.0))
    return (
        f"Anisotropic heat kernels, eq. (17), of one point of a mesh of {mesh.vertex_count:,} vertices (top) and of "
        f"{cloud.vertex_count:,} of them as a point cloud (bottom). α = {ALPHA:g}, θ = {DEGREES}° and t = "
        f"{anisotropic:.2g} unless a column says otherwise; lengths in geodesic diameters. θ is measured from the "
        "direction of maximum curvature, here around the thigh. Heat runs slower as α grows, so t·λ₁ = "
        f"{REACH:g} (λ₁ by Weyl's law) is held fixed over α: the isotropic kernel is at t = {isotropic:.2g}. Each "
        "kernel is coloured up to its own maximum."
    )
