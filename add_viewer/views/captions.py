"""What is shown, in words that can stand under a figure."""

from __future__ import annotations

from math import degrees

from ..models.diffusion import Diffusion


def describe(diffusion: Diffusion, weyl_eigenvalue: float) -> str:
    """ "α = 50 ⌀ (curvature), θ = 30°, t = 0.628 ⌀²" """
    unit = " ⌀" if diffusion.conductivity == "curvature" else ""
    time = diffusion.reach / weyl_eigenvalue
    angle = f", θ = {degrees(diffusion.theta):.4g}°" if diffusion.alpha > 0 else ""
    return f"α = {diffusion.alpha:.4g}{unit} ({diffusion.conductivity}){angle}, t = {time:.3g} ⌀²"
