"""The command palette and the shortcut sheet, driven by keys."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel

from add_viewer.views.action_tour import plain, tour

CONTROL_SHIFT = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def palette(person, qtbot):
    """The palette, opened by its keys."""
    qtbot.waitUntil(person.window.isActiveWindow)
    qtbot.keyClick(person.window, Qt.Key.Key_P, CONTROL_SHIFT)
    opened = person.window.aids.palette
    assert opened.isVisible()
    assert opened.field.hasFocus()
    return opened


def shown(palette) -> list[str]:
    return [palette.list.item(row).text() for row in range(palette.list.count())]


def test_typing_and_enter_do_what_the_menu_would(person, palette, qtbot):
    qtbot.keyClicks(palette.field, "dark")
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: person.window.display["theme"] == "dark")
    assert not palette.isVisible()


def test_letters_that_are_shortcuts_elsewhere_are_letters_here(person, palette, qtbot):
    before = person.window.display.as_dict()
    qtbot.keyClicks(palette.field, "wdbn?1 ")
    assert palette.field.text() == "wdbn?1 "
    assert person.window.display.as_dict() == before


def test_arrows_choose_and_escape_leaves_the_picks_alone(person, palette, qtbot):
    palette.leave()
    person.open()
    person.session.pick(100)
    qtbot.keyClick(person.window, Qt.Key.Key_P, CONTROL_SHIFT)
    qtbot.keyClick(palette.field, Qt.Key.Key_Down)
    qtbot.keyClick(palette.field, Qt.Key.Key_Down)
    qtbot.keyClick(palette.field, Qt.Key.Key_Up)
    assert palette.list.currentRow() == 1
    qtbot.keyClick(palette.field, Qt.Key.Key_Escape)
    assert not palette.isVisible()
    assert [pick.vertex for pick in person.session.state.picks] == [100]


def test_every_action_of_the_menus_is_there_with_its_key(person, palette):
    offered = {(command.section, command.title): command.key for command in palette._commands}
    for stop in tour(person.window.menuBar()):
        assert offered[stop.menu, stop.title] == ", ".join(stop.keys)
    assert set(person.window.menus.actions) <= {_name(person, stop.action) for stop in tour(person.window.menuBar())}


def _name(person, action) -> str:
    return next((name for name, each in person.window.menus.actions.items() if each is action), "")


def test_what_was_done_last_is_offered_first_also_after_a_restart(person, palette, qtbot):
    qtbot.keyClicks(palette.field, "wireframe")
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: person.window.display["wireframe"])
    palette.open()
    assert shown(palette)[0] == "Wireframe"
    assert person.window.settings.recent_commands[0] == "View: Wireframe"


def test_a_shipped_shape_opens_by_its_name(person, palette, qtbot):
    qtbot.keyClicks(palette.field, "dog 4")
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: person.session.state.active_key == "dogs/3", timeout=90000)


def test_what_cannot_be_done_now_does_nothing(person, palette, qtbot):
    qtbot.keyClicks(palette.field, "redo")
    assert shown(palette)[0] == "Redo"
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    assert palette.isVisible()


@pytest.mark.parametrize("key", [Qt.Key.Key_F1, Qt.Key.Key_Question])
def test_the_sheet_lists_every_key_of_every_action(person, qtbot, key):
    qtbot.waitUntil(person.window.isActiveWindow)
    qtbot.keyClick(person.window, key)
    sheet = person.window.aids.sheet
    assert sheet.isVisible()
    texts = {label.text() for label in sheet.findChildren(QLabel)}
    with_keys = [stop for stop in tour(person.window.menuBar()) if stop.keys]
    assert {stop.title for stop in with_keys} | {" or ".join(stop.keys) for stop in with_keys} <= texts
    assert "Alt + click" in texts
    sheet.close()


def test_plain_words_have_no_mnemonic():
    assert plain("Save && e&xport…") == "Save & export"


def test_copy_as_script_puts_python_on_the_clipboard(person, make_torus, qtbot):
    qtbot.waitUntil(person.window.isActiveWindow)
    assert not person.window.menus.actions["script"].isEnabled()
    person.session.add_shape(make_torus())
    person.session.pick(7)
    qtbot.keyClick(person.window, Qt.Key.Key_C, CONTROL_SHIFT)
    script = person.assembly.app.clipboard().text()
    compile(script, "script.py", "exec")
    assert "picks = {'torus': [7]}" in script
    assert "HeatFlow" in script
