"""Curves fill in piece by piece, and never get in the way of a kernel. No Qt."""

import numpy as np
import pytest

from add_core.spectra import HeatFlow
from add_viewer.controllers.curves import ANGLE_COUNT, CurvesController, curve_reaches
from add_viewer.controllers.exporting import curves_table
from add_viewer.controllers.operators import OperatorStore
from add_viewer.models.results import Results
from add_viewer.models.session import Session


class Pause:
    """The person pauses when the test says so."""

    def __init__(self) -> None:
        self.call = None

    def __call__(self, call) -> None:
        self.call = call

    def over(self) -> None:
        call, self.call = self.call, None
        if call is not None:
            call()


@pytest.fixture
def parts(run, torus):
    session, results, pause = Session(), Results(), Pause()
    controller = CurvesController(session, results, run, pause, OperatorStore())
    session.add_shape(torus)
    return session, results, pause, controller


def test_nothing_runs_until_the_person_pauses(parts, run):
    session, _, pause, _ = parts
    session.pick(5)
    assert run.waiting == []
    pause.over()
    assert len(run.waiting) == 1


def test_the_curves_are_the_core_s_autodiffusion(parts, run, torus):
    session, results, pause, _ = parts
    session.pick(5)
    pause.over()
    run.answer_all()
    (curves,) = results.curves
    assert curves.is_complete
    assert curves.thetas == pytest.approx(np.pi * np.arange(ANGLE_COUNT) / ANGLE_COUNT)
    laplacian = OperatorStore().laplacian(torus, "curvature", 50.0)
    expected = HeatFlow(laplacian).autodiffusion(5, thetas=[curves.thetas[3]], times=curves.times)
    assert curves.values[3] == pytest.approx(expected[0], rel=1e-5)
    isotropic = OperatorStore().laplacian(torus, "curvature", 0.0)
    times = curve_reaches() / isotropic.weyl_eigenvalue(1)
    assert curves.isotropic == pytest.approx(
        HeatFlow(isotropic).autodiffusion(5, thetas=[0.0], times=times)[0], rel=1e-5
    )


def test_turning_theta_pauses_the_work_and_keeps_what_is_there(parts, run):
    session, results, pause, _ = parts
    session.pick(5)
    pause.over()
    for _ in range(6):
        run.answer()
    session.diffuse(theta=0.4)
    run.answer()  # what ran answers late
    assert run.waiting == []
    pause.over()
    run.answer_all()
    assert results.curves[0].is_complete


def test_another_alpha_begins_anew_without_an_empty_plot_in_between(parts, run):
    session, results, pause, _ = parts
    session.pick(5)
    pause.over()
    run.answer_all()
    shown = results.curves
    session.diffuse(alpha=5.0)
    assert results.curves is shown
    pause.over()
    run.answer_all()
    assert results.curves[0].is_complete
    assert not np.allclose(results.curves[0].values, shown[0].values)


def test_an_added_point_keeps_the_curves_of_the_others(parts, run):
    session, results, pause, _ = parts
    session.pick(5)
    pause.over()
    run.answer_all()
    first = results.curves[0]
    session.pick(9, add=True)
    assert results.curves[0] is first
    pause.over()
    assert len(run.waiting) == 1
    run.answer_all()
    assert [each.is_complete for each in results.curves] == [True, True]


def test_clearing_the_picks_clears_the_curves(parts, run):
    session, results, pause, _ = parts
    session.pick(5)
    pause.over()
    run.answer_all()
    session.clear_picks()
    assert results.curves == ()


def test_the_table_holds_every_number_in_full(parts, run):
    session, results, pause, _ = parts
    session.pick(5)
    pause.over()
    run.answer_all()
    lines = curves_table(results.curves, 50.0).splitlines()
    assert lines[0] == "vertex,mirror_of,alpha,theta_degrees,time,time_times_lambda1,heat_kernel"
    assert len(lines) == 1 + (ANGLE_COUNT + 1) * len(curve_reaches())
    cells = lines[1].split(",")
    assert float(cells[-1]) == results.curves[0].values[0, 0]
    assert float(cells[4]) == pytest.approx(results.curves[0].times[0])
