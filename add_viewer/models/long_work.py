"""Between the steps of long work: is anybody still waiting for it, and how far is it?"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from add_core.errors import AddError

Listener = Callable[[int, int], None]
"""Told how many steps of how many are done; it raises to end the work."""

_listener: ContextVar[Listener] = ContextVar("listener", default=lambda done, total: None)


class Interrupted(Exception):
    """Something newer or more urgent waits."""


class Cancelled(AddError):
    """The person does not want to wait for it."""


def go_on(done: int = 0, total: int = 1) -> None:
    """Called between steps. Raises Interrupted or Cancelled if the work should end here."""
    _listener.get()(done, total)


@contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Within, on this thread, `listener` hears from `go_on`."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)
