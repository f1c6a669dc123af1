"""The direction field on the skin."""

import numpy as np
import pytest

from add_viewer.controllers.directions import DirectionsController, direction_field, spread
from add_viewer.controllers.operators import OperatorStore
from add_viewer.models.display import Display
from add_viewer.models.results import Results
from add_viewer.models.session import Session


def test_places_are_spread_evenly():
    grid = np.stack(np.meshgrid(np.arange(30.0), np.arange(30.0), [0.0]), axis=-1).reshape(-1, 3)
    chosen, spacing = spread(grid, 50)
    assert len(set(chosen.tolist())) == 50
    apart = np.linalg.norm(grid[chosen][:, None] - grid[chosen][None], axis=2) + 1e9 * np.eye(50)
    assert apart.min() == pytest.approx(spacing)


def test_on_a_torus_the_maximum_curvature_runs_around_the_tube(torus):
    field = direction_field(torus, "curvature", OperatorStore())
    along_the_ring = np.cross([0, 0, 1], field.positions)
    along_the_ring /= np.linalg.norm(along_the_ring, axis=1, keepdims=True)
    assert np.abs((field.max_directions * along_the_ring).sum(axis=1)).max() < 0.1
    assert np.abs((field.max_directions * field.normals).sum(axis=1)).max() < 1e-9


def test_nothing_is_computed_until_somebody_wants_to_see_it(run, torus):
    session, results, display = Session(), Results(), Display()
    controller = DirectionsController(session, results, display, run, OperatorStore())
    session.add_shape(torus)
    assert run.waiting == []
    display.set("arrows", True)
    run.answer_all()
    assert results.directions["torus"].shape == "torus"
    assert controller is not None
