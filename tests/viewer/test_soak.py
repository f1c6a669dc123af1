"""Sixty things in a row, by seed; `tests/benchmarks/soak.py` does five hundred on people, with jobs."""

import sys

import pytest
from soaking import Soaker, small_shapes

ACTIONS = 60


@pytest.mark.parametrize("seed", [2])
def test_many_actions_leave_no_error_and_a_session_that_comes_back(seed, assembly, qtbot, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    soaker = Soaker(assembly, seed, small_shapes(tmp_path), tmp_path, thorough=False)
    soaker.act(ACTIONS)
    assert soaker.settle(), "something never ended"
    assert soaker.problems == [], f"after {soaker.done}"
    before, path = soaker.kept(), tmp_path / "end.addsession"
    assembly.keeping.save(path)
    for shape in assembly.session.state.shapes:
        assembly.session.close_shape(shape.key)
    soaker.settle()
    assembly.keeping.open(path)
    assert soaker.settle()
    assert soaker.kept() == before, f"after {soaker.done}"
