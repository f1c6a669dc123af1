"""What keys do: they belong to the control with the focus first, and to nothing that cannot be seen."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

CONTROL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


@pytest.mark.parametrize("key", [Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter])
def test_space_and_enter_press_the_focused_control_and_play_nothing(person, qtbot, key):
    person.open()
    window, show = person.window, person.assembly.exploring.chooser.buttons[0]
    clicks = []
    window.parameters.fold.show()
    for button in (show, window.parameters.fold):
        button.clicked.connect(lambda *_, button=button: clicks.append(button))
        button.setFocus()
        keypad = Qt.KeyboardModifier.KeypadModifier if key == Qt.Key.Key_Enter else Qt.KeyboardModifier.NoModifier
        qtbot.keyClick(button, key, keypad)
        person.assembly.exploring.chooser.list.close()
    assert clicks == [show, window.parameters.fold]
    window.parameters.model.setFocus()
    qtbot.keyClick(window.parameters.model, key)
    assert window.parameters.model.view().isVisible()
    window.parameters.model.hidePopup()
    assert not window.parameters.play.isChecked()


@pytest.mark.parametrize("floating", [False, True])
def test_space_in_a_list_ticks_its_line_and_plays_nothing(person, qtbot, floating):
    person.open()
    person.open("humans/1")
    person.window.parameter_dock.setFloating(floating)
    shapes, ticked = person.window.parameters.shapes, []
    shapes.itemChanged.connect(lambda item: ticked.append(item.text()))
    shapes.activateWindow()
    shapes.setFocus()
    qtbot.waitUntil(shapes.hasFocus, timeout=2000)
    qtbot.keyClick(shapes, Qt.Key.Key_Space)
    assert ticked == [person.session.state.active.name]
    assert not person.window.parameters.play.isChecked()


def test_space_plays_once_a_shape_is_open_and_after_a_click_on_it(person, qtbot):
    window, start = person.window, person.window.start
    start.list.setFocus()
    qtbot.waitUntil(start.list.hasFocus, timeout=2000)
    person.open()
    for _ in range(2):
        qtbot.waitUntil(person.canvas.hasFocus, timeout=2000)
        qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Space)
        assert window.parameters.play.isChecked()
        window.parameters.play.setChecked(False)
        person.assembly.exploring.chooser.buttons[0].setFocus()
        person.click(6868)


def test_nothing_is_done_to_shapes_unseen_and_escape_leads_back_to_them(person, qtbot):
    person.open()
    person.session.pick(6868)
    window, before = person.window, person.session.state
    actions = window.menus.actions
    qtbot.keyClick(person.canvas, Qt.Key.Key_O, CONTROL | SHIFT)
    assert window.pages.currentWidget() is window.start
    assert not [
        name
        for name in ("close", "figure", "animation", "explore_symmetry", "layout:single")
        if actions[name].isEnabled()
    ]
    for key, modifier in ((Qt.Key.Key_W, CONTROL), (Qt.Key.Key_S, Qt.KeyboardModifier.NoModifier)):
        qtbot.keyClick(window.start, key, modifier)
    person.session.history_changed.emit()  # what is enabled again meanwhile waits as well
    assert not actions["clear"].isEnabled()
    qtbot.keyClick(window.start, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: window.pages.currentWidget() is window.scene, timeout=2000)
    assert person.session.state == before
    assert [actions[name].isEnabled() for name in ("clear", "close", "redo", "layout:single")] == [
        True,
        True,
        False,
        True,
    ]
    qtbot.keyClick(person.canvas, Qt.Key.Key_Escape)
    assert not person.session.state.active_picks


@pytest.mark.parametrize("keys", [Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier])
def test_arrows_move_what_is_seen_their_way_and_plus_and_minus_come_closer_and_go_away(person, qtbot, keys):
    person.open()
    canvas, shape = person.canvas, person.session.state.active.shape
    eye = canvas.camera_model.axes[2]
    nose = int((shape.vertices @ eye).argmax())  # the point nearest to the eye goes the way that the shape turns
    for key, x, y in (
        (Qt.Key.Key_Right, 1, 0),
        (Qt.Key.Key_Left, -1, 0),
        (Qt.Key.Key_Up, 0, -1),
        (Qt.Key.Key_Down, 0, 1),
    ):
        before = canvas.place_of(nose)
        qtbot.keyClick(canvas, key, keys)
        moved = canvas.place_of(nose) - before
        assert abs(moved.x()) > 5 if x else abs(moved.x()) < 5
        assert moved.x() * x + moved.y() * y > 5
    away = canvas.camera_model.distance
    qtbot.keyClick(canvas, Qt.Key.Key_Plus)
    assert canvas.camera_model.distance < 0.95 * away
    qtbot.keyClick(canvas, Qt.Key.Key_Minus)
    assert canvas.camera_model.distance == pytest.approx(away)
