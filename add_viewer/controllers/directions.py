"""Where heat wants to go: principal directions at places spread evenly over the shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from add_core.geometry import TriangleMesh

from ..models.diffusion import Conductivity
from ..models.display import Display
from ..models.results import DirectionField, FloatArray, Results
from ..models.session import Session
from ..models.shapes import OpenShape
from .operators import OperatorStore
from .running import Run, explain

PLACES = 700


class DirectionsController:
    """Computes the direction field of every shown shape once somebody wants to see it."""

    def __init__(
        self, session: Session, results: Results, display: Display, run: Run, operators: OperatorStore
    ) -> None:
        self._session, self._results, self._display = session, results, display
        self._run, self._operators = run, operators
        self._asked: set[OpenShape] = set()
        for signal in (session.active_changed, session.shapes_changed, session.looks_changed):
            signal.connect(self._request)
        session.arrangement_changed.connect(self._request)
        display.changed.connect(lambda name: self._request() if name == "arrows" else None)

    def _request(self) -> None:
        state = self._session.state
        self._results.keep_directions({shape.key for shape in state.shapes})
        self._asked &= set(state.shapes)
        if not self._display["arrows"]:
            return
        for shape in state.shown:
            if shape not in self._asked:
                self._ask(shape, state.diffusion.conductivity)

    def _ask(self, shape: OpenShape, conductivity: Conductivity) -> None:
        self._asked.add(shape)
        self._run(
            "directions",
            lambda: direction_field(shape, conductivity, self._operators),
            done=lambda field: self._done(shape, field),
            failed=lambda error: self._results.report(explain(error)),
            queue=True,
        )

    def _done(self, shape: OpenShape, field: DirectionField) -> None:
        if shape in self._asked:  # it is still open
            self._results.set_directions(field)


@dataclass(frozen=True, eq=False)
class _Places:
    """Where frames live: the centres of faces, or points. Each (m, 3)."""

    centres: FloatArray
    normals: FloatArray
    directions: FloatArray


def direction_field(shape: OpenShape, conductivity: Conductivity, operators: OperatorStore) -> DirectionField:
    """`PLACES` places, each as far as possible from the others, with the frame there."""
    frames = operators.laplacian(shape, conductivity, 0.0).frames
    if isinstance(shape.shape, TriangleMesh):
        centres = shape.shape.vertices[shape.shape.faces].mean(axis=1)
        usable = np.flatnonzero(shape.shape.has_area)
    else:
        centres, usable = shape.shape.vertices, np.arange(shape.vertex_count)
    places = _Places(centres[usable], frames.normals[usable], frames.max_direction[usable])
    chosen, spacing = spread(places.centres, PLACES)
    return DirectionField(shape.key, places.centres[chosen], places.normals[chosen], places.directions[chosen], spacing)


def spread(points: FloatArray, wanted: int) -> tuple[np.ndarray, float]:
    """Indices of `wanted` of the `points` (n, 3), each the farthest from those before it, and their spacing.

    Distances run straight through the body: for little marks on the skin that is even enough, and far faster.
    """
    chosen = np.zeros(min(wanted, len(points)), dtype=np.int64)
    away = np.full(len(points), np.inf)
    for index in range(1, len(chosen)):
        np.minimum(away, ((points - points[chosen[index - 1]]) ** 2).sum(axis=1), out=away)
        chosen[index] = np.argmax(away)
    return chosen, float(np.sqrt(away[chosen[-1]])) if len(chosen) > 1 else 0.0
