"""Ending a command from outside: in order, and a training without losing a step."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Report = Callable[[dict[str, Any]], object]


@contextmanager
def ending_in_order() -> Iterator[None]:
    """Within, SIGTERM ends a command as Ctrl+C does: what it keeps on disk while it works goes with it."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def interrupt(_number: int, _frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextmanager
def stoppable(report: Report) -> Iterator[Report]:
    """Passes events on to `report`; after SIGTERM the training is told to write a checkpoint and stop.

    While inputs are still prepared it stops at once: each finished shape is on disk already.
    """
    is_training = is_asked = False

    def ask(_number: int, _frame: object) -> None:
        nonlocal is_asked
        is_asked = True
        if not is_training:
            raise KeyboardInterrupt

    def passed_on(event: dict[str, Any]) -> object:
        nonlocal is_training
        is_training = event["event"] in ("step", "validation")
        answer = report(event)
        return False if is_asked else answer

    if threading.current_thread() is not threading.main_thread():  # which alone may receive signals
        yield report
        return
    before = signal.signal(signal.SIGTERM, ask)
    try:
        yield passed_on
    finally:
        signal.signal(signal.SIGTERM, before)
