"""Files that are opened and saved, and what the window says when that fails."""

from PySide6.QtCore import QMimeData, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent

from add_viewer.views.dialogs import PictureChoice

THIGH = 6868


def test_a_bad_file_shows_a_message_and_leaves_the_session_as_it_was(person, qtbot, tmp_path):
    person.open()
    person.click(THIGH)
    state = person.session.state
    path = tmp_path / "noise.ply"
    path.write_bytes(bytes(range(256)) * 4)
    person.window.open_requested.emit(str(path))
    qtbot.waitUntil(person.window.message.isVisible, timeout=10000)
    assert "noise.ply" in person.window.message.text.text()
    assert person.session.state is state
    person.window.message.close_button.click()
    assert not person.window.message.isVisible()


def test_files_are_opened_where_they_are_dropped(person, qtbot, tmp_path):
    from add_core.geometry import shapes
    from add_core.io import save_shape

    path = tmp_path / "ring.off"
    save_shape(shapes.torus(around=24, through=12), path)
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    middle, buttons, none = QPointF(300, 300), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    entering = QDragEnterEvent(middle.toPoint(), Qt.DropAction.CopyAction, data, buttons, none)
    person.window.dragEnterEvent(entering)
    assert entering.isAccepted()
    person.window.dropEvent(QDropEvent(middle, Qt.DropAction.CopyAction, data, buttons, none))
    qtbot.waitUntil(lambda: person.session.state.active is not None, timeout=10000)
    assert person.session.state.active.name == "ring"
    assert person.window.settings.recent == [str(path.resolve())]


def test_what_went_wrong_is_listed_and_stays_until_something_begun_later_succeeds(person, qtbot, tmp_path):
    for name in ("broken", "worse"):
        (tmp_path / f"{name}.off").write_text("OFF\nnonsense")
    window, text = person.window, person.window.message.text
    for reference in (tmp_path / "broken.off", "humans/0", tmp_path / "worse.off"):  # as if dropped together
        window.open_requested.emit(str(reference))
    qtbot.waitUntil(lambda: "worse.off" in text.text(), timeout=20000)
    assert person.session.state.active_key == "humans/0"
    assert window.message.isVisible()
    first, second = text.text().split("\n")
    assert ("broken.off" in first, "worse.off" in second) == (True, True)
    window.open_requested.emit(str(tmp_path / "worse.off"))
    qtbot.waitUntil(lambda: not person.results.busy)
    assert text.text().count("worse.off") == 1
    window.open_requested.emit("humans/1")
    qtbot.waitUntil(lambda: person.session.state.active_key == "humans/1", timeout=20000)
    assert not window.message.isVisible()


def test_a_second_shape_takes_the_pick_and_leaves_its_curves_in_sight(person, qtbot):
    person.open()
    person.click(THIGH)
    qtbot.waitUntil(lambda: bool(person.results.curves), timeout=20000)
    person.window.show_start()
    person.window.start.chosen.emit("humans/1")
    qtbot.waitUntil(lambda: len(person.session.state.shapes) == 2, timeout=20000)
    assert person.window.pages.currentWidget() is person.window.scene
    assert person.window.parameters.picks.field.text() == str(THIGH)
    assert [curves.pick.vertex for curves in person.results.curves] == [THIGH]
    assert person.results.carried["humans/1"][0].vertex == THIGH


def test_recent_files_that_are_gone_leave_the_list_and_damaged_ones_stay(person, qtbot, tmp_path):
    window, gone, damaged = person.window, tmp_path / "gone.off", tmp_path / "damaged.off"
    damaged.write_text("OFF")
    last = tmp_path / "gone.addsession"
    for reference in ("humans/0", str(gone), str(damaged), str(last)):
        window.remember(reference)
    for path, left in ((gone, 3), (damaged, 3), (last, 2)):
        window.message.clear()
        window.open_requested.emit(str(path))
        qtbot.waitUntil(lambda path=path: path.name in window.message.text.text(), timeout=20000)
        assert len(window.settings.recent) == len(window.start.recent) == left
    assert window.settings.recent == [str(damaged), "humans/0"]


def test_a_training_that_begins_clears_what_went_wrong_before(person, monkeypatch):
    person.results.report("an earlier failure")
    monkeypatch.setattr(person.assembly.training, "start", lambda request: None)
    person.assembly._train(None)
    assert person.window.message.isVisible()
    monkeypatch.setattr(person.assembly.training, "start", lambda request: "id")
    person.assembly._train(None)
    assert not person.window.message.isVisible()


def test_a_picture_that_cannot_be_written_is_told(person, tmp_path):
    person.open()
    path = tmp_path / "none" / "picture.png"
    person.assembly.saving.save_picture(path, PictureChoice(1, False, True))
    words = f"picture.png was not saved: No such file or directory ({path}). Choose a folder that is there."
    assert person.window.message.text.text() == words
