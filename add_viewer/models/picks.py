"""Picked points: which vertex, which of the eight colours, and whose mirror image."""

from __future__ import annotations

from dataclasses import dataclass

PICK_LIMIT = 8


@dataclass(frozen=True)
class Pick:
    """A picked vertex of one shape.

    slot : which of the eight marker colours, the same in every view, curve and export.
    mirror_of : the vertex whose mirror image this is (ring and dotted line), or None (disc and solid line).
    """

    shape: str
    vertex: int
    slot: int
    mirror_of: int | None = None

    @property
    def is_mirror(self) -> bool:
        return self.mirror_of is not None


def free_slot(picks: tuple[Pick, ...]) -> int | None:
    """The first colour that no pick uses; None when all are taken."""
    used = {pick.slot for pick in picks}
    return next((slot for slot in range(PICK_LIMIT) if slot not in used), None)
