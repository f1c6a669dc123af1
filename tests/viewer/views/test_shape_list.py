"""The list of shapes by keys alone, and what a click on a box leaves alone."""

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication, QMenu, QStyle, QStyleOptionViewItem

from add_viewer.views.action_tour import plain

ALT, SHIFT = Qt.KeyboardModifier.AltModifier, Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def people(person, make_torus, qtbot):
    """Three shapes, the last of them the source, and the keyboard in their list."""
    for key in ("one", "two", "three"):
        person.session.add_shape(make_torus(key))
    shapes = person.window.parameters.shapes
    qtbot.waitUntil(person.window.isActiveWindow)
    shapes.setFocus()
    qtbot.waitUntil(shapes.hasFocus)
    return person


@pytest.fixture
def press(people, qtbot):
    return lambda *key: qtbot.keyClick(people.window.parameters.shapes, *key)


def visible(people) -> list[str]:
    return [shape.key for shape in people.session.state.shown]


def test_arrows_go_to_a_line_and_enter_makes_it_the_source(people, press):
    press(Qt.Key.Key_Up)
    press(Qt.Key.Key_Up)
    assert people.window.parameters.shapes.currentItem().text() == "one"
    assert people.session.state.active_key == "three"
    press(Qt.Key.Key_Return)
    assert people.session.state.active_key == "one"


def test_space_hides_and_shows_the_line_that_the_arrows_went_to(people, press):
    press(Qt.Key.Key_Up)
    press(Qt.Key.Key_Space)
    assert visible(people) == ["one", "three"]
    press(Qt.Key.Key_Up)
    press(Qt.Key.Key_Space)
    assert visible(people) == ["three"]
    press(Qt.Key.Key_Space)
    assert visible(people) == ["one", "three"]


def test_space_on_the_source_hides_nothing_now_or_later(people, press):
    press(Qt.Key.Key_Space)
    assert visible(people) == ["one", "two", "three"]
    people.session.show_shape("one")
    assert visible(people) == ["one", "two", "three"]


def test_alt_and_arrows_move_the_line_and_the_keyboard_stays_on_it(people, press):
    press(Qt.Key.Key_Up, ALT)
    press(Qt.Key.Key_Up, ALT)
    press(Qt.Key.Key_Up, ALT)
    assert [shape.key for shape in people.session.state.shapes] == ["three", "one", "two"]
    press(Qt.Key.Key_Down)
    press(Qt.Key.Key_Down, ALT)
    assert [shape.key for shape in people.session.state.shapes] == ["three", "two", "one"]
    assert people.window.parameters.shapes.currentItem().text() == "one"


def test_delete_closes_the_line_goes_to_its_neighbour_and_undo_brings_it_back(people, press):
    press(Qt.Key.Key_Up)
    press(Qt.Key.Key_Up)
    press(Qt.Key.Key_Delete)
    assert [shape.key for shape in people.session.state.shapes] == ["two", "three"]
    assert people.window.parameters.shapes.currentItem().text() == "two"
    assert people.session.state.active_key == "three"
    people.session.undo()
    assert [shape.key for shape in people.session.state.shapes] == ["one", "two", "three"]


@pytest.mark.parametrize("key", [(Qt.Key.Key_Menu,), (Qt.Key.Key_F10, SHIFT)])
def test_the_menu_of_a_line_opens_by_keys_and_its_first_letters_work(people, press, qtbot, key):
    press(Qt.Key.Key_Up)
    press(*key)
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    words = [plain(action.text()).partition("\t") for action in menu.actions() if action.text()]
    assert [(each, key) for each, _, key in words] == [
        *(("Make it the source", "Enter"), ("Hide", "Space"), ("Move up", "Alt+Up"), ("Move down", "Alt+Down")),
        *(("Wireframe", ""), ("Close two", "Del")),
    ]
    qtbot.keyClick(menu, Qt.Key.Key_W)
    assert people.session.state.look("two").wireframe
    assert QApplication.activePopupWidget() is None
    assert people.window.parameters.shapes.currentItem().text() == "two"


def test_a_click_on_the_box_of_a_target_hides_it_and_leaves_the_source(people, qtbot):
    shapes = people.window.parameters.shapes
    option = QStyleOptionViewItem()
    shapes.initViewItemOption(option)
    option.rect = shapes.visualItemRect(shapes.item(0))
    option.features |= QStyleOptionViewItem.ViewItemFeature.HasCheckIndicator
    box = shapes.style().subElementRect(QStyle.SubElement.SE_ItemViewItemCheckIndicator, option, shapes)
    qtbot.mouseClick(shapes.viewport(), Qt.MouseButton.LeftButton, pos=box.center())
    assert visible(people) == ["two", "three"]
    assert people.session.state.active_key == "three"
    qtbot.mouseClick(shapes.viewport(), Qt.MouseButton.LeftButton, pos=option.rect.center() + QPoint(20, 0))
    assert people.session.state.active_key == "one"


def test_without_the_keyboard_the_list_marks_the_source(people, press):
    press(Qt.Key.Key_Up)
    people.canvas.setFocus()
    assert people.window.parameters.shapes.currentItem().text() == "three"


def test_the_menus_say_which_shape_closes_and_what_undo_takes_back(people, press):
    actions = people.window.menus.actions
    assert actions["close"].text() == "&Close three"
    press(Qt.Key.Key_Up)
    press(Qt.Key.Key_Space)
    assert actions["undo"].text() == "&Undo: hide two"
    assert actions["undo"].toolTip().startswith("Undo: hide two (Ctrl+Z)")
    people.session.undo()
    assert actions["redo"].text() == "&Redo: hide two"
    for key in ("one", "two", "three"):
        people.session.close_shape(key)
    assert actions["close"].text() == "&Close shape"
