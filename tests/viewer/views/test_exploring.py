"""Fields, distance maps, the symmetry explorer and colour transfer, driven like a person drives them."""

import numpy as np
import pytest
from balls import Core, lopsided_ball
from PySide6.QtCore import QPoint, Qt

from add_core.io import save_shape
from add_viewer.models.fields import FieldChoice

THIGH = 6868
LEFT, NONE = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
CONTROL, SHIFT, ALT = (
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
)
PATIENCE = 300_000
"""Milliseconds: a busy machine may take its time to start a process, and nothing here is about speed."""


@pytest.fixture
def eggs(person, tmp_path, monkeypatch):
    """Two small shapes of one connectivity in files; what is computed goes to a cache of its own."""
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    for name, bent in (("bent", 0.08), ("egg", 0.0)):
        save_shape(lopsided_ball(bent=bent), tmp_path / f"{name}.off")
        person.open(str(tmp_path / f"{name}.off"))
    return person


@pytest.fixture
def core(eggs):
    """Commands run in this process, without the seconds that a new one takes to start."""
    eggs.assembly.jobs.asked.disconnect()
    return Core(eggs.assembly.jobs)


def wait(qtbot, core, condition):
    """Until `condition` holds; jobs end as soon as they are asked for."""

    def met():
        while core.waiting:
            core.answer()
        return condition()

    qtbot.waitUntil(met, timeout=PATIENCE)


def key_of(person, name):
    return next(shape.key for shape in person.session.state.shapes if shape.name == name)


def canvas_of(person, name, panel=0):
    key = key_of(person, name)
    return next(view for view in person.window.scene.views if (view.key, view.panel) == (key, panel)).canvas


def pixels(canvas):
    from PySide6.QtGui import QImage

    image = canvas.grabFramebuffer().convertToFormat(QImage.Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(int)


def redness(canvas, vertex):
    """How hot the canvas is around a vertex: red minus blue."""
    place, picture = canvas.place_of(vertex).toPoint(), pixels(canvas)
    patch = picture[place.y() - 4 : place.y() + 5, place.x() - 4 : place.x() + 5].reshape(-1, 3)
    return float(np.median(patch[:, 0] - patch[:, 2]))


def facing(person, name):
    """A vertex that looks at the camera, on one side of the mirror plane."""
    shape = person.session.state.shape(key_of(person, name)).shape
    eye = canvas_of(person, name).camera_model.direction
    sideways = shape.vertices[:, 0] - shape.vertices[:, 0].mean()
    return int(np.argmax(np.where(shape.vertex_normals @ eye > 0.8, sideways, -np.inf)))


def click(person, qtbot, name, vertex, modifier=NONE):
    """Click a vertex, once the views stand where they will stay."""
    canvas = canvas_of(person, name)
    before = None
    while (place := (canvas.size(), canvas.place_of(vertex).toPoint())) != before:
        before = place
        qtbot.wait(200)  # views are laid out when events are handled
    qtbot.mouseClick(canvas, LEFT, modifier, canvas.place_of(vertex).toPoint())


def in_front(dock):
    """Whether a panel that shares its place is the one to be seen."""
    return not dock.visibleRegion().isEmpty()


def field(person, name, panel=0):
    return person.results.fields.get((panel, key_of(person, name)))


def shows(person, name, kind, panel=0):
    found = field(person, name, panel)
    return found is not None and found.choice.kind == kind and (found.values is not None or found.colors is not None)


def choose(person, qtbot, words, *, second=False):
    """Open the list with the keyboard, type, and take the first field found."""
    qtbot.keyClick(person.window, Qt.Key.Key_F, CONTROL | SHIFT if second else CONTROL)
    listed = person.assembly.exploring.chooser.list
    assert listed.isVisible()
    qtbot.keyClicks(listed.field, words)
    qtbot.keyClick(listed.field, Qt.Key.Key_Return)
    assert not listed.isVisible()


def test_a_field_is_found_by_typing_and_drawn_and_undone(person, qtbot):
    person.open()
    bare = person.pixels()
    choose(person, qtbot, "gauss")
    qtbot.waitUntil(lambda: "humans/0" in {key for _, key in person.results.fields}, timeout=PATIENCE)
    assert (np.abs(person.pixels() - bare).max(axis=2) > 40).mean() > 0.005
    assert person.assembly.exploring.chooser.buttons[0].text() == "Gaussian curvature"
    person.session.undo()
    assert person.session.state.field.kind == "heat"
    assert not person.results.fields


def test_a_long_name_is_cut_and_does_not_widen_the_panel(person, qtbot):
    person.open()
    chooser, panel = person.assembly.exploring.chooser, person.window.parameters
    button = chooser.buttons[0]
    for title in ("Heat", "Where mADD3 of a training with a long name takes left for right"):
        button.setText(title)
        qtbot.wait(20)
        assert panel.width() == panel.parentWidget().width()
        assert button.fontMetrics().horizontalAdvance(button.shown_text) < button.width() - button.iconSize().width()
        assert (button.shown_text == title) == (title == "Heat")
        assert (title in button.toolTip()) == (title != "Heat")
        assert "Ctrl+F" in button.toolTip()


def test_the_list_is_walked_by_keys_and_left_by_escape_and_chosen_by_a_click(person, qtbot):
    person.open()
    chooser = person.assembly.exploring.chooser
    qtbot.mouseClick(chooser.buttons[0], LEFT)
    listed = chooser.list
    assert listed.list.currentItem().text() == "Heat kernel"
    qtbot.keyClick(listed.field, Qt.Key.Key_Down)
    qtbot.keyClick(listed.field, Qt.Key.Key_Escape)
    assert person.session.state.field.kind == "heat"
    qtbot.mouseClick(chooser.buttons[1], LEFT)
    qtbot.keyClicks(listed.field, "mean")
    row = listed.list.visualItemRect(listed.list.item(0)).center()
    qtbot.mouseClick(listed.list.viewport(), LEFT, pos=row)
    assert person.session.state.compare == FieldChoice("curvature", name="mean")
    assert len(person.window.scene.views) == 2
    qtbot.mouseClick(chooser.close_button, LEFT)
    assert person.session.state.compare is None


def test_controls_that_do_not_matter_fold_away_or_are_greyed(person, qtbot):
    person.open()
    panel = person.window.parameters
    assert panel.dial.isVisible()
    choose(person, qtbot, "rose of")
    assert panel.alpha.isEnabled()
    assert not panel.theta_row.isEnabled()
    choose(person, qtbot, "maximum curv")
    assert not panel.alpha.isVisible()
    qtbot.mouseClick(panel.fold, LEFT)
    assert panel.alpha.isVisible()
    assert panel.theta_row.isEnabled()


def test_a_click_on_one_shape_shows_distances_on_all_in_two_descriptors(eggs, qtbot):
    choose(eggs, qtbot, "distance hks")
    choose(eggs, qtbot, "distance wks", second=True)
    vertex = facing(eggs, "egg")
    click(eggs, qtbot, "egg", vertex)
    assert eggs.session.state.picks[0].vertex == vertex
    assert "Computing" in field(eggs, "egg").message
    views = [(name, panel) for name in ("egg", "bent") for panel in (0, 1)]
    qtbot.waitUntil(lambda: all(shows(eggs, name, "distance", panel) for name, panel in views), timeout=PATIENCE)
    for name, panel in views:
        values = field(eggs, name, panel).values
        shape, here = eggs.session.state.shape(key_of(eggs, name)).shape, canvas_of(eggs, name, panel)
        seen = shape.vertex_normals @ here.camera_model.direction > 0.8
        far, near = (int(np.flatnonzero(seen)[pick(values[seen])]) for pick in (np.argmax, np.argmin))
        assert redness(here, far) > redness(here, near) + 60
    best = eggs.assembly.exploring.best
    qtbot.waitUntil(lambda: best.isVisible() and len(best.buttons) == 12, timeout=5000)
    chosen = int(best.buttons[0].text())
    qtbot.mouseClick(best.buttons[0], LEFT)
    assert [pick.vertex for pick in eggs.session.state.picks] == [chosen]


def test_the_saturation_of_both_panels_moves_as_one_step(eggs, qtbot):
    choose(eggs, qtbot, "distance hks")
    choose(eggs, qtbot, "distance wks", second=True)
    row = eggs.assembly.exploring.controls[0].saturation
    assert not eggs.assembly.exploring.controls[1].isVisible()
    for percent in (60, 75, 90):
        qtbot.mouseClick(row.slider, LEFT, pos=row.slider.place_of(percent).toPoint())
    assert eggs.session.state.field.saturation == pytest.approx(90, abs=1.5)
    assert eggs.session.state.compare.saturation == eggs.session.state.field.saturation
    qtbot.mouseDClick(row.slider, LEFT, pos=row.slider.place_of(90).toPoint())
    assert eggs.session.state.compare.saturation == 50.0


def test_the_symmetry_explorer_finds_the_mirror_map_and_shows_what_hks_mistakes(eggs, core, qtbot):
    explorer = eggs.assembly.exploring.symmetry
    qtbot.keyClick(eggs.window, Qt.Key.Key_S)
    assert explorer.isVisible()
    assert explorer.find_button.isVisible()
    qtbot.mouseClick(explorer.find_button, LEFT)
    state = eggs.session.state
    wait(qtbot, core, lambda: eggs.session.state.active.symmetry is not None)
    assert "found by the shape itself" in explorer.status.text()
    qtbot.keyClick(eggs.window, Qt.Key.Key_S)
    disc, ring = eggs.session.state.active_picks
    assert ring.vertex == eggs.session.state.active.symmetry[disc.vertex]
    assert (ring.mirror_of, ring.slot) == (disc.vertex, disc.slot)
    told = lambda: {each.descriptor: each.ratio for each in eggs.assembly.exploration.insights.tellings}  # noqa: E731
    wait(qtbot, core, lambda: None not in (told()["hks"], told()["ahks"]))
    assert told()["hks"] < 0.05 < told()["ahks"]
    assert told()["wks"] is None
    place = explorer.bars.row_centre("wks").toPoint()
    qtbot.mouseClick(explorer.bars, LEFT, pos=place)
    wait(qtbot, core, lambda: told()["wks"] is not None)
    qtbot.mouseClick(explorer.scenes["everywhere"], LEFT)
    wait(qtbot, core, lambda: shows(eggs, "egg", "ambiguity") and shows(eggs, "egg", "ambiguity", 1))
    assert pixels(canvas_of(eggs, "egg"))[..., 2].mean() > pixels(canvas_of(eggs, "egg", 1))[..., 2].mean()
    eggs.session.undo()
    assert eggs.session.state.field.kind == "distance"
    assert state.active.symmetry is None


def pick_a_pair(person, qtbot):
    """A point and, by hand, its partner on the other side."""
    vertex = facing(person, "egg")
    click(person, qtbot, "egg", vertex)
    places = person.session.state.active.shape.vertices
    partner = int(np.argmin(np.linalg.norm(places - places[vertex] * [-1, 1, 1], axis=1)))
    click(person, qtbot, "egg", partner, ALT)
    return vertex, partner


def test_a_partner_is_picked_by_hand_where_no_mirror_map_is_known(eggs, qtbot):
    vertex, partner = pick_a_pair(eggs, qtbot)
    disc, ring = eggs.session.state.active_picks
    assert (disc.vertex, ring.vertex, ring.mirror_of, ring.slot) == (vertex, partner, vertex, disc.slot)


def test_mirror_curves_are_read_backwards_by_a_key(eggs, qtbot):
    pick_a_pair(eggs, qtbot)
    results, panel = eggs.results, eggs.window.curves
    qtbot.waitUntil(
        lambda: len(results.curves) == 2 and all(each.is_complete for each in results.curves), timeout=PATIENCE
    )

    def gap():
        drawn = panel.plots.moving_artists(panel.scene())
        lines = [line for axes, line in drawn if axes is panel.plots.theta_axes and line.get_lw() == 2]
        solid, dotted = (next(line for line in lines if line.get_linestyle() == style) for style in "-:")
        return np.abs(solid.get_ydata() - dotted.get_ydata()).max()

    apart = gap()
    qtbot.keyClick(eggs.window, Qt.Key.Key_I)
    assert gap() < 0.2 * apart


def test_colours_land_on_the_target_raw_and_refined_with_errors_and_a_curve(eggs, core, qtbot):
    exploring = eggs.assembly.exploring
    bare = pixels(canvas_of(eggs, "bent"))
    qtbot.keyClick(eggs.window, Qt.Key.Key_T)
    qtbot.waitUntil(lambda: shows(eggs, "bent", "transfer"), timeout=PATIENCE)
    true = pixels(canvas_of(eggs, "bent"))
    assert (np.abs(true - bare).max(axis=2) > 40).mean() > 0.02
    method = exploring.matching.method
    method.setFocus()
    qtbot.keyClick(method, Qt.Key.Key_Down)  # nearest descriptor
    method.activated.emit(method.currentIndex())
    exploring.matching.descriptor.setCurrentIndex(exploring.matching.descriptor.findData("wks"))
    exploring.matching.descriptor.activated.emit(exploring.matching.descriptor.currentIndex())
    assert eggs.session.state.matching.descriptor == "wks"
    wait(qtbot, core, lambda: shows(eggs, "bent", "transfer") and eggs.results.maps != {})
    raw = eggs.results.maps[key_of(eggs, "egg"), key_of(eggs, "bent")]
    assert "on average" in exploring.matching.errors.text()
    box = exploring.matching.refined
    qtbot.mouseClick(box, LEFT, pos=QPoint(8, box.height() // 2))
    assert eggs.session.state.matching.refined
    qtbot.waitUntil(
        lambda: (eggs.results.maps[key_of(eggs, "egg"), key_of(eggs, "bent")] != raw).any(), timeout=PATIENCE
    )
    assert exploring.quality_dock.isVisible()
    qtbot.waitUntil(lambda: len(exploring.quality.figure.axes) == 1, timeout=5000)
    assert len(exploring.quality.figure.axes[0].lines) == 2
    qtbot.waitUntil(lambda: in_front(exploring.quality_dock), timeout=5000)
    choose(eggs, qtbot, "heat kernel")
    assert in_front(eggs.window.curve_dock)
    choose(eggs, qtbot, "error of")
    assert in_front(exploring.quality_dock)
    qtbot.waitUntil(lambda: shows(eggs, "bent", "error"), timeout=PATIENCE)
    assert np.nanmax(field(eggs, "bent").values) > 0
