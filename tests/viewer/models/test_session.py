"""The session: every change announces itself once, and undo brings back exactly what was."""

from math import pi

import numpy as np
import pytest

from add_viewer.models.fields import FieldChoice
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


def test_a_click_on_another_shape_makes_it_the_source_in_one_step(session, make_torus):
    session.add_shape(make_torus("second"))
    session.pick(4)
    before = session.state
    session.pick(3, shape="torus")
    assert session.state.active_key == "torus"
    assert [(pick.shape, pick.vertex) for pick in session.state.picks] == [("torus", 3)]
    session.undo()
    assert session.state == before


def test_a_shape_that_joins_one_with_picks_leaves_it_active_and_one_that_stands_alone_is_shown(session, make_torus):
    session.add_shape(make_torus("second"))
    assert session.state.active_key == "second"  # nothing was picked yet
    session.pick(3)
    before = session.state
    session.add_shape(make_torus("third"))
    assert (session.state.active_key, vertices(session)) == ("second", [3])
    session.undo()
    assert session.state is before
    session.add_shape(make_torus("torus"))  # opened again: that is the one to look at
    assert session.state.active_key == "torus"
    session.undo()
    session.arrange(layout="single")
    session.add_shape(make_torus("third"))  # the only one in sight
    assert session.state.active_key == "third"


def test_added_picks_lie_on_several_shapes_and_go_with_theirs(session, make_torus):
    session.pick(3)
    session.add_shape(make_torus("second"))
    session.show_shape("second")
    assert vertices(session) == []
    session.pick(4, add=True)
    session.show_shape("torus")
    assert vertices(session) == [3]
    session.close_shape("torus")
    assert [(pick.shape, pick.vertex) for pick in session.state.picks] == [("second", 4)]
    session.clear_picks()
    assert session.state.picks == ()


def test_a_mirror_point_can_be_chosen_by_hand(session):
    session.pick(4)
    session.pick_partner(4, 9)
    assert [(pick.vertex, pick.mirror_of, pick.slot) for pick in session.state.active_picks] == [
        (4, None, 0),
        (9, 4, 0),
    ]


def test_shapes_are_moved_hidden_and_drawn_in_their_own_ways(session, make_torus):
    session.add_shape(make_torus("second"))
    session.add_shape(make_torus("third"))
    session.move_shape("third", 0)
    assert [shape.key for shape in session.state.shapes] == ["third", "torus", "second"]
    session.set_look("torus", visible=False, point_size=9.0)
    assert session.state.look("torus").point_size == 4.0
    assert [shape.key for shape in session.state.shown] == ["third", "second"]
    session.set_look("third", visible=False)  # the active shape always has a view
    assert [shape.key for shape in session.state.shown] == ["third", "second"]
    session.arrange(layout="single")
    assert [shape.key for shape in session.state.shown] == ["third"]
    session.close_shape("torus")
    assert [look.key for look in session.state.looks] == ["third"]


def test_fields_and_their_comparison_are_chosen_and_undone(session):
    heard = []
    session.field_changed.connect(lambda: heard.append(session.state.choices))
    session.choose_field(kind="distance", descriptor="wks")
    for percentile in (60.0, 70.0, 800.0):
        session.choose_field(saturation=percentile)
    session.choose_comparison(FieldChoice("eigenfunction", index=4))
    assert session.state.choices == (
        FieldChoice("distance", "wks", saturation=100.0),
        FieldChoice("eigenfunction", index=4),
    )
    session.undo()
    session.undo()
    assert session.state.choices == (FieldChoice("distance", "wks"),)
    assert len(heard) == 7


@pytest.mark.parametrize("change", [{"layout": "heap"}, {"kind": "nonsense"}, {"method": "guess"}])
def test_words_that_nobody_knows_change_nothing(session, change):
    before = session.state
    act = {"layout": session.arrange, "kind": session.choose_field, "method": session.match}[next(iter(change))]
    act(**change)
    assert session.state == before
