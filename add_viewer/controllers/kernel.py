"""The live heat kernel: every change asks for new ones, and only the newest answer is shown."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

import numpy as np

from ..models.diffusion import Diffusion
from ..models.display import Display
from ..models.heat_field import heat_field
from ..models.picks import Pick
from ..models.results import KernelField, Results
from ..models.session import Session, SessionState
from ..models.shapes import OpenShape
from .operators import OperatorStore
from .running import Run, explain


@dataclass(frozen=True)
class KernelRequest:
    """What the person asks for, as it stands at one moment.

    shape : the active one, to whose operator the time refers. sources : the picks of each shown shape that has some;
        empty where no view draws heat.
    """

    shape: OpenShape
    diffusion: Diffusion
    sources: tuple[tuple[OpenShape, tuple[Pick, ...]], ...]

    @classmethod
    def of(cls, state: SessionState, carried: dict[str, tuple[Pick, ...]]) -> KernelRequest | None:
        if state.active is None:
            return None
        picks = [(shape, state.picks_on(shape.key) or carried.get(shape.key, ())) for shape in state.shown]
        drawn = any(choice.kind == "heat" for choice in state.choices)
        return cls(state.active, state.diffusion, tuple(each for each in picks if each[1]) if drawn else ())


@dataclass(frozen=True)
class KernelAnswer:
    """The active operator's scale λ₁ (Weyl), and a kernel for each shape with picks."""

    weyl_eigenvalue: float
    kernels: tuple[KernelField, ...]


class KernelController:
    """Keeps kernels and the time scale in step with the session: `Results.kernel`, and the fields of kind "heat"."""

    def __init__(
        self, session: Session, results: Results, display: Display, run: Run, operators: OperatorStore
    ) -> None:
        self._session, self._results, self._display = session, results, display
        self._run, self._operators = run, operators
        self._tickets = count(1)
        self._latest = 0
        self._asked: KernelRequest | None = None
        self._kernels: dict[str, KernelField] = {}
        session.active_changed.connect(self._follow_shape)
        session.field_changed.connect(self._follow_field)
        session.diffusion_changed.connect(self._request)
        session.picks_changed.connect(self._request)
        for signal in (session.shapes_changed, session.looks_changed, session.arrangement_changed):
            signal.connect(self._request)
        results.carried_changed.connect(self._request)
        display.changed.connect(lambda name: self._draw() if name == "kernel_scale" else None)

    def _follow_shape(self) -> None:
        self._results.set_kernel(None)
        self._request()

    def _follow_field(self) -> None:
        self._draw()
        self._request()

    def _request(self) -> None:
        request = KernelRequest.of(self._session.state, self._results.carried)
        if request is not None and request == self._asked:
            return
        ticket, self._asked = next(self._tickets), request
        self._latest = ticket
        if request is None:
            self._results.set_weyl_eigenvalue(None)
        if request is None or not request.sources:
            self._show(())
        if request is not None:
            self._run(
                "kernel",
                lambda: compute_kernels(request, self._operators),
                done=lambda answer: self._done(ticket, answer),
                failed=lambda error: self._failed(ticket, error),
            )

    def _done(self, ticket: int, answer: KernelAnswer) -> None:
        if ticket == self._latest:  # the person has not moved on meanwhile
            self._results.set_weyl_eigenvalue(answer.weyl_eigenvalue)
            self._show(answer.kernels)

    def _failed(self, ticket: int, error: BaseException) -> None:
        if ticket == self._latest:
            self._asked = None
            self._show(())
            self._results.report(explain(error))

    def _show(self, kernels: tuple[KernelField, ...]) -> None:
        self._kernels = {kernel.shape: kernel for kernel in kernels}
        self._draw()
        active = self._session.state.active_key
        self._results.set_kernel(None if active is None else self._kernels.get(active))

    def _draw(self) -> None:
        """Write the heat into the panels that show it, and take it from those that no longer do."""
        state, results = self._session.state, self._results
        panels = {panel: choice for panel, choice in enumerate(state.choices) if choice.kind == "heat"}
        for panel, key in list(results.fields):
            stale = results.fields[panel, key].choice.kind == "heat"
            if stale and (panel not in panels or key not in self._kernels):
                results.set_field(panel, key, None)
        for panel, choice in panels.items():
            for key, kernel in self._kernels.items():
                results.set_field(panel, key, heat_field(kernel, choice, self._display["kernel_scale"]))


def compute_kernels(request: KernelRequest, operators: OperatorStore) -> KernelAnswer:
    """h_αθt(pick, ·) of each pick, and λ₁ of the active operator; t = reach / λ₁ is the same for all shapes."""
    wanted = request.diffusion
    operators.make_room(len(request.sources))
    scale = operators.laplacian(request.shape, wanted.conductivity, wanted.alpha).weyl_eigenvalue(1)
    time = wanted.reach / scale
    kernels = []
    for shape, picks in request.sources:
        flow = operators.flow(shape, wanted.conductivity, wanted.alpha, "kernel")
        columns = [flow.kernel(pick.vertex, theta=wanted.theta, time=time) for pick in picks]
        kernels.append(KernelField(shape.key, np.stack(columns), wanted, time, picks))
    return KernelAnswer(scale, tuple(kernels))
