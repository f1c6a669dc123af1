"""The anisotropic heat kernel signature at the picked points, angle by angle while nobody waits for a kernel."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import count

import numpy as np
from numpy.typing import NDArray

from ..models.diffusion import REACH_MAX, REACH_MIN, Conductivity
from ..models.picks import Pick
from ..models.results import AutodiffusionCurves, Results
from ..models.session import Session, SessionState
from ..models.shapes import OpenShape
from .operators import OperatorStore
from .running import Later, Run, explain

FloatArray = NDArray[np.float64]

ANGLE_COUNT = 16
TIME_COUNT = 17


def curve_reaches() -> FloatArray:
    """(T,) t·λ₁ from local to global, equal ratios."""
    return np.geomspace(REACH_MIN, REACH_MAX, TIME_COUNT)


@dataclass(frozen=True)
class CurveRequest:
    """What the curves depend on; neither the shown θ nor t, which only move the crosshair."""

    shape: OpenShape
    conductivity: Conductivity
    alpha: float
    picks: tuple[Pick, ...]

    @classmethod
    def of(cls, state: SessionState) -> CurveRequest | None:
        if state.active is None or not state.active_picks:
            return None
        return cls(state.active, state.diffusion.conductivity, state.diffusion.alpha, state.active_picks)

    def same_operator(self, other: CurveRequest) -> bool:
        """Whether points that both ask for have the same curves."""
        return (self.shape, self.conductivity, self.alpha) == (other.shape, other.conductivity, other.alpha)


@dataclass(frozen=True)
class CurveStep:
    """One piece of the work: one angle (None: the isotropic signature) at one point."""

    pick: Pick
    theta: float | None


class CurvesController:
    """Fills `Results.curves` step by step; a change of θ or t pauses it, any other change begins anew."""

    def __init__(self, session: Session, results: Results, run: Run, later: Later, operators: OperatorStore) -> None:
        self._session, self._results, self._run, self._later = session, results, run, later
        self._operators = operators
        self._tickets = count(1)
        self._latest = 0
        self._request: CurveRequest | None = None
        self._curves: tuple[AutodiffusionCurves, ...] = ()
        self._steps: list[CurveStep] = []
        for signal in (session.active_changed, session.diffusion_changed, session.picks_changed):
            signal.connect(self._follow)

    def _follow(self) -> None:
        request = CurveRequest.of(self._session.state)
        self._latest = next(self._tickets)  # whatever runs now answers late
        if request != self._request:
            self._begin(request)
        if self._steps:
            self._later(self._go_on)

    def _begin(self, request: CurveRequest | None) -> None:
        same = self._request is not None and request is not None and self._request.same_operator(request)
        self._request = request
        if request is None:
            self._curves, self._steps = (), []
            self._results.set_curves(())
            return
        kept = {curves.pick: curves for curves in self._curves} if same else {}
        self._curves = tuple(kept.get(pick, _empty(pick)) for pick in request.picks)
        self._steps = _steps(tuple(each for each in self._curves if not each.is_complete))
        if same or not self._results.curves:
            self._results.set_curves(self._curves)
        # Otherwise the shown curves stay until there is something better: empty plots would flicker under a slider.

    def _go_on(self) -> None:
        if not self._steps or self._request is None:
            return
        ticket = self._latest = next(self._tickets)
        request, step = self._request, self._steps[0]
        self._run(
            "curves",
            lambda: compute_step(request, step, self._operators),
            done=lambda answer: self._done(ticket, step, answer),
            failed=lambda error: self._failed(ticket, error),
        )

    def _done(self, ticket: int, step: CurveStep, answer: CurveValues) -> None:
        if ticket != self._latest:
            return
        self._steps = self._steps[1:]
        self._curves = tuple(_with(each, step, answer) if each.pick == step.pick else each for each in self._curves)
        if len(self._steps) in self._milestones():
            self._results.set_curves(self._curves)
        self._go_on()

    def _milestones(self) -> set[int]:
        """Steps left when it is worth drawing anew: after a quarter and a half of the angles, and at the end."""
        incomplete = max(1, sum(not each.is_complete for each in self._curves))
        return {0, ANGLE_COUNT // 2 * incomplete, 3 * ANGLE_COUNT // 4 * incomplete}

    def _failed(self, ticket: int, error: BaseException) -> None:
        if ticket == self._latest:
            self._steps = []
            self._results.report(explain(error))


@dataclass(frozen=True, eq=False)
class CurveValues:
    """(T,) h(x, x) over the times at one angle, and λ₁ of the operator."""

    values: FloatArray
    weyl_eigenvalue: float


def compute_step(request: CurveRequest, step: CurveStep, operators: OperatorStore) -> CurveValues:
    """One row of the curves; at α = 0 if the step has no angle."""
    alpha = request.alpha if step.theta is not None else 0.0
    laplacian = operators.laplacian(request.shape, request.conductivity, alpha)
    flow = operators.flow(request.shape, request.conductivity, alpha, "curves")
    scale = laplacian.weyl_eigenvalue(1)
    values = flow.autodiffusion(step.pick.vertex, thetas=[step.theta or 0.0], times=curve_reaches() / scale)
    return CurveValues(values[0], scale)


def _empty(pick: Pick) -> AutodiffusionCurves:
    reaches = curve_reaches()
    return AutodiffusionCurves(pick, np.empty(0), reaches, np.empty((0, len(reaches))), expected=ANGLE_COUNT)


def _steps(curves: tuple[AutodiffusionCurves, ...]) -> list[CurveStep]:
    """Coarse angles first, so that the form of the curve shows early."""
    angles = np.pi * np.arange(ANGLE_COUNT) / ANGLE_COUNT
    thetas = [float(angles[index]) for stride in (4, 2, 1) for index in range(0, ANGLE_COUNT, stride)]
    ordered: list[float | None] = [*dict.fromkeys(thetas)]
    ordered.insert(4, None)
    return [CurveStep(each.pick, theta) for theta in ordered for each in curves if not _has(each, theta)]


def _has(curves: AutodiffusionCurves, theta: float | None) -> bool:
    return curves.isotropic is not None if theta is None else bool(np.isin(theta, curves.thetas))


def _with(curves: AutodiffusionCurves, step: CurveStep, answer: CurveValues) -> AutodiffusionCurves:
    if step.theta is None:
        return replace(curves, isotropic=answer.values, isotropic_weyl_eigenvalue=answer.weyl_eigenvalue)
    at = int(np.searchsorted(curves.thetas, step.theta))
    return replace(
        curves,
        thetas=np.insert(curves.thetas, at, step.theta),
        values=np.insert(curves.values, at, answer.values, axis=0),
        weyl_eigenvalue=answer.weyl_eigenvalue,
    )
