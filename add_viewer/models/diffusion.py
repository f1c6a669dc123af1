"""How heat runs: the conductivity model, α, θ and how far."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import isfinite, pi
from typing import Any, Literal

Conductivity = Literal["curvature", "constant"]
CONDUCTIVITIES: tuple[Conductivity, ...] = ("curvature", "constant")
ALPHA_MAX = 200.0
REACH_MIN, REACH_MAX = 2e-3, 5.0


@dataclass(frozen=True)
class Diffusion:
    """The parameters of one anisotropic heat kernel.

    conductivity : "curvature", eq. (9), or "constant", eq. (10).
    alpha : degree of anisotropy, 0 to 200; 0 is isotropic.
    theta : radians in [0, π), counter-clockwise about the outward normal from the direction of maximum curvature.
    reach : t·λ₁, time in units of the operator's own scale (λ₁ by Weyl's law), 0.002 (local) to 5 (global).
        Time itself follows: t = reach / λ₁. A larger α slows heat; a constant reach keeps the picture comparable.
    """

    conductivity: Conductivity = "curvature"
    alpha: float = 50.0
    theta: float = 0.0
    reach: float = 0.03

    def with_changes(self, **changes: Any) -> Diffusion:
        """The same with `changes`, brought into range; numbers that are not finite are ignored."""
        kept = {name: value for name, value in changes.items() if isinstance(value, str) or isfinite(value)}
        fitting: dict[str, Any] = {name: _RANGE[name](value) for name, value in kept.items()}
        return replace(self, **fitting)


def _known_conductivity(value: str) -> Conductivity:
    return "constant" if value == "constant" else "curvature"


_RANGE: dict[str, Callable[[Any], Any]] = {
    "conductivity": _known_conductivity,
    "alpha": lambda value: min(max(float(value), 0.0), ALPHA_MAX),
    "theta": lambda value: float(value) % pi,
    "reach": lambda value: min(max(float(value), REACH_MIN), REACH_MAX),
}
