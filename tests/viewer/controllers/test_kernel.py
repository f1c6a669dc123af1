"""The live kernel: newest wins, late answers are dropped, failures are told. No Qt."""

import numpy as np
import pytest

from add_core.operators import AnisotropicLaplacian
from add_core.spectra import HeatFlow
from add_viewer.controllers.kernel import KernelController
from add_viewer.controllers.operators import OperatorStore
from add_viewer.models.display import Display
from add_viewer.models.results import Results
from add_viewer.models.session import Session


@pytest.fixture
def parts(run, torus):
    session, results = Session(), Results()
    controller = KernelController(session, results, Display(), run, OperatorStore())
    session.add_shape(torus)
    run.answer_all()
    return session, results, controller


def test_opening_a_shape_tells_the_time_scale_before_anything_is_picked(parts, torus):
    _, results, _ = parts
    assert results.weyl_eigenvalue == pytest.approx(AnisotropicLaplacian(torus.shape, alpha=50.0).weyl_eigenvalue(1))
    assert results.kernel is None


def test_a_pick_gives_the_core_s_kernel(parts, run, torus):
    session, results, _ = parts
    session.diffuse(alpha=8.0, theta=0.7, conductivity="constant")
    session.pick(5)
    run.answer_all()
    laplacian = AnisotropicLaplacian(torus.shape, alpha=8.0, conductivity="constant")
    time = session.state.diffusion.reach / laplacian.weyl_eigenvalue(1)
    expected = HeatFlow(laplacian).kernel(5, theta=0.7, time=time)
    assert results.kernel.values == pytest.approx(expected, rel=1e-3, abs=1e-4 * expected.max())
    assert results.kernel.time == pytest.approx(time)


def test_several_picks_add_their_heat(parts, run, torus):
    session, results, _ = parts
    fields = []
    for vertex in (5, 60):
        session.pick(vertex)
        run.answer_all()
        fields.append(results.kernel.values)
    session.pick(5, add=True)
    run.answer_all()
    assert results.kernel.columns == pytest.approx(np.stack(fields[::-1]))
    assert results.kernel.shares.max() == pytest.approx(1.0)
    assert results.kernel.values == pytest.approx(sum(fields))
    assert results.kernel.values @ torus.shape.vertex_areas == pytest.approx(2.0, rel=1e-6)  # unit heat from each


def test_a_late_answer_is_dropped(parts, run):
    session, results, _ = parts
    session.pick(5)
    session.diffuse(theta=1.0)
    assert len(run.waiting) == 2
    run.answer(1)
    newest = results.kernel
    assert newest.diffusion.theta == 1.0
    run.answer(0)
    assert results.kernel is newest


def test_an_answer_for_a_shape_that_was_closed_is_dropped(parts, run):
    session, results, _ = parts
    session.pick(5)
    session.close_shape("torus")
    run.answer_all()
    assert results.kernel is None
    assert results.weyl_eigenvalue is None


def test_alpha_changes_time_and_keeps_the_reach(parts, run):
    session, results, _ = parts
    session.pick(5)
    run.answer_all()
    before = results.kernel.time
    session.diffuse(alpha=150.0)
    run.answer_all()
    assert results.kernel.time > before
    assert results.kernel.time * results.weyl_eigenvalue == pytest.approx(session.state.diffusion.reach)


def test_a_failure_is_told_and_leaves_no_stale_kernel(parts, run, monkeypatch):
    session, results, _ = parts
    session.pick(5)
    run.answer_all()
    heard = []
    results.noticed.connect(lambda notice: heard.append(notice.text))
    monkeypatch.setattr(HeatFlow, "kernel", lambda *_args, **_options: (_ for _ in ()).throw(MemoryError()))
    session.diffuse(theta=0.2)
    run.answer_all()
    assert results.kernel is None
    assert "not enough memory" in heard[0]


def test_the_operator_is_built_once_and_shared_between_anisotropies(torus):
    store = OperatorStore()
    first, second = store.laplacian(torus, "curvature", 3.0), store.laplacian(torus, "curvature", 4.0)
    assert first.frames is second.frames
    assert first.pattern is second.pattern
    assert store.laplacian(torus, "constant", 4.0).frames is first.frames
    assert store.flow(torus, "curvature", 3.0, "kernel") is store.flow(torus, "curvature", 3.0, "kernel")
    assert np.isfinite(second.mass).all()
