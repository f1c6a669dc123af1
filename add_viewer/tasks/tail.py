"""Reading what a process appends to a file, a little at a time."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

MOST_AT_ONCE = 1 << 16
"""Bytes read at a time: a millisecond or two of the window's time."""


class Tail:
    """The complete lines of a growing file, each once.

    old : bytes that were there when the reading began.
    """

    def __init__(self, path: Path) -> None:
        self._path, self._place, self._rest = path, 0, b""
        self.old = path.stat().st_size if path.exists() else 0

    @property
    def is_old(self) -> bool:
        """Whether the next lines were written before the reading began."""
        return self._place < self.old

    def lines(self) -> list[str]:
        """The next lines; none if there is nothing new."""
        try:
            with self._path.open("rb") as file:
                file.seek(self._place)
                data = file.read(MOST_AT_ONCE)
        except OSError:
            return []
        self._place += len(data)
        *complete, self._rest = (self._rest + data).split(b"\n")
        return [line.decode("utf-8", errors="replace") for line in complete]

    @property
    def has_more(self) -> bool:
        """Whether bytes wait that have not been read."""
        try:
            return self._path.stat().st_size > self._place
        except OSError:
            return False


def event_of(line: str) -> dict[str, Any] | None:
    """The event that a line holds, None if it is text."""
    if not line.startswith("{"):
        return None
    try:
        found = json.loads(line)
    except ValueError:
        return None
    return found if isinstance(found, dict) and "event" in found else None
