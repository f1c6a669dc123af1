"""Several shapes side by side, driven like a person drives them."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, QRect, QSize, Qt
from PySide6.QtGui import QImage, QPainter

from add_viewer.models.fields import FieldChoice, ShapeField

THIGH = 6868


@pytest.fixture
def people(person):
    person.open("humans/0")
    person.open("humans/1")
    return person


def view(person, key, panel=0):
    return next(each for each in person.window.scene.views if (each.key, each.panel) == (key, panel))


def click(person, qtbot, key, vertex, modifier=Qt.KeyboardModifier.NoModifier):
    canvas = view(person, key).canvas
    qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, modifier, canvas.place_of(vertex).toPoint())


def test_a_second_shape_stands_beside_the_first_and_a_click_on_either_makes_it_the_source(people, qtbot):
    assert [each.key for each in people.window.scene.views] == ["humans/0", "humans/1"]
    click(people, qtbot, "humans/0", THIGH)
    assert people.session.state.active_key == "humans/0"
    assert people.window.view is view(people, "humans/0")
    click(people, qtbot, "humans/1", THIGH)
    assert people.session.state.active_key == "humans/1"
    assert [pick.shape for pick in people.session.state.picks] == ["humans/1"]


def test_a_pick_is_carried_to_the_other_shape_and_both_take_colour(people, qtbot):
    before = [np.array(_pixels(each)) for each in people.window.scene.views]
    click(people, qtbot, "humans/0", THIGH)
    assert [pick.vertex for pick in people.results.carried["humans/1"]] == [THIGH]
    qtbot.waitUntil(lambda: {key for _, key in people.results.fields} == {"humans/0", "humans/1"}, timeout=20000)
    for each, bare in zip(people.window.scene.views, before, strict=True):
        assert (np.abs(_pixels(each) - bare).max(axis=2) > 60).mean() > 0.005


def test_linked_cameras_turn_together_and_free_ones_do_not(people, qtbot):
    one, two = (view(people, key).canvas for key in ("humans/0", "humans/1"))

    def drag():
        start = QPoint(20, one.height() // 2)
        qtbot.mousePress(one, Qt.MouseButton.LeftButton, pos=start)
        for step in range(1, 6):
            qtbot.mouseMove(one, start + QPoint(8 * step, 0))
        qtbot.mouseRelease(one, Qt.MouseButton.LeftButton, pos=start + QPoint(40, 0))

    drag()
    assert one.camera_model.azimuth == two.camera_model.azimuth != 0.0
    qtbot.keyClick(people.window, Qt.Key.Key_L)
    assert not people.session.state.arrangement.linked
    turned = two.camera_model.azimuth
    drag()
    assert two.camera_model.azimuth == turned != one.camera_model.azimuth
    qtbot.keyClick(people.window, Qt.Key.Key_L)  # linked again: all look as the source does
    assert one.camera_model.azimuth == two.camera_model.azimuth == turned


def test_hidden_and_closed_shapes_have_no_view_and_undo_brings_them_back(people, qtbot):
    shapes = people.window.parameters.shapes
    shapes.item(0).setCheckState(Qt.CheckState.Unchecked)
    assert [each.key for each in people.window.scene.views] == ["humans/1"]
    people.session.undo()
    assert [each.key for each in people.window.scene.views] == ["humans/0", "humans/1"]
    qtbot.keyClick(people.window, Qt.Key.Key_W, Qt.KeyboardModifier.ControlModifier)
    assert [each.key for each in people.window.scene.views] == ["humans/0"]
    people.session.undo()
    assert [each.key for each in people.window.scene.views] == ["humans/0", "humans/1"]
    assert shapes.item(0).checkState() == Qt.CheckState.Checked


def test_a_line_of_the_list_makes_its_shape_the_source(people, qtbot):
    shapes = people.window.parameters.shapes
    place = shapes.visualItemRect(shapes.item(0)).center()
    qtbot.mouseClick(shapes.viewport(), Qt.MouseButton.LeftButton, pos=place)
    assert people.session.state.active_key == "humans/0"
    assert people.window.view.key == "humans/0"


def test_a_line_dragged_elsewhere_moves_its_view(people):
    shapes = people.window.parameters.shapes
    shapes.model().moveRow(shapes.rootIndex(), 1, shapes.rootIndex(), 0)
    assert [shape.key for shape in people.session.state.shapes] == ["humans/1", "humans/0"]
    assert [each.key for each in people.window.scene.views] == ["humans/1", "humans/0"]
    people.session.undo()
    assert [shapes.item(row).text() for row in range(2)] == [shape.name for shape in people.session.state.shapes]


def test_a_split_view_shows_two_fields_of_each_shape(people, qtbot):
    click(people, qtbot, "humans/0", THIGH)
    people.session.choose_comparison(FieldChoice("heat"))
    assert [(each.panel, each.key) for each in people.window.scene.views] == [
        (panel, key) for panel in (0, 1) for key in ("humans/0", "humans/1")
    ]
    qtbot.waitUntil(lambda: len(people.results.fields) == 4, timeout=20000)
    people.session.choose_comparison(None)
    assert len(people.window.scene.views) == 2
    assert {panel for panel, _ in people.results.fields} == {0}


def test_one_range_of_colours_makes_colour_bars_agree(people, qtbot):
    click(people, qtbot, "humans/0", THIGH)
    qtbot.waitUntil(lambda: len(people.results.fields) == 2, timeout=20000)
    tops = [each.field.scale.high for each in people.window.scene.views]
    assert tops[0] != tops[1]
    qtbot.keyClick(people.window, Qt.Key.Key_R)
    assert [each.field.scale.high for each in people.window.scene.views] == [max(tops)] * 2


def test_the_source_alone_can_be_shown(people):
    people.window.menus.actions["layout:single"].trigger()
    assert [each.key for each in people.window.scene.views] == ["humans/1"]
    people.window.menus.actions["layout:strip"].trigger()
    assert len(people.window.scene.views) == 2


def test_a_hidden_view_holds_no_pictures_and_shows_the_same_again(people, qtbot):
    other = view(people, "humans/0").canvas

    def size_drawn_into():
        pictures = other.render_window.GetRenderFramebuffer().GetColorAttachmentAsTextureObject(0)
        return pictures.GetWidth(), pictures.GetHeight()

    ratio = other.devicePixelRatioF()
    full = round(ratio * other.width()), round(ratio * other.height())
    qtbot.waitUntil(lambda: size_drawn_into() == full)
    before = _pixels(view(people, "humans/0"))
    people.session.arrange(layout="single")
    qtbot.waitUntil(lambda: not other.isVisible())
    assert size_drawn_into() == (1, 1)
    people.session.arrange(layout="grid")
    qtbot.waitUntil(lambda: size_drawn_into() == full)
    qtbot.waitUntil(lambda: np.abs(_pixels(view(people, "humans/0")) - before).max() < 24)
    for key in ("humans/0", "humans/1"):
        people.session.close_shape(key)
    other.makeCurrent()
    other.paintGL()  # as Qt does when it resizes what it is about to show
    assert size_drawn_into() == (1, 1)


def test_a_view_without_room_keeps_its_camera_a_number(people):
    canvas = view(people, "humans/0").canvas
    canvas.setFixedWidth(0)
    canvas.fit()
    assert np.isfinite(canvas.camera_model.focal).all()
    assert np.isfinite(canvas.camera_model.distance)


def test_a_picture_of_several_views_is_one_picture(people, tmp_path):
    image = people.window.scene.picture(2)
    assert (image.width(), image.height()) == (2 * people.window.scene.width(), 2 * people.window.scene.height())


def _pixels(each):

    image = each.canvas.grabFramebuffer().convertToFormat(QImage.Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(int)


def test_the_discs_of_a_cloud_grow_with_the_picture(people, qtbot):
    """Twice as many pixels must not show gaps between the points."""
    people.open("clouds/0")
    qtbot.waitUntil(lambda: people.session.state.active_key == "clouds/0")
    canvas = people.window.scene.active_view.canvas
    canvas.fit()

    def covered(scale):
        image = canvas.picture(scale, transparent=True)
        alpha = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.width(), 4)[..., 3]
        return (alpha > 0).mean()

    assert covered(3) == pytest.approx(covered(1), rel=0.06)


def test_what_a_small_view_says_lies_below_its_shape_and_leaves_out_its_name(person, make_torus, qtbot):
    for name in ("left", "middle", "right"):
        person.session.add_shape(make_torus(name))
    person.session.choose_comparison(FieldChoice("distance", "wks"))
    qtbot.waitUntil(lambda: len(person.window.scene.views) == 6 and 0 < person.window.view.height() < 380)
    view = person.window.view
    longest = (
        "The descriptor of this shape is not known and here is a very long reason why that is so, and a remedy" * 3
    )
    key, choice = view.key, person.session.state.field
    view.canvas.grabFramebuffer()
    person.results.set_field(0, key, ShapeField(shape=key, choice=choice, message=longest))
    low = view.canvas.place_of(int(view.shape.shape.vertices[:, 1].argmin())).y()
    assert view.hint.isVisible()
    assert view.hint.y() > low
    assert view.toolTip() == longest
    ink = QImage(view.hint.size(), QImage.Format.Format_ARGB32)
    ink.fill(0)
    painter = QPainter(ink)
    view.hint.draw(painter)
    painter.end()
    across = [sum(ink.pixelColor(x, y).alpha() > 0 for x in range(ink.width())) for y in range(ink.height())]
    inked = [count for count in across if count]
    assert inked[0] < inked[len(inked) // 2] - 8, "cut to the lines that fit: the box has its round corners"
    assert view._without_name("Computing WKS of right … 40 %") == "Computing WKS … 40 %"
    assert view._without_name("WKS matches of right and left …") == "WKS matches of right and left …"


@pytest.mark.parametrize("size", [1.0, 2.0])
def test_directions_lie_on_the_balls_of_a_cloud_and_not_within(person, qtbot, size):
    person.open("clouds/0")
    person.window.display.set("arrows", True)
    qtbot.waitUntil(lambda: person.canvas._needles is not None, timeout=20000)
    person.session.set_look("clouds/0", point_size=size)
    shown = person.pixels()
    person.window.display.set("arrows", False)
    bare = person.pixels()
    assert (np.abs(shown - bare).max(axis=2) > 60).mean() > 8e-4


def test_raised_hands_stay_under_the_label_and_others_take_the_whole_height(person, qtbot):
    person.window.resize(1440, 900)
    person.open("humans/0")
    person.open("humans/2")
    qtbot.waitUntil(lambda: min(view(person, key).width() for key in ("humans/0", "humans/2")) > 500)

    def under_label(each):
        canvas, room = each.canvas, QRect(each.label.pos(), QSize(each.label.reach, each.label.height()))
        places = canvas.camera_model.places(canvas.shown.vertices, canvas.width(), canvas.height())
        assert (canvas.place_of(1234) - QPointF(*places[1234])).manhattanLength() < 1.5
        return any(room.contains(QPoint(int(x), int(y))) for x, y in places)

    for key, raised in (("humans/0", False), ("humans/2", True)):
        each = view(person, key)
        each.canvas.fit()
        distance = each.canvas.camera_model.distance
        assert not under_label(each)
        each.canvas.leave_room((), 0)
        assert under_label(each) == raised
        assert (each.canvas.camera_model.distance < distance) == raised


def test_nobody_is_asked_to_click_where_something_is_drawn_already(person, make_torus, qtbot):
    person.session.add_shape(make_torus("ring"))
    person.session.choose_field(kind="distance", descriptor="hks")
    view = next(each for each in person.window.scene.views if each.key == person.session.state.active_key)
    assert person.session.state.active_picks == ()
    person.results.set_field(0, view.key, None)
    assert view.hint.isVisible()
    count = len(view.shape.shape.vertices)
    drawn = ShapeField(shape=view.key, choice=person.session.state.field, values=np.linspace(0.0, 1.0, count))
    person.results.set_field(0, view.key, drawn)
    assert (view.hint.isVisible(), view.colour_bar.isVisible()) == (False, True)
