"""Picks of the active shape carried to the other shapes: to their true places, or by the chosen matching."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from add_core.geometry import TriangleMesh
from add_core.io import known_matches, shipped_place

from ..models.fields import MATCHED
from ..models.picks import Pick
from ..models.results import FloatArray, IntArray, Results
from ..models.session import Session, SessionState
from ..models.shapes import OpenShape


class CarryingController:
    """Keeps `Results.carried` in step with picks, shapes, matching and what is drawn.

    Shapes with picks of their own keep those.
    """

    def __init__(self, session: Session, results: Results) -> None:
        self._session, self._results = session, results
        for signal in (session.picks_changed, session.active_changed, session.shapes_changed):
            signal.connect(self._carry)
        for signal in (session.matching_changed, session.field_changed):
            signal.connect(self._carry)
        results.maps_changed.connect(self._carry)

    def _carry(self) -> None:
        state = self._session.state
        self._results.set_carried(carried_picks(state, self._results.maps))


def carried_picks(state: SessionState, maps: dict[tuple[str, str], IntArray]) -> dict[str, tuple[Pick, ...]]:
    """By shape, where the active shape's picks lie on it, in the same colours; nothing where no map is known.

    maps : of the chosen matching. It serves while its own colours or errors are drawn; under any other field it would
    move picks without being in sight, so there it only serves where the true correspondence is unknown.
    """
    source, found = state.active, {}
    if source is None or not state.active_picks:
        return {}
    for target in state.shapes:
        if target is source or state.picks_on(target.key):
            continue
        match = None if _shows_matching(state) else true_match(source, target)
        match = maps.get((source.key, target.key)) if match is None else match
        if match is not None:
            found[target.key] = tuple(_carried(pick, source, target, match) for pick in state.active_picks)
    return found


def _shows_matching(state: SessionState) -> bool:
    return state.matching.method != "true" and any(choice.kind in MATCHED for choice in state.choices)


@lru_cache(maxsize=32)
def true_match(source: OpenShape, target: OpenShape) -> IntArray | None:
    """(n_target,): the source vertex at the place of each target vertex, the nearest where none is at that very place.

    Known between shapes that share a template, and between meshes that share their faces; None for others.
    """
    if source.template and source.template == target.template:
        return _match_of_places(source, target)
    one, two = source.shape, target.shape
    if not (isinstance(one, TriangleMesh) and isinstance(two, TriangleMesh)) or one.vertex_count != two.vertex_count:
        return None
    same = one.faces is two.faces or np.array_equal(one.faces, two.faces)
    return np.arange(one.vertex_count, dtype=np.int64) if same else None


def _match_of_places(source: OpenShape, target: OpenShape) -> IntArray | None:
    one, two = shipped_place(source.reference), shipped_place(target.reference)
    return None if one is None or two is None else known_matches(one, two)


def carried_vertex(vertex: int, vertices: FloatArray, match: IntArray) -> int:
    """The target vertex whose match lies nearest to `vertex` of the source, which has `vertices` (n, 3)."""
    away = ((vertices[match] - vertices[vertex]) ** 2).sum(axis=1)
    away[match < 0] = np.inf
    return int(np.argmin(away))


def _carried(pick: Pick, source: OpenShape, target: OpenShape, match: IntArray) -> Pick:
    vertices = source.shape.vertices
    mirror_of = None if pick.mirror_of is None else carried_vertex(pick.mirror_of, vertices, match)
    return replace(pick, shape=target.key, vertex=carried_vertex(pick.vertex, vertices, match), mirror_of=mirror_of)
