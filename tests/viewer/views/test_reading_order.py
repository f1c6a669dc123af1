"""Tab goes through what can be seen as one reads it, and shows where it is; no words of a button are cut."""

from dataclasses import dataclass, field

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QRect, Qt, QTimer
from PySide6.QtGui import QAccessible, QImage
from PySide6.QtWidgets import QAbstractButton, QApplication, QDialog, QMainWindow, QPushButton, QToolButton, QWidget

from add_viewer.models.fields import FieldChoice
from add_viewer.models.jobs import Job, JobRequest
from add_viewer.views.canvas import Canvas
from add_viewer.views.tool_strip import ToolStrip

STATES = ("running", "paused", "failed", "interrupted", "waiting", "done")


@pytest.fixture
def busy(assembly, make_torus, qtbot):
    """The app with three shapes, picks, and a job in every state."""
    for key in ("one", "two", "three"):
        assembly.session.add_shape(make_torus(key, symmetry=np.arange(288)[::-1].copy()))
    for vertex in (7, 11):
        assembly.session.pick(vertex, add=True)
    for number, state in enumerate(STATES):
        request = JobRequest("train", f"mADD3 on People {number}", (), assembly.jobs.home / str(number), True)
        assembly.jobs.put(Job(str(number), request, state=state, done=1, total=3))
    qtbot.waitUntil(assembly.window.isActiveWindow)
    return assembly


def symmetry(app):
    choices = [FieldChoice("distance", name, saturation=10.0) for name in ("hks", "ahks")]
    app.session.set_scene(field=choices[0], compare=choices[1], layout="single")


SCENES = {
    "heat": lambda app: None,
    "symmetry": symmetry,
    "matching": lambda app: app.session.match(method="zoomout") or app.window.menus.actions["transfer"].trigger(),
    "jobs": lambda app: app.window.menus.actions["jobs"].trigger(),
    "training": lambda app: app.window.menus.actions["train"].trigger(),
}


def panel_of(widget: QWidget) -> QWidget:
    """The dock, the bar, the scene or the dialog that it is in."""
    while not widget.isWindow() and not isinstance(widget.parentWidget(), QMainWindow):
        widget = widget.parentWidget()
    return widget


def room_of(widget: QWidget) -> QRect:
    return QRect(widget.mapToGlobal(QPoint(0, 0)), widget.size())


def picture_of(widget: QWidget) -> np.ndarray:
    seen = widget.parentWidget() if isinstance(widget, Canvas) else widget
    image = seen.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat.astype(int)


@dataclass
class Walk:
    """stops : in their order. jumps : steps within a panel that went up, or to the left on a line."""

    stops: list[QWidget] = field(default_factory=list)
    jumps: list[str] = field(default_factory=list)


def walk(qtbot, key=Qt.Key.Key_Tab) -> Walk:
    """Once around from where the keyboard is, with a look at every stop with and without it."""
    made, here = Walk(), QApplication.focusWidget()
    while here is not None and here not in made.stops:
        assert not here.visibleRegion().isEmpty(), f"{name_of(here)} has the keyboard unseen"
        made.stops.append(here)
        with_keys = picture_of(here)
        qtbot.keyClick(here, key)
        there = QApplication.focusWidget()
        assert there is not here
        assert (picture_of(here) != with_keys).sum() > 30, f"nobody sees that {name_of(here)} has the keyboard"
        if there not in made.stops and panel_of(here) is panel_of(there) and is_jump(room_of(here), room_of(there)):
            made.jumps.append(f"{name_of(here)} to {name_of(there)}")
        here = there
    return made


def is_jump(here: QRect, there: QRect) -> bool:
    shared = min(here.bottom(), there.bottom()) - max(here.top(), there.top())
    is_line = 2 * shared > min(here.height(), there.height())
    return there.bottom() < here.top() or (is_line and there.left() < here.right())


def name_of(widget: QWidget) -> str:
    words = widget.text() if isinstance(widget, QAbstractButton) else ""
    return f"{type(widget).__name__} {widget.accessibleName() or words}"


def test_tab_goes_once_through_every_panel_as_one_reads_it(busy, qtbot):
    for show in SCENES.values():
        show(busy)
        busy.window.parameters.shapes.setFocus()
        busy.window.view.canvas.setFocus(Qt.FocusReason.TabFocusReason)
        qtbot.wait(50)
        around = walk(qtbot)
        assert not around.jumps
        assert QApplication.focusWidget() is around.stops[0]
        assert walk(qtbot, Qt.Key.Key_Backtab).stops == [around.stops[0], *around.stops[:0:-1]]
        assert all(each.accessibleName() for each in around.stops if isinstance(each, QToolButton) and not each.text())


def test_what_tab_reaches_is_scrolled_into_sight_and_has_a_name(busy, qtbot):
    busy.window.resize(1024, 520)
    busy.window.view.canvas.setFocus(Qt.FocusReason.TabFocusReason)
    qtbot.wait(50)
    stops = walk(qtbot, Qt.Key.Key_Backtab).stops  # into the panel from its lower end
    assert busy.window.parameters.picks.field in stops
    for each in stops:
        assert QAccessible.queryAccessibleInterface(each).text(QAccessible.Text.Name), f"{name_of(each)} has no name"


def test_a_floating_panel_is_gone_through_alone(busy, qtbot):
    dock = busy.window.parameter_dock
    dock.setFloating(True)
    dock.activateWindow()
    first = dock.titleBarWidget().float_button
    first.setFocus(Qt.FocusReason.TabFocusReason)
    qtbot.waitUntil(first.hasFocus)
    around = walk(qtbot)
    assert not around.jumps
    assert busy.window.parameters.dial in around.stops
    assert all(stop.window() is dock for stop in around.stops)


def test_tab_goes_through_dialogs_as_one_reads_them(busy, qtbot):
    found = []

    def look() -> None:
        dialog = next(each for each in QApplication.topLevelWidgets() if isinstance(each, QDialog) and each.isVisible())
        dialog.activateWindow()
        qtbot.waitUntil(lambda: QApplication.focusWidget() is not None and dialog.isActiveWindow())
        found.append(walk(qtbot))
        dialog.reject()

    for name in ("figure", "animation"):
        QTimer.singleShot(300, look)  # these ask before they return
        busy.window.menus.actions[name].trigger()
    for open_dialog in (busy.window.aids.show_settings, busy.background.training_panel.open_form):
        open_dialog()
        look()
    assert [len(around.stops) > 4 for around in found] == 4 * [True]
    assert [around.jumps for around in found] == 4 * [[]]


def shows_words(button) -> bool:
    icon_alone = isinstance(button, QToolButton) and button.toolButtonStyle() == Qt.ToolButtonStyle.ToolButtonIconOnly
    return bool(button.text()) and (button.icon().isNull() or not icon_alone)


def words_cut(window) -> list[str]:
    buttons = [*window.findChildren(QPushButton), *window.findChildren(QToolButton)]
    seen = [each for each in buttons if each.isVisible() and shows_words(each)]
    return [each.text() for each in seen if each.width() < each.minimumSizeHint().width()]


def test_no_words_of_a_button_are_cut(busy, qtbot):
    for show in SCENES.values():
        show(busy)
        for size in ((1024, 700), (1440, 900)):
            busy.window.resize(*size)
            qtbot.wait(350)  # the bars follow the jobs
            qtbot.waitUntil(lambda: words_cut(busy.window) == [])


def test_the_tools_lie_over_no_words_in_two_rows_of_small_views(busy, qtbot):
    symmetry(busy)
    busy.session.arrange(layout="grid")
    busy.window.resize(1024, 700)
    scene = busy.window.scene
    qtbot.waitUntil(lambda: len(scene.views) == 6 and scene.views[-1].y() > scene.views[0].y())
    tools = room_of(scene.findChild(ToolStrip))
    for view in scene.views:
        for overlay in (view.hint, view.colour_bar, view.label):
            assert not tools.intersects(room_of(overlay)), f"{type(overlay).__name__} of {view.key}"
