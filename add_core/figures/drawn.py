"""A figure that is ready to be saved, and what has to be said about it."""

from __future__ import annotations

from dataclasses import dataclass, field

from matplotlib.figure import Figure


class NotDrawn(Exception):
    """A figure cannot be drawn here; the message says what is missing and what to do."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """caption : what is shown, with the numbers that were used. missing : what had to be left out and why, a line each.
    tables : CSV text by the ending of its file's name, the numbers behind curves.
    """

    figure: Figure
    caption: str
    missing: tuple[str, ...] = ()
    tables: dict[str, str] = field(default_factory=dict)
