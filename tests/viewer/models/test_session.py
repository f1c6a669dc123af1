"""The session: every change announces itself once, and undo brings back exactly what was."""

from math import pi

import numpy as np
import pytest

from add_viewer.models.session import Session


@pytest.fixture
def session(torus) -> Session:
    session = Session()
    session.add_shape(torus)
    return session


def vertices(session: Session) -> list[int]:
    return [pick.vertex for pick in session.state.active_picks]


def test_a_click_replaces_the_pick_and_an_added_click_keeps_it(session):
    session.pick(3)
    session.pick(5)
    assert vertices(session) == [5]
    session.pick(7, add=True)
    session.pick(7, add=True)
    assert vertices(session) == [5, 7]


def test_eight_points_have_eight_colours_and_a_ninth_is_not_taken(session):
    for vertex in range(9):
        session.pick(vertex, add=True)
    assert [pick.slot for pick in session.state.active_picks] == list(range(8))


def test_a_removed_point_gives_its_colour_to_the_next(session):
    for vertex in range(3):
        session.pick(vertex, add=True)
    session.unpick(1)
    session.pick(9, add=True)
    assert {pick.vertex: pick.slot for pick in session.state.active_picks} == {0: 0, 2: 2, 9: 1}


def test_a_mirror_point_has_the_colour_of_its_partner_and_goes_with_it(make_torus, torus):
    n = torus.vertex_count
    session = Session()
    session.add_shape(make_torus(symmetry=np.arange(n)[::-1].copy()))
    session.pick_mirror(4)
    first, second = session.state.active_picks
    assert (first.vertex, second.vertex, second.mirror_of) == (4, n - 5, 4)
    assert first.slot == second.slot
    assert second.is_mirror
    session.unpick(4)
    assert vertices(session) == []


@pytest.mark.parametrize("vertex", [-1, 10**6])
def test_a_vertex_that_is_not_there_is_not_picked(session, vertex):
    session.pick(vertex)
    assert vertices(session) == []


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"alpha": -3.0}, ("alpha", 0.0)),
        ({"alpha": 1e9}, ("alpha", 200.0)),
        ({"theta": pi + 0.25}, ("theta", 0.25)),
        ({"theta": -0.25}, ("theta", pi - 0.25)),
        ({"reach": 0.0}, ("reach", 2e-3)),
        ({"alpha": float("nan")}, ("alpha", 50.0)),
        ({"conductivity": "nonsense"}, ("conductivity", "curvature")),
    ],
)
def test_parameters_stay_in_their_ranges(session, changes, expected):
    session.diffuse(**changes)
    name, value = expected
    found = getattr(session.state.diffusion, name)
    assert found == value if isinstance(value, str) else found == pytest.approx(value)


def test_undo_and_redo_restore_the_very_states(session):
    states = [session.state]
    for change in (lambda: session.pick(3), lambda: session.diffuse(alpha=7.0), session.clear_picks):
        change()
        states.append(session.state)
    for state in states[-2::-1]:
        session.undo()
        assert session.state == state
    for state in states[1:]:
        session.redo()
        assert session.state == state


def test_a_dragged_slider_undoes_as_one_step(session):
    for alpha in range(30):
        session.diffuse(alpha=float(alpha))
    session.end_gesture()
    session.diffuse(alpha=99.0)
    session.undo()
    assert session.state.diffusion.alpha == 29.0
    session.undo()
    assert session.state.diffusion.alpha == 50.0


def test_a_change_after_undo_forgets_what_was_undone(session):
    session.diffuse(alpha=1.0)
    session.undo()
    session.diffuse(theta=1.0)
    assert not session.can_redo


def test_each_signal_comes_once_and_only_for_its_part(session):
    heard = []
    for name in ("shapes", "active", "diffusion", "picks"):
        getattr(session, f"{name}_changed").connect(lambda name=name: heard.append(name), check_nargs=False)
    session.diffuse(alpha=3.0)
    session.diffuse(alpha=3.0)
    assert heard == ["diffusion"]
    session.pick(1)
    assert heard == ["diffusion", "picks"]


def test_each_shape_keeps_its_picks(session, make_torus):
    session.pick(3)
    session.add_shape(make_torus("second"))
    assert vertices(session) == []
    session.pick(4)
    session.show_shape("torus")
    assert vertices(session) == [3]
    session.close_shape("torus")
    assert vertices(session) == [4]
    assert [pick.shape for pick in session.state.picks] == ["second"]
