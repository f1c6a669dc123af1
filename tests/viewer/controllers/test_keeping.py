"""Sessions are saved whole, opened as far as possible, and survive the end of the app."""

from dataclasses import replace
from pathlib import Path

import pytest

from add_viewer.controllers.keeping import KeepingController, Process
from add_viewer.models.results import Results
from add_viewer.models.session import Session
from add_viewer.models.session_file import read_session


class Apps:
    """Apps that share a folder, each a process that can be alive or not."""

    def __init__(self, home: Path, run, make_torus) -> None:
        self.home, self.run, self.alive = home, run, set[int]()
        self.shapes = {name: replace(make_torus(name), reference=name) for name in ("one", "two")}

    def start(self, pid: int) -> KeepingController:
        self.alive.add(pid)
        process = Process(pid, "then", lambda pid, began: pid in self.alive and began == "then")
        session, results = Session(), Results()
        self.notices: list[str] = []
        results.noticed.connect(lambda notice: self.notices.append(notice.text))
        self.later = []
        app = KeepingController(session, results, self.run, self.later.append, process, home=self.home, read=self._read)
        app.session = session
        return app

    def _read(self, reference: str):
        if reference not in self.shapes:
            raise FileNotFoundError(2, "No such file or directory", reference)
        return self.shapes[reference]

    def crash(self, pid: int) -> None:
        self.alive.discard(pid)


@pytest.fixture
def apps(tmp_path, run, make_torus) -> Apps:
    return Apps(tmp_path / "home", run, make_torus)


def work_in(app: KeepingController, apps: Apps) -> None:
    for shape in apps.shapes.values():
        app.session.add_shape(shape)
    app.session.diffuse(alpha=12.0)
    app.session.pick(5)


def test_a_saved_session_opens_as_it_was_and_undo_brings_the_other_back(apps, tmp_path):
    app, path = apps.start(1), tmp_path / "a.addsession"
    work_in(app, apps)
    kept = app.session.state
    app.save(path)
    app.session.close_shape("one")
    app.session.diffuse(alpha=3.0)
    other = app.session.state
    app.open(path)
    apps.run.answer_all()
    assert app.session.state == kept
    app.session.undo()
    assert app.session.state == other


def test_missing_shapes_are_told_and_the_rest_opens(apps, tmp_path):
    app, path = apps.start(1), tmp_path / "a.addsession"
    work_in(app, apps)
    app.save(path)
    del apps.shapes["one"]
    app.open(path)
    apps.run.answer_all()
    assert [shape.name for shape in app.session.state.shapes] == ["two"]
    assert "one is missing" in apps.notices[0]


def test_a_shape_that_changed_is_told(apps, tmp_path, make_torus):
    app, path = apps.start(1), tmp_path / "a.addsession"
    work_in(app, apps)
    app.save(path)
    path.write_text(path.read_text().replace('"vertices": 288', '"vertices": 300'))
    app.open(path)
    apps.run.answer_all()
    assert "one has changed: it had 300 vertices and has 288." in apps.notices[0]


def test_a_bad_file_leaves_the_session_as_it_is(apps, tmp_path):
    app, path = apps.start(1), tmp_path / "a.addsession"
    work_in(app, apps)
    before = app.session.state
    path.write_text("{}")
    app.open(path)
    app.open(tmp_path / "nowhere.addsession")
    apps.run.answer_all()
    assert app.session.state == before
    assert "no session of this app" in apps.notices[0]
    assert "nowhere.addsession" in apps.notices[1]


def test_a_crash_leaves_the_session_and_the_next_app_goes_on(apps):
    app = apps.start(1)
    work_in(app, apps)
    lost = app.session.state
    assert len(apps.later) == 1, "changes in a row are kept together"
    apps.later.pop()()
    apps.crash(1)
    second = apps.start(2)
    (leftover,) = second.leftovers()
    second.restore(leftover)
    apps.run.answer_all()
    assert second.session.state == lost
    assert second.leftovers() == []
    apps.crash(2)  # before any change
    (leftover,) = apps.start(3).leftovers()
    assert len(leftover.kept.shapes) == 2


def test_a_running_app_is_not_taken_for_a_crashed_one(apps):
    first = apps.start(1)
    work_in(first, apps)
    first.remember()
    second = apps.start(2)
    assert second.leftovers() == []
    work_in(second, apps)
    second.remember()
    second.end()
    apps.crash(1)
    assert len(apps.start(3).leftovers()) == 1


def test_two_apps_cannot_both_have_what_a_third_left(apps):
    app = apps.start(1)
    work_in(app, apps)
    app.remember()
    apps.crash(1)
    second, third = apps.start(2), apps.start(3)
    (mine,), (yours,) = second.leftovers(), third.leftovers()
    second.restore(mine)
    third.restore(yours)
    apps.run.answer_all()
    assert len(second.session.state.shapes) == 2
    assert third.session.state.shapes == ()
    assert "another window" in apps.notices[0]


def test_discarding_and_closing_leave_nothing_to_ask_about(apps):
    app = apps.start(1)
    work_in(app, apps)
    app.remember()
    apps.crash(1)
    second = apps.start(2)
    second.discard(second.leftovers()[0])
    assert second.leftovers() == []
    work_in(second, apps)
    second.remember()
    second.end()
    apps.crash(2)
    third = apps.start(3)
    assert third.leftovers() == []
    assert len(read_session(third.last).shapes) == 2
    third.open_last()
    apps.run.answer_all()
    assert len(third.session.state.shapes) == 2
    assert third.path is None, "the next Ctrl+S must ask where"


def test_an_empty_session_is_nothing_to_ask_about(apps):
    app = apps.start(1)
    app.remember()
    apps.crash(1)
    assert apps.start(2).leftovers() == []


def test_a_folder_that_cannot_be_written_is_told_once(apps, tmp_path):
    apps.home.write_text("in the way")
    app = apps.start(1)
    work_in(app, apps)
    app.remember()
    app.remember()
    assert len(apps.notices) == 1
    assert "Ctrl+S" in apps.notices[0]
