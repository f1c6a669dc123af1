"""What is shown and what to do next, in words."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING

from .diffusion import Diffusion

if TYPE_CHECKING:
    from .session import SessionState

_INVITATIONS = {
    "heat": "Click the body to drop heat on it",
    "rose": "Click the body to drop heat on it",
    "kernel": "Click the body to see the kernel there",
    "distance": "Click a point to see what resembles it",
}


def describe(diffusion: Diffusion, weyl_eigenvalue: float) -> str:
    """ "α = 50 ⌀ (curvature), θ = 30°, t = 0.628 ⌀²" """
    unit = " ⌀" if diffusion.conductivity == "curvature" else ""
    time = diffusion.reach / weyl_eigenvalue
    angle = f", θ = {degrees(diffusion.theta):.4g}°" if diffusion.alpha > 0 else ""
    return f"α = {diffusion.alpha:.4g}{unit} ({diffusion.conductivity}){angle}, t = {time:.3g} ⌀²"


def invitation(state: SessionState) -> str:
    """What to do next where nothing is picked yet, "" where nothing is missing."""
    return "" if state.active is None or state.active_picks else _INVITATIONS.get(state.field.kind, "")
