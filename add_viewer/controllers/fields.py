"""The chosen field of every view: planned when something changes, computed off the window's thread, newest wins."""

from __future__ import annotations

from collections.abc import Hashable
from itertools import count

from ..models.fields import FieldKind, ShapeField
from ..models.session import Session
from .answers import Question
from .field_plans import Place, Plan, Planner, Sources
from .fields_of_descriptors import ambiguity_plan, distance_plan, signature_plan
from .fields_of_geometry import curvature_plan, file_plan
from .fields_of_heat import rose_plan
from .fields_of_matches import error_plan, transfer_plan
from .fields_of_spectra import eigenfunction_plan, kernel_plan
from .running import Run, explain

PLANNERS: dict[FieldKind, Planner] = {
    "rose": rose_plan,
    "kernel": kernel_plan,
    "distance": distance_plan,
    "ambiguity": ambiguity_plan,
    "eigenfunction": eigenfunction_plan,
    "signature": signature_plan,
    "curvature": curvature_plan,
    "file": file_plan,
    "transfer": transfer_plan,
    "error": error_plan,
}
"""Who plans which kind. "heat" is the live kernel's, "skin" is nobody's."""

View = tuple[int, str]
"""Panel and key of a shape."""


class FieldController:
    """Fills `Results.fields` for every kind but "heat"."""

    def __init__(self, session: Session, sources: Sources, run: Run) -> None:
        self._session, self._sources, self._run = session, sources, run
        self._results = sources.results
        self._tickets = count(1)
        self._latest = 0
        self._shown: dict[View, tuple[Hashable, ...]] = {}
        self._pending: dict[View, tuple[Hashable, ...]] = {}
        session.field_changed.connect(sources.answers.forget_problems)
        signals = (
            session.shapes_changed,
            session.active_changed,
            session.diffusion_changed,
            session.picks_changed,
            session.field_changed,
            session.arrangement_changed,
            session.looks_changed,
            session.matching_changed,
            sources.results.kernel_changed,
            sources.results.carried_changed,
            sources.results.maps_changed,
            sources.matching.changed,
        )
        for signal in signals:
            signal.connect(self._follow)
        sources.answers.arrived.connect(self._heard)
        sources.answers.progressed.connect(self._heard)

    def _heard(self, _question: Question) -> None:
        self._follow()

    def _follow(self) -> None:
        state = self._session.state
        wanted: dict[View, Plan] = {}
        for panel, choice in enumerate(state.choices):
            for shape in state.shown:
                planner = PLANNERS.get(choice.kind)
                if planner is not None:
                    wanted[panel, shape.key] = planner(Place(state, choice, shape), self._sources)
                elif choice.kind == "skin":
                    wanted[panel, shape.key] = Plan()
        self._clear([view for view in self._shown if view not in wanted])
        self._show_messages(wanted)
        self._compute({view: plan for view, plan in wanted.items() if self._is_news(view, plan)})

    def _is_news(self, view: View, plan: Plan) -> bool:
        return plan.work is not None and self._shown.get(view) != plan.inputs

    def _clear(self, views: list[View]) -> None:
        """Views that are gone, or that show live heat now."""
        open_keys = {shape.key for shape in self._session.state.shapes}
        for panel, key in views:
            del self._shown[panel, key]
            shown = self._results.fields.get((panel, key))
            if shown is not None and (key not in open_keys or shown.choice.kind != "heat"):
                self._results.set_field(panel, key, None)

    def _show_messages(self, wanted: dict[View, Plan]) -> None:
        for (panel, key), plan in wanted.items():
            if plan.work is None and self._shown.get((panel, key)) != ("message", plan.message):
                self._shown[panel, key] = ("message", plan.message)
                choice = self._session.state.choices[panel]
                field = ShapeField(shape=key, choice=choice, message=plan.message) if plan.message else None
                if field is not None or (panel, key) in self._results.fields:
                    self._results.set_field(panel, key, field)

    def _compute(self, plans: dict[View, Plan]) -> None:
        pending = {view: plan.inputs for view, plan in plans.items()}
        if pending == self._pending:
            return  # it is being computed
        self._pending = pending
        ticket = self._latest = next(self._tickets)
        if not plans:
            return
        self._run(
            "fields",
            lambda: {view: plan.work() for view, plan in plans.items() if plan.work is not None},
            done=lambda fields: self._done(ticket, plans, fields),
            failed=lambda error: self._failed(ticket, plans, error),
        )

    def _done(self, ticket: int, plans: dict[View, Plan], fields: dict[View, ShapeField]) -> None:
        if ticket != self._latest:
            return
        self._pending = {}
        for (panel, key), field in fields.items():
            self._shown[panel, key] = plans[panel, key].inputs
            self._results.set_field(panel, key, field)

    def _failed(self, ticket: int, plans: dict[View, Plan], error: BaseException) -> None:
        if ticket == self._latest:
            self._pending = {}
            for view, plan in plans.items():
                self._shown[view] = plan.inputs  # the same would fail again
            self._results.report(explain(error))
