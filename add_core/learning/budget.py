"""How many steps fit into a time on this machine."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from .._check import positive
from ..io.atomic import write_atomically
from .settings import TrainingSettings

BUDGET = "budget.json"
TRIAL = 16
"""Steps that are taken to learn how long one takes."""
_WARM_UP = 4

Report = Callable[[dict[str, Any]], object]
TryOut = Callable[[TrainingSettings, Path, Report], object]


def within(minutes: float, settings: TrainingSettings, folder: Path, try_out: TryOut) -> TrainingSettings:
    """`settings` with as many steps as take `minutes`, validations included.

    The learning rate falls over all steps, so their number must be known from the start. It is kept in `folder`: a
    training that is gone on with has the same. try_out : trains by settings in a folder with a report, see `fit`.
    """
    positive("minutes", minutes)
    kept = folder / BUDGET
    if kept.exists():
        found = json.loads(kept.read_text(encoding="utf-8"))
        if found["minutes"] == minutes:
            return replace(settings, steps=found["steps"])
    steps = max(settings.validate_every, round(60 * minutes / _seconds_per_step(settings, try_out)))
    folder.mkdir(parents=True, exist_ok=True)
    write_atomically(kept, json.dumps({"minutes": minutes, "steps": steps}).encode())
    return replace(settings, steps=steps)


def _seconds_per_step(settings: TrainingSettings, try_out: TryOut) -> float:
    """The last step of a trial ends with a validation, whose time is shared out among the steps between two of them."""
    moments: list[float] = []

    def note(event: dict[str, Any]) -> None:
        if event["event"] == "step":
            moments.append(time.perf_counter())

    with TemporaryDirectory() as scratch:
        try_out(replace(settings, steps=TRIAL, patience=0), Path(scratch), note)
    durations = np.diff(moments)
    step = float(np.median(durations[_WARM_UP:-1]))
    return step + max(float(durations[-1]) - step, 0.0) / settings.validate_every
