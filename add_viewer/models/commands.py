"""What the command palette offers: things to do, ordered by how well they answer what was typed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from .searching import match_score

RECENT_LIMIT = 8
_HELP_COUNTS = 0.4
"""A word found only in the sentence of help counts less than one found in the title."""

_NOT_NOW = 25.0
"""What a command loses that cannot be done now: it is found, but behind its equals."""


@dataclass(frozen=True, eq=False)
class Command:
    """One thing to do.

    name : what it is remembered by. section : where it is found otherwise, e.g. "View". key : its shortcut, "" if none.
    enabled : whether it can be done now. checked : for switches, None for everything else.
    on_search : offered only once something is typed, as there are many of its kind.
    """

    name: str
    title: str
    section: str
    do: Callable[[], object]
    key: str = ""
    help: str = ""
    enabled: bool = True
    checked: bool | None = None
    on_search: bool = False


def find(commands: Sequence[Command], query: str, recent: Sequence[str] = ()) -> list[Command]:
    """Those that answer `query`, best first; without a query all but the many, the recent ones first.

    What cannot be done now comes behind what answers about as well.
    """
    if not query.strip():
        offered = [command for command in commands if not command.on_search or command.name in recent]
        return sorted(offered, key=lambda command: (not command.enabled, _age(command, recent)))
    scored = [(score, command) for command in commands if (score := _score(command, query)) is not None]
    ranked = sorted(scored, key=lambda pair: (-pair[0], _age(pair[1], recent)))
    return [command for _, command in ranked]


def remembered(name: str, recent: Iterable[str]) -> list[str]:
    """`recent` with `name` at its head."""
    return [name, *(each for each in recent if each != name)][:RECENT_LIMIT]


def _age(command: Command, recent: Sequence[str]) -> int:
    return recent.index(command.name) if command.name in recent else len(recent)


def _score(command: Command, query: str) -> float | None:
    title = match_score(query, command.title)
    if title is not None:
        return title - (0.0 if command.enabled else _NOT_NOW)
    anywhere = match_score(query, f"{command.section}: {command.title} {command.help}")
    return None if anywhere is None else _HELP_COUNTS * anywhere
