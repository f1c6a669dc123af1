"""From a heat kernel to what a view draws."""

from __future__ import annotations

from .captions import describe
from .fields import FieldChoice, ShapeField, ValueScale
from .results import KernelField


def heat_field(kernel: KernelField, choice: FieldChoice, kind: str) -> ShapeField:
    """The kernel of one pick in its unit; those of several picks each ÷ its maximum, so that none outshines another.

    kind : "linear" or "log", the colour scale.
    """
    single = len(kernel.picks) == 1
    values = kernel.values if single else kernel.shares
    return ShapeField(
        shape=kernel.shape,
        choice=choice,
        values=values,
        title="Heat kernel h(x, ·)" if single else "Heat kernels h(x, ·)",
        notes=("unit 1/⌀²" if single else "each ÷ its maximum", f"{kind} scale"),
        caption=describe(kernel.diffusion, kernel.diffusion.reach / kernel.time),
        tones="kernel",
        scale=ValueScale.of_kernel(values, kind),
        symbol="h" if single else "h ÷ max",
        unit="/⌀²" if single else "",
    )
