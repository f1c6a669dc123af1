"""Opening shapes: shipped names, files, and everything that can be wrong with them. No Qt."""

import numpy as np
import pytest

from add_core.errors import AddError
from add_core.geometry import PointCloud, shapes
from add_core.io import SHIPPED, save_shape
from add_viewer.controllers.opening import OpeningController, read_shape
from add_viewer.models.results import Results
from add_viewer.models.session import Session


@pytest.fixture
def parts(run):
    session, results = Session(), Results()
    controller = OpeningController(session, results, run)
    heard = []
    results.noticed.connect(lambda notice: heard.append(notice.text))
    return session, results, controller, heard


def test_a_shipped_name_opens_with_its_mirror_map_unit_and_axes():
    opened = read_shape("humans/3")
    assert opened.vertex_count == 6890
    assert (opened.up, opened.front, opened.unit) == ("+z", "-y", "m")
    assert opened.mirror(opened.mirror(10) or 10) == 10
    assert 1.0 < opened.diameter < 3.0


def test_the_scale_relates_the_shown_shape_to_the_file_s(tmp_path):
    path = tmp_path / "ball.ply"
    save_shape(shapes.sphere(2, radius=7.0), path)
    opened = read_shape(str(path))
    assert np.linalg.norm(opened.shape.vertices, axis=1).max() * opened.diameter == pytest.approx(7.0, rel=1e-5)
    assert opened.diameter == pytest.approx(7.0 * np.pi, rel=0.05)


@pytest.mark.parametrize("name", SHIPPED)
def test_a_number_beyond_a_collection_is_explained(name):
    with pytest.raises(AddError, match=f"{name} holds shapes {name}/0 to"):
        read_shape(f"{name}/1000")


def test_a_bad_file_is_told_and_leaves_the_session_as_it_was(parts, run, tmp_path, torus):
    session, results, controller, heard = parts
    session.add_shape(torus)
    state = session.state
    path = tmp_path / "broken.off"
    path.write_text("OFF\nthis is no mesh\n")
    controller.open(path)
    assert "Opening" in results.busy
    run.answer_all()
    assert session.state is state
    assert len(heard) == 1
    assert "broken.off" in heard[0]
    assert results.busy == ""


def test_a_missing_file_is_told(parts, run):
    _, _, controller, heard = parts
    controller.open("/nowhere/at/all.ply")
    run.answer_all()
    assert "all.ply" in heard[0]


def test_several_files_open_in_order_and_the_last_is_shown(parts, run):
    session, _, controller, _ = parts
    controller.open("humans/0")
    controller.open("humans/1")
    run.answer_all()
    assert [shape.key for shape in session.state.shapes] == ["humans/0", "humans/1"]
    assert session.state.active_key == "humans/1"


@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_shape_is_whole(name):
    collection = SHIPPED[name]()
    for shape in collection:
        assert np.isfinite(shape.vertices).all()
        assert isinstance(shape, PointCloud) or shape.has_area.all()
        assert collection.symmetry is None or shape.vertex_count == len(collection.symmetry)
