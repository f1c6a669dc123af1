"""From a kernel's values to colour: honest about what the darkest and the lightest tone mean."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class KernelScale:
    """Colour position in [0, 1] of values: 1 at the maximum; 0 at no heat (linear) or `decades` below (log)."""

    kind: str
    top: float
    decades: float = 2.0

    @classmethod
    def of(cls, values: FloatArray, kind: str) -> KernelScale:
        top = float(values.max()) if values.size else 1.0
        return cls(kind, top if top > 0 else 1.0)

    def position(self, values: FloatArray) -> FloatArray:
        """(n,) in [0, 1]."""
        share = np.clip(values / self.top, 0.0, 1.0)
        if self.kind == "linear":
            return share
        low = 10.0**-self.decades
        scaled: FloatArray = 1.0 + np.log10(np.maximum(share, low)) / self.decades
        return scaled

    def ticks(self) -> list[tuple[float, str]]:
        """Positions and labels for a colour bar."""
        if self.kind == "linear":
            return [(share, _number(share * self.top)) for share in (0.0, 0.5, 1.0)]
        steps = range(int(self.decades) + 1)
        labels = [_number(self.top * 10.0 ** (step - self.decades)) for step in steps]
        labels[0] = "≤ " + labels[0]
        return [(step / self.decades, label) for step, label in zip(steps, labels, strict=True)]


def _number(value: float) -> str:
    """Two significant digits, as a person would write them: 170, 0.091, 3.2e-05."""
    rounded = float(f"{value:.1e}")
    return f"{rounded:g}"
