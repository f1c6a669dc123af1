"""What a training told about itself: its loss at every step, and how well it does on shapes that it does not see."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

SCORES = {"auc": "AUC", "cmc1": "CMC@1", "right_side": "P(right side)"}
"""Scores between 0 and 1, as the command and as people call them."""

SCORE_HELP = (
    "On shapes that the training does not see: AUC, how well true pairs of points are told from false ones; CMC@1, how "
    "often the nearest of 1,000 points is the true one; P(right side), how often a point is nearer to its counterpart "
    "than to that one's mirror image (a half is chance)."
)


@dataclass(frozen=True)
class Validation:
    """Scores after a step; right_side is None without a known symmetry."""

    step: int
    loss: float
    auc: float
    cmc1: float
    cmc10: float
    right_side: float | None


@dataclass
class TrainingCurves:
    """Grows with every event. steps, losses : of each mini-batch. total : steps in all, 0 while unknown."""

    steps: list[int] = field(default_factory=list)
    losses: list[float] = field(default_factory=list)
    validations: list[Validation] = field(default_factory=list)
    total: int = 0

    def hear(self, event: dict[str, Any]) -> bool:
        """Take in what the command said; whether it changes a curve."""
        if event["event"] == "step":
            self._go_back_to(event["step"])
            self.steps.append(event["step"])
            self.losses.append(event["loss"])
            self.total = event["steps"]
        elif event["event"] == "validation":
            scores = {name: event[name] for name in ("step", "loss", "auc", "cmc1", "cmc10", "right_side")}
            known = [validation.step for validation in self.validations]
            del self.validations[bisect_left(known, event["step"]) :]
            self.validations.append(Validation(**scores))
        else:
            return False
        return True

    def _go_back_to(self, step: int) -> None:
        """A training that goes on from a checkpoint takes some of its steps again."""
        if self.steps and step <= self.steps[-1]:
            place = bisect_left(self.steps, step)
            del self.steps[place:], self.losses[place:]

    @property
    def last_step(self) -> int:
        return self.steps[-1] if self.steps else 0

    @property
    def latest(self) -> Validation | None:
        return self.validations[-1] if self.validations else None

    @property
    def best(self) -> Validation | None:
        """The validation whose weights the model has: the highest CMC@1."""
        known = [each for each in self.validations if isfinite(each.cmc1)]
        return max(known, key=lambda each: each.cmc1) if known else None


def binned(steps: list[int], values: list[float], count: int) -> tuple[list[float], list[float]]:
    """Means of at most `count` neighbouring groups: what a plot of that many pixels can show."""
    size = max(-(-len(steps) // count), 1)
    groups = range(0, len(steps), size)
    middles = [sum(steps[start : start + size]) / len(steps[start : start + size]) for start in groups]
    means = [sum(values[start : start + size]) / len(values[start : start + size]) for start in groups]
    return middles, means
