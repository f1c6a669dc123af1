"""Where on its slider a number stands."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log
from typing import Protocol


class Scale(Protocol):
    """A monotone map between a number and a slider position in [0, 1]."""

    def position(self, value: float) -> float:
        """Where `value` stands."""

    def value(self, position: float) -> float:
        """What stands at `position`."""


@dataclass(frozen=True)
class BrokenLine:
    """Linear from 0 to `bend` on the first half and from `bend` to `top` on the second: fine where it matters."""

    bend: float
    top: float

    def position(self, value: float) -> float:
        value = min(max(value, 0.0), self.top)
        return (
            0.5 * value / self.bend if value <= self.bend else 0.5 + 0.5 * (value - self.bend) / (self.top - self.bend)
        )

    def value(self, position: float) -> float:
        position = min(max(position, 0.0), 1.0)
        return 2 * position * self.bend if position <= 0.5 else self.bend + (2 * position - 1) * (self.top - self.bend)


@dataclass(frozen=True)
class Logarithm:
    """Equal ratios take equal room between `low` and `high`, both > 0."""

    low: float
    high: float

    def position(self, value: float) -> float:
        value = min(max(value, self.low), self.high)
        return log(value / self.low) / log(self.high / self.low)

    def value(self, position: float) -> float:
        position = min(max(position, 0.0), 1.0)
        return self.low * exp(position * log(self.high / self.low))
