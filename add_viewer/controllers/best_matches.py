"""The points that are most like the picked one, and how far they are from where they should be."""

from __future__ import annotations

from dataclasses import replace
from itertools import count

import numpy as np
from numpy.typing import NDArray

from add_core.geometry.pair_distances import PairDistances

from ..models.fields import ShapeField
from ..models.insights import BestMatch, Insights
from ..models.picks import Pick
from ..models.results import Results
from ..models.session import Session
from ..models.shapes import OpenShape, Shape
from .carrying import carried_vertex, true_match
from .fields_of_descriptors import asked_point
from .running import Run, explain

FloatArray = NDArray[np.float64]

_KEPT = 4
"""Shapes whose geodesic graphs stay at hand."""


class BestMatchesController:
    """Fills `Insights.best`: vertices and distances at once, geodesic errors a moment later."""

    def __init__(self, session: Session, results: Results, insights: Insights, run: Run) -> None:
        self._session, self._results, self._insights, self._run = session, results, insights, run
        self._tickets = count(1)
        self._latest = 0
        self._graphs: list[tuple[Shape, PairDistances]] = []
        results.fields_changed.connect(lambda panel, key: self._follow())
        session.picks_changed.connect(self._follow)

    def _follow(self) -> None:
        ticket = self._latest = next(self._tickets)
        state = self._session.state
        pick = asked_point(state)
        fields = {view: field for view, field in self._results.fields.items() if field.choice.kind == "distance"}
        best = {view: matches_of(field) for view, field in fields.items() if field.values is not None}
        owner = None if pick is None else state.shape(pick.shape)
        if pick is None or owner is None or not best:
            self._insights.set_best({})
            return
        known = self._insights.best
        self._insights.set_best({view: _with_known(matches, known.get(view, ())) for view, matches in best.items()})
        shapes = {key: state.shape(key) for _, key in best}
        self._run(
            "insights",
            lambda: {view: self._judged(matches, shapes[view[1]], owner, pick) for view, matches in best.items()},
            done=lambda judged: self._insights.set_best(judged) if ticket == self._latest else None,
            failed=lambda error: self._results.report(explain(error)),
        )

    def _judged(
        self, matches: tuple[BestMatch, ...], shape: OpenShape | None, owner: OpenShape, pick: Pick
    ) -> tuple[BestMatch, ...]:
        truth = None if shape is None else true_match(owner, shape)
        if shape is None or truth is None:
            return matches
        true = carried_vertex(pick.vertex, owner.shape.vertices, truth)
        away = self._distances(shape.shape).rows([true])[0]
        mirror = None if shape.symmetry is None else int(shape.symmetry[true])
        back = None if mirror is None else self._distances(shape.shape).rows([mirror])[0]
        return tuple(
            replace(match, error=float(away[match.vertex]), is_mirror=_is_mirror(match.vertex, away, back))
            for match in matches
        )

    def _distances(self, shape: Shape) -> PairDistances:
        found = next((graph for kept, graph in self._graphs if kept is shape), None)
        if found is None:
            found = PairDistances(shape)
            self._graphs = [*self._graphs[-_KEPT + 1 :], (shape, found)]
        return found


def matches_of(field: ShapeField) -> tuple[BestMatch, ...]:
    """The best places of a distance map, with their distance ÷ the median."""
    values = field.values
    assert values is not None
    median = float(np.median(values)) or 1.0
    return tuple(BestMatch(field.shape, vertex, float(values[vertex]) / median) for vertex in field.best)


def _with_known(matches: tuple[BestMatch, ...], known: tuple[BestMatch, ...]) -> tuple[BestMatch, ...]:
    """Errors that were measured stay while only the saturation changes."""
    measured = {(each.vertex, each.distance): each for each in known}
    return tuple(measured.get((each.vertex, each.distance), each) for each in matches)


def _is_mirror(vertex: int, away: FloatArray, back: FloatArray | None) -> bool:
    """Nearer to the mirror image of the true place, and not in between."""
    return back is not None and bool(back[vertex] < 0.5 * away[vertex])
