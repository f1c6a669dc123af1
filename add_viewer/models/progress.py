"""How far a command is and how long it will take, from what it says."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

WINDOW = 30.0
"""Seconds of the past by which the speed is judged."""
_FIRST_GUESS = 1.0


@dataclass(frozen=True)
class Progress:
    """done of total steps; phase : what the steps are of; words : for people."""

    phase: str
    done: int
    total: int
    words: str


def progress_of(event: dict[str, Any]) -> Progress | None:
    """What one line of a command says about its progress, None if nothing."""
    kind = event.get("event")
    if kind == "progress":
        return Progress(str(event.get("label", "")), event["done"], event["total"], str(event.get("label", "")))
    if kind == "prepare":
        done, total = event["done"], event["total"]
        return Progress("inputs", done, total, f"Computing inputs, shape {min(done + 1, total)} of {total}")
    if kind == "step":
        words = f"Training, step {event['step']:,} of {event['steps']:,}"
        return Progress("training", event["step"], event["steps"], words)
    return None


class Pace:
    """Estimates the time that a phase still takes from its latest speed."""

    def __init__(self) -> None:
        self._phase = ""
        self._seen: deque[tuple[float, int]] = deque()

    def seconds_left(self, progress: Progress, now: float) -> float | None:
        """Seconds until `progress` is complete, seen at the time `now`; None until the speed is known."""
        if progress.phase != self._phase or (self._seen and progress.done < self._seen[-1][1]):
            self._phase = progress.phase
            self._seen.clear()
        if not self._seen or progress.done > self._seen[-1][1]:
            self._seen.append((now, progress.done))
        while len(self._seen) > 2 and now - self._seen[1][0] > WINDOW:
            self._seen.popleft()
        (start, first), (last, done) = self._seen[0], self._seen[-1]
        if last - start < _FIRST_GUESS:
            return None
        per_step = (last - start) / (done - first)
        return max((progress.total - done) * per_step - (now - last), 0.0)
