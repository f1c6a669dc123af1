"""The live heat kernel: every change asks for a new one, and only the newest answer is shown."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

import numpy as np

from ..models.diffusion import Diffusion
from ..models.picks import Pick
from ..models.results import KernelField, Results
from ..models.session import Session, SessionState
from ..models.shapes import OpenShape
from .operators import OperatorStore
from .running import Run, explain


@dataclass(frozen=True)
class KernelRequest:
    """What the person asks for, as it stands at one moment."""

    shape: OpenShape
    diffusion: Diffusion
    picks: tuple[Pick, ...]

    @classmethod
    def of(cls, state: SessionState) -> KernelRequest | None:
        return None if state.active is None else cls(state.active, state.diffusion, state.active_picks)


@dataclass(frozen=True)
class KernelAnswer:
    """The operator's scale λ₁ (Weyl), and the kernel if a point is picked."""

    weyl_eigenvalue: float
    field: KernelField | None


class KernelController:
    """Keeps `Results.kernel` and the time scale in step with the session."""

    def __init__(self, session: Session, results: Results, run: Run, operators: OperatorStore) -> None:
        self._session, self._results, self._run, self._operators = session, results, run, operators
        self._tickets = count(1)
        self._latest = 0
        session.active_changed.connect(self._follow_shape)
        session.diffusion_changed.connect(self._request)
        session.picks_changed.connect(self._request)

    def _follow_shape(self) -> None:
        self._results.set_kernel(None)
        self._request()

    def _request(self) -> None:
        ticket = self._latest = next(self._tickets)
        request = KernelRequest.of(self._session.state)
        if request is None:
            self._results.set_weyl_eigenvalue(None)
            return
        if not request.picks:
            self._results.set_kernel(None)
        self._run(
            "kernel",
            lambda: compute_kernel(request, self._operators),
            done=lambda answer: self._done(ticket, answer),
            failed=lambda error: self._failed(ticket, error),
        )

    def _done(self, ticket: int, answer: KernelAnswer) -> None:
        if ticket == self._latest:  # the person has not moved on meanwhile
            self._results.set_weyl_eigenvalue(answer.weyl_eigenvalue)
            self._results.set_kernel(answer.field)

    def _failed(self, ticket: int, error: BaseException) -> None:
        if ticket == self._latest:
            self._results.set_kernel(None)
            self._results.report(explain(error))


def compute_kernel(request: KernelRequest, operators: OperatorStore) -> KernelAnswer:
    """h_αθt(pick, ·) of each pick with t = reach / λ₁, and λ₁ itself."""
    shape, wanted = request.shape, request.diffusion
    laplacian = operators.laplacian(shape, wanted.conductivity, wanted.alpha)
    scale = laplacian.weyl_eigenvalue(1)
    if not request.picks:
        return KernelAnswer(scale, None)
    flow = operators.flow(shape, wanted.conductivity, wanted.alpha, "kernel")
    time = wanted.reach / scale
    columns = [flow.kernel(pick.vertex, theta=wanted.theta, time=time) for pick in request.picks]
    return KernelAnswer(scale, KernelField(shape.key, np.stack(columns), wanted, time, request.picks))
