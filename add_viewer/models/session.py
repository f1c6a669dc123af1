"""The session: everything that a person made, as one frozen state that changes announce and undo restores."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from psygnal import Signal

from .diffusion import Diffusion
from .picks import PICK_LIMIT, Pick, free_slot
from .shapes import OpenShape

UNDO_LIMIT = 200


@dataclass(frozen=True)
class SessionState:
    """A snapshot: open shapes, which of them is shown, the diffusion and the picks."""

    shapes: tuple[OpenShape, ...] = ()
    active_key: str | None = None
    diffusion: Diffusion = field(default_factory=Diffusion)
    picks: tuple[Pick, ...] = ()

    @property
    def active(self) -> OpenShape | None:
        return next((shape for shape in self.shapes if shape.key == self.active_key), None)

    @property
    def active_picks(self) -> tuple[Pick, ...]:
        return tuple(pick for pick in self.picks if pick.shape == self.active_key)


class Session:
    """The current `SessionState` with undo. Signals carry nothing: read `state`.

    Changes of one kind that follow each other (a slider being dragged) undo as one step.
    """

    shapes_changed = Signal()
    active_changed = Signal()
    diffusion_changed = Signal()
    picks_changed = Signal()
    history_changed = Signal()

    def __init__(self) -> None:
        self.state = SessionState()
        self._past: list[SessionState] = []
        self._future: list[SessionState] = []
        self._last_kind: str | None = None

    # -- what a person does -------------------------------------------------------------------------------------------

    def add_shape(self, shape: OpenShape) -> None:
        """Open `shape` and show it; a shape with the same key is replaced, and its picks stay where they still fit."""
        others = tuple(each for each in self.state.shapes if each.key != shape.key)
        picks = tuple(p for p in self.state.picks if p.shape != shape.key or p.vertex < shape.vertex_count)
        self._apply("open", replace(self.state, shapes=(*others, shape), active_key=shape.key, picks=picks))

    def close_shape(self, key: str) -> None:
        """Close one shape; the last of those that stay open is shown."""
        left = tuple(shape for shape in self.state.shapes if shape.key != key)
        active = self.state.active_key if self.state.active_key != key else (left[-1].key if left else None)
        picks = tuple(pick for pick in self.state.picks if pick.shape != key)
        self._apply("close", replace(self.state, shapes=left, active_key=active, picks=picks))

    def show_shape(self, key: str) -> None:
        """Show another of the open shapes."""
        if any(shape.key == key for shape in self.state.shapes):
            self._apply("show", replace(self.state, active_key=key))

    def diffuse(self, **changes: Any) -> None:
        """Change α, θ, reach or the conductivity model."""
        diffusion = self.state.diffusion.with_changes(**changes)
        self._apply("diffuse " + " ".join(sorted(changes)), replace(self.state, diffusion=diffusion), coalesce=True)

    def pick(self, vertex: int, *, add: bool = False) -> None:
        """Pick `vertex` of the active shape, instead of the earlier picks or in addition to them."""
        if not self._has_vertex(vertex):
            return
        kept = self.state.active_picks if add else ()
        if any(pick.vertex == vertex for pick in kept) and add:
            return
        slot = free_slot(kept)
        if slot is not None:
            self._set_picks("pick", (*kept, self._new_pick(vertex, slot)))

    def pick_mirror(self, vertex: int) -> None:
        """Pick the mirror image of `vertex`, in the colour of `vertex`, which is picked too if it is not yet."""
        mirror = self.state.active.mirror(vertex) if self.state.active and self._has_vertex(vertex) else None
        if mirror is None:
            return
        kept = self.state.active_picks
        partner = next((pick for pick in kept if pick.vertex == vertex), None)
        slot = partner.slot if partner else free_slot(kept)
        if slot is None or any(pick.vertex == mirror for pick in kept):
            return
        added = () if partner else (self._new_pick(vertex, slot),)
        self._set_picks("pick", (*kept, *added, self._new_pick(mirror, slot, mirror_of=vertex)))

    def unpick(self, vertex: int) -> None:
        """Remove one pick, and its mirror image with it."""
        kept = (p for p in self.state.active_picks if vertex not in (p.vertex, p.mirror_of))
        self._set_picks("unpick", tuple(kept))

    def clear_picks(self) -> None:
        """Remove every pick on the active shape."""
        self._set_picks("clear", ())

    # -- undo ---------------------------------------------------------------------------------------------------------

    @property
    def can_undo(self) -> bool:
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        return bool(self._future)

    def undo(self) -> None:
        """Back to the state before the last change."""
        if self._past:
            self._future.append(self.state)
            self._replace(self._past.pop())

    def redo(self) -> None:
        """Forward again, after undo."""
        if self._future:
            self._past.append(self.state)
            self._replace(self._future.pop())

    def end_gesture(self) -> None:
        """A drag or a typed number is done: the next change undoes on its own."""
        self._last_kind = None

    # -- within -------------------------------------------------------------------------------------------------------

    def _has_vertex(self, vertex: int) -> bool:
        return self.state.active is not None and 0 <= vertex < self.state.active.vertex_count

    def _new_pick(self, vertex: int, slot: int, mirror_of: int | None = None) -> Pick:
        assert self.state.active_key is not None
        return Pick(self.state.active_key, vertex, slot, mirror_of)

    def _set_picks(self, kind: str, picks: tuple[Pick, ...]) -> None:
        others = tuple(pick for pick in self.state.picks if pick.shape != self.state.active_key)
        self._apply(kind, replace(self.state, picks=(*others, *picks[: 2 * PICK_LIMIT])))

    def _apply(self, kind: str, state: SessionState, *, coalesce: bool = False) -> None:
        if state == self.state:
            return
        if not (coalesce and kind == self._last_kind):
            self._past = [*self._past[-UNDO_LIMIT:], self.state]
        self._future.clear()
        self._replace(state)
        self._last_kind = kind

    def _replace(self, state: SessionState) -> None:
        before, self.state, self._last_kind = self.state, state, None
        changes: list[tuple[bool, Callable[[], None]]] = [
            (before.shapes != state.shapes, self.shapes_changed.emit),
            (before.active is not state.active, self.active_changed.emit),
            (before.active_picks != state.active_picks, self.picks_changed.emit),
            (before.diffusion != state.diffusion, self.diffusion_changed.emit),
            (True, self.history_changed.emit),
        ]
        for differs, announce in changes:
            if differs:
                announce()
