"""How controllers hand over work: tasks give them a function of this form, tests one that answers at once or late."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any, Protocol

from add_core.errors import AddError

_log = logging.getLogger(__name__)


class Run(Protocol):
    """Does `work` somewhere and calls `done` or `failed` in the window's thread."""

    def __call__(
        self,
        lane: str,
        work: Callable[[], Any],
        *,
        done: Callable[[Any], None],
        failed: Callable[[BaseException], None],
        queue: bool = False,
    ) -> None: ...


Later = Callable[[Callable[[], None]], None]
"""Calls the newest function it was given once the person pauses."""


def explain(error: BaseException) -> str:
    """An error in one paragraph for the person at the window."""
    if isinstance(error, AddError):
        return str(error)
    if isinstance(error, OSError) and error.strerror:
        where = f" ({error.filename})" if error.filename else ""
        return f"{error.strerror}{where}."
    _log.error("unexpected error", exc_info=error)
    if isinstance(error, MemoryError):
        return "There is not enough memory for this shape. Close other shapes or programs, or simplify the mesh."
    return f"Something unexpected happened: {type(error).__name__}: {error}. Please report it."
