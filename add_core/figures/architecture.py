"""Figure 4: the way from spectra to a descriptor, with a trained network's own filters and responses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, Polygon, Rectangle

from .._check import FloatArray
from ..contest.describing import why_not
from ..descriptors import wave_kernel_energies, wave_kernel_signature
from ..drawing.colour_maps import sequential_map, signed_map
from ..drawing.colours import MARKERS, theta_colour
from ..evaluation.baselines import isotropic
from ..evaluation.samples import sample
from ..geometry import TriangleMesh
from ..spectra import SpectralFamily
from .drawn import Drawn
from .methods import method
from .page import QUIET, RULE, blank, panel
from .stage import Stage
from .studio import Studio

ROWS, FILTERS = 3, 3
EIGENFUNCTION = 7
"""Which φ_k is drawn at the input."""
BODY = 1.06
"""Height of a body on paper, inches."""
LEVELS = (3.05, 1.82, 0.42)
"""Inches from below, of the feet in each row; the last is θ_L."""


@dataclass(frozen=True, eq=False)
class _Network:
    """What is drawn: filters (FILTERS, p) over a share (p,) of the spectrum, responses (n, ROWS, FILTERS) at the
    angles (ROWS,), and the descriptor (Q,) at one vertex, or None.
    """

    title: str
    share: FloatArray
    filters: FloatArray
    responses: FloatArray
    thetas: FloatArray
    family: SpectralFamily
    channels: tuple[int, ...]
    descriptor: FloatArray | None
    count: int


def draw(studio: Studio) -> Drawn:
    """Input spectra, filters, responses, stacking and the fully connected layer, left to right."""
    studio.expect(1 + ROWS * (1 + FILTERS))
    mesh = studio.person(studio.cast.hero)
    names = [name for name in studio.cast.learned if why_not(name) is None]
    missing = tuple(f"{method(name).title}: {why_not(name)}" for name in studio.cast.learned if name not in names)
    network = _trained(mesh, names[0], studio.cast.source) if names else _band_pass(studio, mesh)
    studio.done()
    figure = Figure(figsize=(11.0, 4.9))
    whole = blank(figure, (0, 0, 11.0, 4.9))
    whole.set(xlim=(0, 11.0), ylim=(0, 4.9))
    _inputs(studio, figure, whole, mesh, network)
    _filters(panel(figure, (2.05, 1.5, 1.75, 1.8)), network)
    _responses(studio, figure, whole, mesh, network)
    _reduction(whole, network)
    _headings(whole, network)
    return Drawn(figure, _caption(network), missing)


def _trained(mesh: TriangleMesh, name: str, vertex: int) -> _Network:
    """The first layer of a trained network on this shape."""
    from ..learning import load_model
    from ..learning.inputs import Moments

    model = load_model(name)
    family = model.recipe.spectra(mesh)
    inputs = model.recipe.inputs(family)
    moments = Moments.of(inputs, family.mass) if model.standardisation == "shape" else model.moments
    first = model.network.layers[0]
    weight = first.weight.detach().numpy().astype(np.float64)
    offset = 0.0 if first.linear.bias is None else first.linear.bias.detach().numpy().astype(np.float64)
    channels = _three(np.flatnonzero(family.alphas == family.alphas.max()))
    given = moments.standardise(inputs)[:, list(channels)].astype(np.float64)
    responses = np.maximum(given @ weight.T + offset, 0.0)  # (n, ROWS, filters)
    chosen = _different(weight, responses)
    smooth = np.array([np.convolve(row, np.hanning(9) / np.hanning(9).sum(), mode="same") for row in weight[chosen]])
    return _Network(
        f"ASF{len(weight)} of the trained {model.network.architecture.name}",
        np.linspace(0, 1, weight.shape[1]),
        smooth,
        responses[:, :, chosen],
        family.thetas[list(channels)],
        family,
        channels,
        model.describe_inputs(inputs, family.mass, mesh)[vertex],
        len(family),
    )


def _band_pass(studio: Studio, mesh: TriangleMesh) -> _Network:
    """Without a trained network: the band-pass filters of WKS, which an ASF layer can be set to."""
    family = studio.describer.spectra(sample(studio.cast.collection, studio.cast.hero))
    channels = _three(np.flatnonzero(family.alphas > 0))
    chosen = wave_kernel_energies(isotropic(family), FILTERS + 2)
    energies = chosen.energies[1:-1]
    share = np.linspace(0, 1, 100)
    log_value = np.log(np.maximum(share, 1e-3) * family.eigenvalues[0, -1])
    filters = np.exp(-((energies[:, None] - log_value) ** 2) / (2 * chosen.width**2))
    responses = np.stack([wave_kernel_signature(family[c], energies, width=chosen.width) for c in channels], axis=1)
    thetas = family.thetas[list(channels)]
    return _Network("band-pass filters", share, filters, responses, thetas, family, channels, None, len(family))


def _three(channels: np.ndarray) -> tuple[int, ...]:
    """The first, the second and the last."""
    return tuple(int(channels[min(k, len(channels) - 1)]) for k in (0, 1, len(channels) - 1))


def _different(weight: FloatArray, responses: FloatArray) -> list[int]:
    """Filters that answer to many points, low, middle and high in the spectrum."""
    place = np.abs(weight) @ np.linspace(0, 1, weight.shape[1]) / np.maximum(np.abs(weight).sum(axis=1), 1e-12)
    spread = responses.std(axis=(0, 1)) * (np.mean(responses > 0, axis=(0, 1)) > 0.2)
    bands = np.array_split(np.argsort(place), FILTERS)
    return [int(band[spread[band].argmax()]) for band in bands]


def _inputs(studio: Studio, figure: Figure, whole: Axes, mesh: TriangleMesh, network: _Network) -> None:
    stage = _column(studio, figure, 0.75, mesh)
    for row, channel in enumerate(network.channels):
        values = np.asarray(network.family[channel].eigenfunctions[:, EIGENFUNCTION], dtype=np.float64)
        limit = np.abs(values).max()
        feet = LEVELS[row] / stage.inches_per_unit
        stage.stand(mesh, (0.5 * stage.width, feet), positions=0.5 + 0.5 * values / limit, colour_map=signed_map())
        hue = tuple(theta_colour(network.thetas[row]))
        name = rf"$\theta_{{{('1', '2', 'L')[row]}}}$"
        whole.text(0.36, LEVELS[row] + 0.5 * BODY, name, ha="center", va="center", fontsize=13, color=hue)
        _arrow(whole, (1.5, LEVELS[row] + 0.55 * BODY), (1.98, 2.4), hue)
        studio.done()
    whole.text(1.1, 1.6, "⋮", ha="center", va="center", fontsize=14, color=QUIET)
    whole.text(1.1, 4.28, r"$\phi_{\alpha\theta k}$", ha="center", fontsize=13)


def _column(studio: Studio, figure: Figure, left: float, mesh: TriangleMesh) -> Stage:
    """A stage as high as the figure, for bodies one above the other."""
    camera = studio.camera(16, 5)
    tall = np.ptp(camera.seen(mesh.vertices)[:, 1])
    height = float(tall * 4.9 / BODY)
    return studio.stage(figure, (left, 0.0, 0.7, 4.9), camera, width=height * 0.7 / 4.9, height=height)


def _filters(axes: Axes, network: _Network) -> None:
    for number, row in enumerate(network.filters):
        level = -1.7 * number
        curve = level + row / np.abs(row).max()
        axes.axhline(level, color=RULE, lw=0.8, zorder=0)
        axes.fill_between(network.share, level, curve, color=MARKERS[number], alpha=0.18, lw=0)
        axes.plot(network.share, curve, color=MARKERS[number], lw=1.5)
    axes.set(xlim=(0, 1), yticks=[])
    axes.set_xticks([0, 1], ["0", r"$\lambda_K$"])
    axes.set_title(r"filters $\tau_m(\lambda)$", loc="left", fontsize=10)
    axes.grid(False)
    axes.spines["left"].set_visible(False)


def _responses(studio: Studio, figure: Figure, whole: Axes, mesh: TriangleMesh, network: _Network) -> None:
    for number in range(FILTERS):
        left = 4.55 + 0.78 * number
        stage = _column(studio, figure, left, mesh)
        limit = np.quantile(network.responses[:, :, number], 0.96)
        for row in range(ROWS):
            values = network.responses[:, row, number] / max(float(limit), 1e-12)
            feet = LEVELS[row] / stage.inches_per_unit
            stage.stand(mesh, (0.5 * stage.width, feet), positions=values, colour_map=sequential_map())
            studio.done()
        whole.text(left + 0.35, 4.28, rf"$\tau_{number + 1}$", ha="center", fontsize=13, color=MARKERS[number])
        whole.text(left + 0.35, 1.6, "⋮", ha="center", va="center", fontsize=14, color=QUIET)
    for row in range(ROWS):
        hue = tuple(theta_colour(network.thetas[row]))
        _arrow(whole, (3.95, 2.4), (4.5, LEVELS[row] + 0.55 * BODY), hue)
        _arrow(whole, (6.92, LEVELS[row] + 0.55 * BODY), (7.32, LEVELS[row] + 0.55 * BODY), hue)


def _reduction(whole: Axes, network: _Network) -> None:
    """ReLU, stacked channels in the hues of their angles, and what comes out."""
    low, high = 0.5, 4.1
    for row in range(ROWS):
        whole.text(7.55, LEVELS[row] + 0.55 * BODY, r"$\xi$", ha="center", va="center", fontsize=15)
        _arrow(whole, (7.74, LEVELS[row] + 0.55 * BODY), (8.12, LEVELS[row] + 0.55 * BODY), QUIET)
    hues = theta_colour(np.pi * np.arange(16) / 16)
    step = (high - low) / 16
    for number, hue in enumerate(hues[::-1]):
        whole.add_patch(Rectangle((8.2, low + number * step), 0.28, step, fc=(*hue, 0.8), ec="white", lw=0.6))
    top, bottom = 3.35, 1.25
    whole.add_patch(Polygon([(8.56, low), (8.56, high), (9.5, top), (9.5, bottom)], fc="#f1f1f2", ec="none"))
    whole.text(9.03, 2.3, "FC", ha="center", va="center", fontsize=11)
    cell = (top - bottom) / 16
    values = np.zeros(16) if network.descriptor is None else network.descriptor / np.abs(network.descriptor).max()
    shades = signed_map()[np.round(127.5 + 127.5 * values).astype(int)]
    for number, shade in enumerate(shades[:16]):
        whole.add_patch(Rectangle((9.58, top - (number + 1) * cell), 0.28, cell, fc=tuple(shade), ec="white", lw=0.6))
    whole.text(9.98, 2.3, r"$\mathbf{f}(x)\in\mathbb{R}^{16}$", ha="left", va="center", fontsize=13)


def _headings(whole: Axes, network: _Network) -> None:
    for left, right, word in ((0.3, 6.9, "spectral filtering"), (7.35, 10.7, "dimensionality reduction")):
        whole.plot([left, right], [4.62, 4.62], color=RULE, lw=1.0)
        whole.text((left + right) / 2, 4.66, word, ha="center", va="bottom", fontsize=10)
    for x, word in ((1.1, "spectra"), (2.93, "ASF"), (5.7, "directed responses"), (7.55, "ReLU"), (8.34, "SC")):
        whole.text(x, 0.08, word, ha="center", va="bottom", fontsize=9, color=QUIET)
    whole.text(9.72, 0.08, "FC16", ha="center", va="bottom", fontsize=9, color=QUIET)
    whole.text(2.93, 1.15, "shared by\nall directions", ha="center", va="top", fontsize=8, color=QUIET)


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], colour: object) -> None:
    arrow = FancyArrowPatch(start, end, arrowstyle="-|>", mutation_scale=9, color=colour, lw=1.1, shrinkA=0, shrinkB=0)
    axes.add_patch(arrow)


def _caption(network: _Network) -> str:
    ends = (
        "weights over the share of the spectrum, smoothed; they act on logarithms of geometry vectors"
        if network.descriptor is not None
        else "set by hand, as an ASF layer could learn them; no trained network was at hand"
    )
    return (
        f"From spectra to a descriptor. Left: one eigenfunction (k = {EIGENFUNCTION}) of the anisotropic Laplacian at "
        f"θ_1, θ_2 and θ_L. Then three filters, {network.title}: {ends}. Their responses at every point, one row a "
        f"direction, negative ones cut by ReLU (ξ); all {network.count} channels are stacked (SC) and taken to 16 "
        "numbers by fully connected layers, here the descriptor of the point that is marked in Figure 1."
    )
