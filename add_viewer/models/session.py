"""The session: everything that a person made, as one frozen state that changes announce and undo restores."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from psygnal import Signal

from .arrangement import Arrangement, Layout, ShapeLook
from .diffusion import Diffusion
from .fields import FieldChoice
from .matching import Matching
from .picks import PICK_LIMIT, Pick, free_slot
from .shapes import IntArray, OpenShape

UNDO_LIMIT = 200

_DIFFUSION, _FIELD, _ARRANGEMENT, _MATCHING = Diffusion(), FieldChoice(), Arrangement(), Matching()


@dataclass(frozen=True)
class SessionState:
    """A snapshot.

    shapes : in the order of their views. active_key : the source, the others being targets.
    looks : of the shapes that are drawn otherwise than usual. picks : made by the person, on any shape.
    field : drawn on every shape. compare : the second field of the split view, None without one.
    """

    shapes: tuple[OpenShape, ...] = ()
    active_key: str | None = None
    looks: tuple[ShapeLook, ...] = ()
    diffusion: Diffusion = _DIFFUSION
    picks: tuple[Pick, ...] = ()
    field: FieldChoice = _FIELD
    compare: FieldChoice | None = None
    arrangement: Arrangement = _ARRANGEMENT
    matching: Matching = _MATCHING

    @property
    def active(self) -> OpenShape | None:
        return next((shape for shape in self.shapes if shape.key == self.active_key), None)

    @property
    def active_picks(self) -> tuple[Pick, ...]:
        return self.picks_on(self.active_key)

    def picks_on(self, key: str | None) -> tuple[Pick, ...]:
        """The picks of one shape."""
        return tuple(pick for pick in self.picks if pick.shape == key)

    def shape(self, key: str) -> OpenShape | None:
        """The open shape of that key."""
        return next((shape for shape in self.shapes if shape.key == key), None)

    def look(self, key: str) -> ShapeLook:
        """How the shape of that key is drawn."""
        return next((look for look in self.looks if look.key == key), ShapeLook(key))

    @property
    def shown(self) -> tuple[OpenShape, ...]:
        """The shapes that have a view; the active one always has."""
        if self.arrangement.layout == "single":
            return () if self.active is None else (self.active,)
        return tuple(each for each in self.shapes if each.key == self.active_key or self.look(each.key).visible)

    @property
    def choices(self) -> tuple[FieldChoice, ...]:
        """The field of each panel: one, or two in a split view."""
        return (self.field,) if self.compare is None else (self.field, self.compare)


@dataclass(frozen=True)
class Step:
    """A change that can be undone or done again. kind : what it was, e.g. "pick" or "diffuse theta"."""

    kind: str
    before: SessionState
    after: SessionState


class Session:
    """The current `SessionState` with undo. Signals carry nothing: read `state`.

    Changes of one kind that follow each other (a slider being dragged) undo as one step.
    """

    shapes_changed = Signal()
    active_changed = Signal()
    diffusion_changed = Signal()
    picks_changed = Signal()
    field_changed = Signal()
    arrangement_changed = Signal()
    looks_changed = Signal()
    matching_changed = Signal()
    history_changed = Signal()

    def __init__(self) -> None:
        self.state = SessionState()
        self._past: list[tuple[str, SessionState]] = []  # the kind of a change, and the state that it left
        self._future: list[tuple[str, SessionState]] = []  # and here the state that it leads to
        self._last_kind: str | None = None

    # -- what a person does -------------------------------------------------------------------------------------------

    def add_shape(self, shape: OpenShape) -> None:
        """Open `shape`; a shape with the same key is replaced, and its picks stay where they still fit.

        It becomes the active one, unless it comes to stand beside one with picks: their curves stay in sight, and
        the picks are carried to it.
        """
        stands_beside = self.state.arrangement.layout != "single" and self.state.shape(shape.key) is None
        joins = stands_beside and bool(self.state.active_picks)
        active_key = self.state.active_key if joins else shape.key
        others = tuple(each for each in self.state.shapes if each.key != shape.key)
        picks = tuple(p for p in self.state.picks if p.shape != shape.key or p.vertex < shape.vertex_count)
        self._apply("open", replace(self.state, shapes=(*others, shape), active_key=active_key, picks=picks))

    def close_shape(self, key: str) -> None:
        """Close one shape; the last of those that stay open is shown."""
        left = tuple(shape for shape in self.state.shapes if shape.key != key)
        active = self.state.active_key if self.state.active_key != key else (left[-1].key if left else None)
        picks = tuple(pick for pick in self.state.picks if pick.shape != key)
        looks = tuple(look for look in self.state.looks if look.key != key)
        self._apply("close", replace(self.state, shapes=left, active_key=active, picks=picks, looks=looks))

    def show_shape(self, key: str) -> None:
        """Make another of the open shapes the active one."""
        if self.state.shape(key) is not None:
            self._apply("show", replace(self.state, active_key=key))

    def learn_symmetry(self, key: str, symmetry: IntArray, confidence: float) -> None:
        """Keep the mirror map (n,) that was found for a shape."""
        shapes = tuple(
            replace(each, symmetry=symmetry, symmetry_confidence=confidence) if each.key == key else each
            for each in self.state.shapes
        )
        self._apply("symmetry", replace(self.state, shapes=shapes))

    def move_shape(self, key: str, index: int) -> None:
        """Put a shape at another place among the views."""
        moved = self.state.shape(key)
        if moved is not None:
            others = [shape for shape in self.state.shapes if shape.key != key]
            others.insert(min(max(index, 0), len(others)), moved)
            self._apply("move", replace(self.state, shapes=tuple(others)))

    def set_look(self, key: str, **changes: Any) -> None:
        """Change how one shape is drawn: visible, wireframe, point_size."""
        if self.state.shape(key) is not None:
            look = self.state.look(key).with_changes(**changes)
            others = tuple(each for each in self.state.looks if each.key != key)
            kept = others if look == ShapeLook(key) else (*others, look)
            kind = f"look {key} " + " ".join(sorted(changes))
            self._apply(kind, replace(self.state, looks=kept), coalesce="point_size" in changes)

    def arrange(self, **changes: Any) -> None:
        """Change layout, linked or common_range."""
        self._apply("arrange", replace(self.state, arrangement=self.state.arrangement.with_changes(**changes)))

    def choose_field(self, **changes: Any) -> None:
        """Change what is drawn on every shape."""
        made = self.state.field.with_changes(**changes)
        sliding = set(changes) <= {"saturation", "index"}
        self._apply("field " + " ".join(sorted(changes)), replace(self.state, field=made), coalesce=sliding)

    def saturate(self, percentile: float) -> None:
        """Change where distances saturate, in both panels: side by side, colours must mean the same."""
        state = self.state
        field = state.field.with_changes(saturation=percentile)
        compare = None if state.compare is None else state.compare.with_changes(saturation=percentile)
        self._apply("saturate", replace(state, field=field, compare=compare), coalesce=True)

    def set_scene(
        self,
        *,
        field: FieldChoice,
        compare: FieldChoice | None,
        picks: tuple[Pick, ...] | None = None,
        layout: Layout | None = None,
    ) -> None:
        """Change fields, picks and layout together, as one step of undo; None leaves picks or layout as they are."""
        state = replace(self.state, field=field, compare=compare)
        state = state if picks is None else replace(state, picks=picks)
        arrangement = state.arrangement if layout is None else state.arrangement.with_changes(layout=layout)
        self._apply("scene", replace(state, arrangement=arrangement))

    def choose_comparison(self, choice: FieldChoice | None) -> None:
        """Draw a second field beside the first, or None: the first alone."""
        self._apply("compare", replace(self.state, compare=choice))

    def match(self, **changes: Any) -> None:
        """Change how picks and colours are carried to other shapes."""
        self._apply("match", replace(self.state, matching=self.state.matching.with_changes(**changes)))

    def diffuse(self, **changes: Any) -> None:
        """Change α, θ, reach or the conductivity model."""
        diffusion = self.state.diffusion.with_changes(**changes)
        self._apply("diffuse " + " ".join(sorted(changes)), replace(self.state, diffusion=diffusion), coalesce=True)

    def pick(self, vertex: int, *, add: bool = False, shape: str | None = None) -> None:
        """Pick `vertex` of the active shape, or of `shape`, which becomes the active one.

        It takes the place of all earlier picks, on whatever shape, unless `add` keeps them.
        """
        state = self._with_active(shape)
        if not _has_vertex(state, vertex):
            return
        kept = state.active_picks if add else ()
        if any(pick.vertex == vertex for pick in kept):
            return
        slot = free_slot(kept)
        if slot is not None:
            state = state if add else replace(state, picks=())
            self._set_picks("pick", state, (*kept, _new_pick(state, vertex, slot)))

    def pick_mirror(self, vertex: int, *, shape: str | None = None) -> None:
        """Pick the mirror image of `vertex`, in the colour of `vertex`, which is picked too if it is not yet.

        Where the mirror map is not known, `vertex` itself is the partner of the point picked last.
        """
        state = self._with_active(shape)
        plain = [pick.vertex for pick in state.active_picks if not pick.is_mirror]
        if state.active is not None and state.active.symmetry is None and plain:
            self.pick_partner(plain[-1], vertex, shape=shape)
            return
        mirror = state.active.mirror(vertex) if state.active and _has_vertex(state, vertex) else None
        if mirror is not None:
            self.pick_partner(vertex, mirror, shape=shape)

    def pick_partner(self, vertex: int, mirror: int, *, shape: str | None = None) -> None:
        """Pick `mirror`, chosen by hand or found by a computation, as the mirror image of `vertex`."""
        state = self._with_active(shape)
        if not (_has_vertex(state, vertex) and _has_vertex(state, mirror)):
            return
        kept = tuple(pick for pick in state.active_picks if pick.mirror_of != vertex)
        partner = next((pick for pick in kept if pick.vertex == vertex), None)
        slot = partner.slot if partner else free_slot(kept)
        if slot is None or any(pick.vertex == mirror for pick in kept):
            return
        added = () if partner else (_new_pick(state, vertex, slot),)
        self._set_picks("pick", state, (*kept, *added, _new_pick(state, mirror, slot, mirror_of=vertex)))

    def unpick(self, vertex: int) -> None:
        """Remove one pick, and its mirror image with it."""
        kept = (p for p in self.state.active_picks if vertex not in (p.vertex, p.mirror_of))
        self._set_picks("unpick", self.state, tuple(kept))

    def clear_picks(self) -> None:
        """Remove every pick on every shape."""
        self._apply("clear", replace(self.state, picks=()))

    def preview(self, diffusion: Diffusion) -> None:
        """Show another diffusion for a while, outside of history; whoever begins this ends it with the former one."""
        self._replace(replace(self.state, diffusion=diffusion))

    def restore(self, state: SessionState) -> None:
        """Put a session that was kept in the place of this one; undo brings this one back."""
        self._apply("restore", state)

    # -- undo ---------------------------------------------------------------------------------------------------------

    @property
    def can_undo(self) -> bool:
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        return bool(self._future)

    @property
    def undo_step(self) -> Step | None:
        """What `undo` takes back."""
        return Step(*self._past[-1], self.state) if self._past else None

    @property
    def redo_step(self) -> Step | None:
        """What `redo` does again."""
        return Step(self._future[-1][0], self.state, self._future[-1][1]) if self._future else None

    def undo(self) -> None:
        """Back to the state before the last change."""
        if self._past:
            kind, state = self._past.pop()
            self._future.append((kind, self.state))
            self._replace(state)

    def redo(self) -> None:
        """Forward again, after undo."""
        if self._future:
            kind, state = self._future.pop()
            self._past.append((kind, self.state))
            self._replace(state)

    def end_gesture(self) -> None:
        """A drag or a typed number is done: the next change undoes on its own."""
        self._last_kind = None

    # -- within -------------------------------------------------------------------------------------------------------

    def _with_active(self, key: str | None) -> SessionState:
        known = key is not None and self.state.shape(key) is not None
        return replace(self.state, active_key=key) if known else self.state

    def _set_picks(self, kind: str, state: SessionState, picks: tuple[Pick, ...]) -> None:
        others = tuple(pick for pick in state.picks if pick.shape != state.active_key)
        self._apply(kind, replace(state, picks=(*others, *picks[: 2 * PICK_LIMIT])))

    def _apply(self, kind: str, state: SessionState, *, coalesce: bool = False) -> None:
        if state == self.state:
            return
        if not (coalesce and kind == self._last_kind):
            self._past = [*self._past[-UNDO_LIMIT:], (kind, self.state)]
        self._future.clear()
        self._replace(state)
        self._last_kind = kind

    def _replace(self, state: SessionState) -> None:
        before, self.state, self._last_kind = self.state, state, None
        changes: list[tuple[bool, Callable[[], None]]] = [
            (before.shapes != state.shapes, self.shapes_changed.emit),
            (before.active is not state.active, self.active_changed.emit),
            (before.picks != state.picks or before.active_picks != state.active_picks, self.picks_changed.emit),
            (before.diffusion != state.diffusion, self.diffusion_changed.emit),
            ((before.field, before.compare) != (state.field, state.compare), self.field_changed.emit),
            (before.looks != state.looks, self.looks_changed.emit),
            (before.arrangement != state.arrangement, self.arrangement_changed.emit),
            (before.matching != state.matching, self.matching_changed.emit),
            (True, self.history_changed.emit),
        ]
        for differs, announce in changes:
            if differs:
                announce()


def _has_vertex(state: SessionState, vertex: int) -> bool:
    return state.active is not None and 0 <= vertex < state.active.vertex_count


def _new_pick(state: SessionState, vertex: int, slot: int, mirror_of: int | None = None) -> Pick:
    assert state.active_key is not None
    return Pick(state.active_key, vertex, slot, mirror_of)
