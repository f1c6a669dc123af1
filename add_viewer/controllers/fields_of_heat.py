"""Heat in several directions at once, each in the hue of its angle: the paper's Figure 3."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

from add_core.drawing.colours import SKIN, oklab_to_srgb, srgb_to_oklab, theta_colour

from ..models.diffusion import Diffusion
from ..models.fields import ShapeField
from ..models.picks import Pick
from ..models.shapes import OpenShape
from .field_plans import Place, Plan, Sources
from .operators import OperatorStore

FloatArray = NDArray[np.float64]

PETALS = 4
"""Angles of a rose: 0°, 45°, 90°, 135°."""
_EDGE = 6.0
"""How sharply one petal gives way to the next."""


def rose_plan(place: Place, sources: Sources) -> Plan:
    """Kernels of four angles around the picks; or, named "mirror", those of θ at the picks and of −θ at their mirror
    images.
    """
    picks = place.state.picks_on(place.shape.key) or sources.results.carried.get(place.shape.key, ())
    if not picks:
        return Plan()
    diffusion, shape = place.state.diffusion, place.shape
    mirrored = place.choice.name == "mirror"

    def work() -> ShapeField:
        petals = mirrored_petals(picks, diffusion) if mirrored else rose_petals(picks)
        shares = [_share(shape, diffusion, vertex, theta, sources.operators) for vertex, theta in petals]
        colors = blended(np.stack(shares), np.array([theta for _, theta in petals]))
        return ShapeField(
            shape=shape.key,
            choice=place.choice,
            colors=colors,
            title="Heat by θ and −θ" if mirrored else "Heat in four directions",
            notes=("hue: the angle", "each ÷ its maximum"),
            caption=f"α = {diffusion.alpha:.4g} ({diffusion.conductivity}), t·λ₁ = {diffusion.reach:.3g}",
            tones="angle",
        )

    shown = diffusion if mirrored else diffusion.with_changes(theta=0.0)
    return Plan((place.choice, shape.key, picks, shown), work)


def rose_petals(picks: tuple[Pick, ...]) -> list[tuple[int, float]]:
    """Vertex and angle of every kernel."""
    return [(pick.vertex, pi * number / PETALS) for pick in picks for number in range(PETALS)]


def mirrored_petals(picks: tuple[Pick, ...], diffusion: Diffusion) -> list[tuple[int, float]]:
    """θ at the points themselves, −θ at their mirror images: f_θ∘η = f_−θ."""
    return [(pick.vertex, (-diffusion.theta if pick.is_mirror else diffusion.theta) % pi) for pick in picks]


def _share(shape: OpenShape, diffusion: Diffusion, vertex: int, theta: float, operators: OperatorStore) -> FloatArray:
    flow = operators.flow(shape, diffusion.conductivity, diffusion.alpha, "rose")
    laplacian = operators.laplacian(shape, diffusion.conductivity, diffusion.alpha)
    values = flow.kernel(vertex, theta=theta, time=diffusion.reach / laplacian.weyl_eigenvalue(1))
    return np.clip(values / max(float(values.max()), np.finfo(np.float64).tiny), 0.0, 1.0)


def blended(shares: FloatArray, thetas: FloatArray) -> FloatArray:
    """(n, 3) sRGB: bare skin where no kernel (P, n) reaches, the hue of the angle (P,) whose kernel is largest."""
    weights = shares**_EDGE
    total = weights.sum(axis=0)
    hues = srgb_to_oklab(theta_colour(thetas))
    hue = weights.T @ hues / np.maximum(total, np.finfo(np.float64).tiny)[:, None]
    amount = np.sqrt(shares.max(axis=0))[:, None]
    return oklab_to_srgb((1.0 - amount) * srgb_to_oklab(SKIN) + amount * hue)
