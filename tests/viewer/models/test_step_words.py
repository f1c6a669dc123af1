"""Undo says what it takes back, and redo what it does again."""

import numpy as np
import pytest

from add_viewer.models.fields import FieldChoice
from add_viewer.models.session import Session
from add_viewer.models.step_words import words_of


@pytest.fixture
def session(make_torus) -> Session:
    session = Session()
    for key in ("one", "two"):
        session.add_shape(make_torus(key))
    return session


CHANGES = {
    "pick vertex 3": lambda session: session.pick(3),
    "remove vertex 7": lambda session: session.unpick(7),
    "clear the picks": lambda session: session.clear_picks(),
    "turn θ": lambda session: session.diffuse(theta=1.0),
    "change α": lambda session: session.diffuse(alpha=3.0),
    "change t": lambda session: session.diffuse(reach=0.5),
    "change the conductivity": lambda session: session.diffuse(conductivity="constant"),
    "close one": lambda session: session.close_shape("one"),
    "go to one": lambda session: session.show_shape("one"),
    "reorder the shapes": lambda session: session.move_shape("two", 0),
    "hide one": lambda session: session.set_look("one", visible=False),
    "wireframe of one": lambda session: session.set_look("one", wireframe=True),
    "point size of two": lambda session: session.set_look("two", point_size=2.0),
    "show Distance in WKS": lambda session: session.choose_field(kind="distance", descriptor="wks"),
    "show Distance in HKS beside": lambda session: session.choose_comparison(FieldChoice("distance", "hks")),
    "views in one row": lambda session: session.arrange(layout="strip"),
    "free the cameras": lambda session: session.arrange(linked=False),
    "one range of colours": lambda session: session.arrange(common_range=True),
    "change the matching": lambda session: session.match(method="zoomout"),
    "mirror map of one": lambda session: session.learn_symmetry(
        "one", np.arange(session.state.shapes[0].vertex_count), 0.9
    ),
}


@pytest.mark.parametrize("words", CHANGES)
def test_a_step_has_the_same_words_before_and_after_it_is_undone(session, words):
    session.pick(7)
    CHANGES[words](session)
    assert words_of(session.undo_step) == words
    session.undo()
    assert words_of(session.redo_step) == words
    session.redo()
    assert words_of(session.undo_step) == words


def test_opening_names_the_shape_and_without_steps_there_are_no_words(session):
    assert words_of(session.undo_step) == "open two"
    session.undo()
    assert words_of(session.undo_step) == "open one"
    session.undo()
    assert session.undo_step is None
    assert words_of(session.redo_step) == "open one"


def test_picking_again_one_of_several_picked_points_names_it(session):
    session.pick(3)
    session.pick(5, add=True)
    session.pick(3)
    assert words_of(session.undo_step) == "pick vertex 3"
