"""The window, driven like a person drives it: mouse, keys, files."""

from math import degrees, radians

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QImage

from add_viewer.views.dialogs import PictureChoice

THIGH, SHOULDER = 6868, 5056
CONTROL, SHIFT, ALT = (
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
)


def vertices(person):
    return [pick.vertex for pick in person.session.state.active_picks]


def test_the_start_page_opens_a_shape_with_one_click(person, qtbot):
    start = person.window.start
    start.buttons[2].click()
    item = start.list.item(3)
    place = start.list.visualItemRect(item).center()
    qtbot.mouseClick(start.list.viewport(), Qt.MouseButton.LeftButton, pos=place)
    qtbot.waitUntil(lambda: person.session.state.active_key == "dogs/3", timeout=20000)
    assert person.window.pages.currentWidget() is person.window.scene
    assert person.window.settings.recent == ["dogs/3"]


def test_a_click_picks_the_vertex_under_the_cursor_and_the_body_takes_colour(person):
    person.open()
    bare = person.pixels()
    person.click(THIGH)
    assert vertices(person) == [THIGH]
    person.wait_for_kernel()
    assert (np.abs(person.pixels() - bare).max(axis=2) > 60).mean() > 0.005


def test_a_drag_turns_the_shape_and_picks_nothing(person, qtbot):
    person.open()
    before = person.canvas.camera_model.elevation
    start = person.place(THIGH)
    qtbot.mousePress(person.canvas, Qt.MouseButton.LeftButton, pos=start)
    for step in (1, 2, 3, 4, 3, 2):
        qtbot.mouseMove(person.canvas, start + QPoint(0, 8 * step))
    turned = person.canvas.camera_model.elevation
    qtbot.mouseMove(person.canvas, start)
    qtbot.mouseRelease(person.canvas, Qt.MouseButton.LeftButton, pos=start)  # on the body again
    assert vertices(person) == []
    assert turned != before


def test_shift_click_adds_alt_click_mirrors_and_escape_clears(person, qtbot):
    person.open()
    mirror = person.session.state.active.mirror(SHOULDER)
    person.click(THIGH)
    person.click(SHOULDER, SHIFT)
    person.click(SHOULDER, ALT)
    assert vertices(person) == [THIGH, SHOULDER, mirror]
    qtbot.keyClick(person.window, Qt.Key.Key_Escape)
    assert vertices(person) == []


def test_a_click_beside_the_body_changes_nothing(person, qtbot):
    person.open()
    person.click(THIGH)
    qtbot.mouseClick(person.canvas, Qt.MouseButton.LeftButton, pos=QPoint(60, 200))
    assert vertices(person) == [THIGH]


def test_hovering_tells_vertex_and_value(person, qtbot):
    person.open()
    person.click(THIGH)
    kernel = person.wait_for_kernel()

    def hovered() -> bool:  # the screen's own cursor may send events in between
        qtbot.mouseMove(person.canvas, person.place(THIGH) + QPoint(60, 0))
        qtbot.mouseMove(person.canvas, person.place(THIGH))
        return person.window.hover_label.text().startswith(f"Vertex {THIGH} ")

    qtbot.waitUntil(hovered)
    assert f"{kernel.values[THIGH]:.4g}" in person.window.hover_label.text()


def test_a_picture_for_a_file_waits_for_curves_that_are_there_but_not_drawn(person, qtbot):
    person.open()
    results, told = person.results, []
    results.curves_changed.connect(
        lambda: told.append(bool(results.curves) and all(each.is_complete for each in results.curves))
    )
    ready = []
    results.curves_changed.connect(lambda: ready.append(person.assembly._settled()))
    person.click(THIGH)
    qtbot.waitUntil(lambda: bool(told) and told[-1], timeout=20000)
    assert ready[-1] is False
    qtbot.waitUntil(person.assembly._settled)


def test_a_vertex_number_can_be_typed(person, qtbot):
    person.open()
    qtbot.keyClick(person.window, Qt.Key.Key_G, CONTROL)
    field = person.window.parameters.picks.field
    assert field.hasFocus()
    qtbot.keyClicks(field, "1234")
    qtbot.keyClick(field, Qt.Key.Key_Return)
    assert vertices(person) == [1234]
    problem = person.window.parameters.picks.problem
    for typed in ("6890", "-1", "nan", "inf"):
        person.type_into(field, typed)
        assert (vertices(person), field.text()) == ([1234], "1234")
        assert f"no vertex {typed}" in problem.text()
        assert "0 to 6889" in problem.text()
        assert problem.isVisible()
    person.type_into(field, "6889")
    assert (vertices(person), problem.isVisible()) == ([6889], False)


def test_space_plays_theta_and_space_stops_it(person, qtbot):
    person.open()
    qtbot.keyClick(person.canvas, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: person.session.state.diffusion.theta > radians(2), timeout=5000)
    qtbot.keyClick(person.canvas, Qt.Key.Key_Space)
    theta = person.session.state.diffusion.theta
    qtbot.wait(120)
    assert person.session.state.diffusion.theta == theta
    person.session.undo()
    assert person.session.state.diffusion.theta == 0.0


def test_pictures_have_the_size_and_background_that_was_asked_for(person, tmp_path):
    person.open()
    path = tmp_path / "picture.png"
    middle = person.canvas.place_of(THIGH)
    for scale, transparent in ((1, False), (2, True), (4, False), (4, True)):
        person.assembly.saving.save_picture(path, PictureChoice(scale, transparent, labels=True))
        image = QImage(str(path))
        assert (image.width(), image.height()) == (scale * person.canvas.width(), scale * person.canvas.height())
        corner = image.pixelColor(image.width() - 2, 2)
        assert corner.alpha() == (0 if transparent else 255)
        assert image.pixelColor((scale * middle).toPoint()).alpha() == 255
        assert image.pixelColor((scale * middle).toPoint()).lightness() > 100


def test_curves_are_exported(person, qtbot, tmp_path):
    person.open()
    person.click(THIGH)
    qtbot.waitUntil(lambda: bool(person.results.curves) and len(person.results.curves[0].thetas) >= 4, timeout=30000)
    starts = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF", ".csv": b"vertex"}
    for ending, start in starts.items():
        path = tmp_path / f"curves{ending}"
        person.assembly.saving.save_curves(path)
        assert path.read_bytes().startswith(start)
    assert len([each for each in tmp_path.iterdir() if "curves" in each.name]) == len(starts)


def test_the_crosshairs_are_linked_to_theta_and_t(person, qtbot):
    person.open()
    person.click(THIGH)
    qtbot.waitUntil(lambda: bool(person.results.curves) and len(person.results.curves[0].thetas) >= 4, timeout=30000)
    plots, canvas = person.window.curves.plots, person.window.curves.canvas
    qtbot.wait(250)

    def press(axes, x, y):
        right, up = axes.transData.transform((x, y))
        ratio = canvas.device_pixel_ratio
        qtbot.mouseClick(
            canvas, Qt.MouseButton.LeftButton, pos=QPoint(int(right / ratio), int(canvas.height() - up / ratio))
        )

    press(plots.theta_axes, 120.0, np.mean(plots.theta_axes.get_ylim()))
    assert degrees(person.session.state.diffusion.theta) == pytest.approx(120, abs=1)
    press(plots.polar_axes, radians(225), 0.7 * plots.polar_axes.get_ylim()[1])
    assert degrees(person.session.state.diffusion.theta) == pytest.approx(45, abs=3)
    time = 0.3 / person.results.weyl_eigenvalue
    press(plots.time_axes, time, float(np.sqrt(np.prod(plots.time_axes.get_ylim()))))
    assert person.session.state.diffusion.reach == pytest.approx(0.3, rel=0.05)


def test_the_direction_field_is_drawn_above_the_skin_and_turns(person, qtbot):
    person.open()
    qtbot.keyClick(person.window, Qt.Key.Key_D)
    qtbot.waitUntil(lambda: bool(person.results.directions), timeout=20000)
    qtbot.waitUntil(lambda: person.canvas._needles is not None, timeout=5000)
    before = person.pixels()
    person.session.diffuse(theta=radians(90))
    assert np.abs(person.pixels() - before).max() > 60
    qtbot.keyClick(person.window, Qt.Key.Key_D)
    assert person.canvas._needles is None


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_theme_reaches_the_background_and_is_kept(person, theme):
    person.open()
    person.assembly.display.set("theme", theme)
    corner = person.pixels()[5, 5]
    assert corner.mean() > 200 if theme == "light" else corner.mean() < 90
    assert person.window.menus.actions[f"theme:{theme}"].isChecked()


def test_views_look_at_the_shape_s_own_sides(person, qtbot):
    person.open()
    for key, nearest in ((Qt.Key.Key_1, (0, -1, 0)), (Qt.Key.Key_3, (0, 1, 0)), (Qt.Key.Key_4, (1, 0, 0))):
        qtbot.keyClick(person.window, key)
        assert person.canvas.camera_model.direction == pytest.approx(np.array(nearest), abs=1e-9)


def test_the_right_click_menu_offers_what_makes_sense(person):
    person.open()
    person.click(THIGH)
    there = [action.text() for action in person.window.context_menu("humans/0", THIGH).actions()]
    assert "Remove this point" in there
    assert "Add its mirror point" in there
    beside = [action.text() for action in person.window.context_menu("humans/0", -1).actions()]
    assert not any("point" in text for text in beside)


def test_panels_hide_on_the_start_page_and_come_back_as_they_were(person):
    assert person.window.parameter_dock.isHidden()
    person.open()
    assert person.window.parameter_dock.isVisible()
    person.window.curve_dock.hide()
    person.window.show_start()
    assert person.window.parameter_dock.isHidden()
    person.window.start.back_button.click()
    assert person.window.pages.currentWidget() is person.window.scene
    assert person.window.parameter_dock.isVisible()
    person.window.show_start()
    person.open("humans/1")
    assert person.session.state.active_key == "humans/1"
    assert person.window.parameter_dock.isVisible()
    assert person.window.curve_dock.isHidden()


def test_every_shipped_shape_can_be_shown(person):
    """The cheap path: the view shows each shape without its operator being built."""
    from dataclasses import replace

    from add_core.io import SHIPPED

    person.open()
    known = person.session.state.active
    for name, collection in SHIPPED.items():
        for index, shape in enumerate(collection()):
            person.canvas.show_shape(replace(known, key=f"{name}/{index}", shape=shape), "+z", "-y")
            assert person.canvas.vertex_at(QPointF(person.canvas.place_of(0))) >= -1
    middle = person.pixels()[person.canvas.height() // 2]
    assert np.ptp(middle, axis=0).max() > 20


def test_settings_survive_the_next_start(assembly, qapp, tmp_path):
    from PySide6.QtCore import QSettings

    from add_viewer.assembly import Assembly

    assembly.display.set("arrows", True)
    assembly.display.set("theme", "dark")
    assembly.window.remember("humans/7")
    assembly.window.resize(1100, 720)
    assembly.window.close()
    store = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
    again = Assembly([], store=store)
    assert again.display["arrows"] is True
    assert again.display["theme"] == "dark"
    assert again.window.settings.recent == ["humans/7"]
    assert (again.window.width(), again.window.height()) == (1100, 720)
    again.stop()
