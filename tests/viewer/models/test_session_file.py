"""Sessions as files: whole, portable, and checked like anything that a person opens."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from add_viewer.models.kept_mirror import packed
from add_viewer.models.session import Session
from add_viewer.models.session_file import (
    CameraPlace,
    KeptSession,
    KeptShape,
    SessionFileError,
    read_session,
    session_text,
)


@pytest.fixture
def session(make_torus, tmp_path: Path):
    """Two shapes, one of them a file, with everything changed that can be changed."""
    made = Session()
    made.add_shape(replace(make_torus("humans/0"), reference="humans/0"))
    file = str(tmp_path / "data" / "ring.off")
    made.add_shape(replace(make_torus(file), reference=file, name="ring"))
    made.diffuse(alpha=12.5, theta=1.25, reach=0.4, conductivity="constant")
    made.pick(3)
    made.pick_partner(3, 40)
    made.pick(7, add=True, shape="humans/0")
    made.choose_field(kind="distance", descriptor=str(tmp_path / "models" / "mine.safetensors"), saturation=70.0)
    made.choose_comparison(replace(made.state.field, kind="eigenfunction", index=5))
    made.arrange(layout="strip", linked=False, common_range=True)
    made.match(method="zoomout", descriptor="wks", refined=True)
    made.set_look("humans/0", wireframe=True, point_size=2.0)
    return made


def test_everything_comes_back(session, tmp_path):
    cameras = (CameraPlace(1, 0, 30.0, -10.0, (0.1, 0.2, 0.3), 2.5),)
    path = tmp_path / "talk.addsession"
    path.write_text(session_text(KeptSession.of(session.state, cameras, "bGF5b3V0"), tmp_path), encoding="utf-8")
    kept = read_session(path)
    assert kept.state(session.state.shapes) == session.state
    assert (kept.cameras, kept.layout) == (cameras, "bGF5b3V0")


def test_a_mirror_map_that_was_found_comes_back(session, tmp_path):
    shape = session.state.shapes[0]
    symmetry = np.random.default_rng(0).permutation(shape.vertex_count)
    bare = [replace(each, symmetry=None, symmetry_confidence=None) for each in session.state.shapes]
    session.restore(replace(session.state, shapes=tuple(bare)))
    session.learn_symmetry(shape.key, symmetry, 0.75)
    path = tmp_path / "talk.addsession"
    path.write_text(session_text(KeptSession.of(session.state), tmp_path), encoding="utf-8")
    found, other = read_session(path).state(bare).shapes
    assert np.array_equal(found.symmetry, symmetry)
    assert found.symmetry_confidence == 0.75
    assert other is bare[1]


def test_a_mirror_map_that_does_not_fit_is_left_out(make_torus):
    shape = replace(make_torus("ring"), symmetry=None, symmetry_confidence=None)
    count = shape.vertex_count
    wrong = [np.arange(count - 1), np.arange(count + 1), np.full(count, count), np.full(count, -1)]
    for mirror in ("", "!", "AAAA", *map(packed, wrong)):
        assert KeptShape("ring", mirror=mirror, confidence=0.5).with_mirror(shape) is shape
    fits = KeptShape("ring", mirror=packed(np.arange(count)), confidence=0.5).with_mirror(shape)
    assert fits.symmetry is not None


def test_a_mirror_map_that_came_with_the_shape_is_not_kept(session):
    known = replace(
        session.state.shapes[0], symmetry=np.arange(session.state.shapes[0].vertex_count), symmetry_confidence=None
    )
    assert known.found_mirror == ""


def test_a_folder_moves_as_a_whole(session, tmp_path):
    here, there = tmp_path / "here", tmp_path / "there"
    shape = replace(session.state.shapes[1], reference=str(here / "data" / "ring.off"))
    state = replace(session.state, shapes=(session.state.shapes[0], shape))
    here.mkdir()
    (here / "a.addsession").write_text(session_text(KeptSession.of(state), here), encoding="utf-8")
    here.rename(there)
    references = [kept.reference for kept in read_session(there / "a.addsession").shapes]
    assert references == ["humans/0", str(there / "data" / "ring.off")]


def test_no_path_of_this_machine_is_in_the_file(session, tmp_path):
    assert str(tmp_path) not in session_text(KeptSession.of(session.state), tmp_path)


def test_what_cannot_be_opened_leaves_the_rest(session, tmp_path):
    humans = session.state.shapes[0]
    state = KeptSession.of(session.state).state([humans, None])
    assert state.shapes == (humans,)
    assert state.active_key == humans.key
    assert {pick.shape for pick in state.picks} == {humans.key}
    assert state.diffusion == session.state.diffusion


def test_picks_that_a_changed_file_no_longer_has_are_left_out(session, make_torus):
    kept = KeptSession.of(session.state)
    far = replace(kept, picks=(replace(kept.picks[0], vertex=10**9), replace(kept.picks[0], mirror_of=10**9)))
    assert far.state(session.state.shapes).picks == ()


GOOD = {"format": "add-viewer session", "version": 1, "shapes": [{"reference": "humans/0"}]}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "no JSON"),
        ("[" * 100_000, "no JSON"),
        ("[]", "format"),
        ("{}", "format"),
        ({**GOOD, "version": 2}, "Update the app"),
        ({**GOOD, "version": "one"}, "reads version 1"),
        ({**GOOD, "shapes": 3}, "shapes must be a list"),
        ({**GOOD, "shapes": [{"name": "x"}]}, "shapes[0] is incomplete"),
        ({**GOOD, "shapes": [{"reference": 3}]}, "shapes[0].reference must be a text"),
        ({**GOOD, "picks": [{"shape": 0, "vertex": 1.5, "slot": 0}]}, "picks[0].vertex must be a whole number"),
        ({**GOOD, "picks": [{"shape": True, "vertex": 1, "slot": 0}]}, "picks[0].shape must be a whole number"),
        ({**GOOD, "diffusion": {"alpha": "much"}}, "diffusion.alpha must be a number"),
        ({**GOOD, "diffusion": {"alpha": float("nan")}}, "diffusion.alpha must be a number"),
        ({**GOOD, "field": {"kind": "smell"}}, "field.kind must be one of"),
        ({**GOOD, "cameras": [{"shape": 0, "focal": [1, 2]}]}, "cameras[0].focal must be a list of 3"),
        ({**GOOD, "arrangement": {"linked": 1}}, "arrangement.linked must be true or false"),
    ],
)
def test_a_bad_file_is_one_clear_message(content, words, tmp_path):
    path = tmp_path / "bad.addsession"
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    with pytest.raises(SessionFileError) as error:
        read_session(path)
    assert words in str(error.value)
    assert str(error.value).startswith("bad.addsession")
    assert "\n" not in str(error.value)


def test_a_file_that_is_no_text_is_told(tmp_path):
    path = tmp_path / "bad.addsession"
    path.write_bytes(b"\xff\xfe\x00" * 100)
    with pytest.raises(SessionFileError, match="no JSON"):
        read_session(path)


def test_what_is_missing_has_its_default_and_what_is_out_of_range_is_brought_back(tmp_path, torus):
    path = tmp_path / "short.addsession"
    path.write_text(json.dumps({**GOOD, "diffusion": {"alpha": 1e9}, "field": {"index": -4}, "later": 1}))
    state = read_session(path).state([torus])
    assert (state.diffusion.alpha, state.field.index, state.active_key) == (200.0, 0, "torus")
