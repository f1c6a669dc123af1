"""A shape that is still in use is not read a second time, unless its file has changed."""

import gc

import pytest
from numpy.testing import assert_array_equal

from add_core.errors import ShapeFileError
from add_viewer.controllers.rereading import Rereading


@pytest.fixture
def reading(make_torus):
    """What was read, in order, and the reader."""
    read: list[str] = []

    def work(reference: str):
        read.append(reference)
        if reference == "bad":
            raise ShapeFileError("no shape")
        return make_torus(reference)

    return read, Rereading(work)


def test_what_is_in_use_is_read_once_and_what_nobody_holds_anew(reading, tmp_path):
    read, reader = reading
    path = tmp_path / "a.off"
    path.write_text("one")
    held = reader(str(path))
    assert reader(str(path)) is held
    assert reader("humans/0") is not held
    assert read == [str(path), "humans/0"]
    del held
    gc.collect()
    reader(str(path))
    assert read[-1] == str(path)
    assert len(read) == 3


def test_a_changed_file_is_read_again(reading, tmp_path):
    read, reader = reading
    path = tmp_path / "a.off"
    path.write_text("one")
    held = reader(str(path))
    path.write_text("other")
    assert reader(str(path)) is not held
    assert len(read) == 2


def test_what_cannot_be_read_is_tried_again(reading):
    read, reader = reading
    for _ in range(2):
        with pytest.raises(ShapeFileError):
            reader("bad")
    assert read == ["bad", "bad"]


def test_shapes_that_undo_alone_keeps_forget_what_follows_from_the_rest(reading):
    _, reader = reading
    closed, shown = reader("closed").make_ready(), reader("shown").make_ready()
    normals = closed.shape.vertex_normals.copy()
    reader.lighten((shown,))
    assert "vertex_normals" not in vars(closed.shape)
    assert "vertex_normals" in vars(shown.shape)
    assert_array_equal(closed.shape.vertex_normals, normals)
    assert closed.coarse is None
