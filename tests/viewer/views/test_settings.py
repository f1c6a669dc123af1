"""The settings dialog: what it changes at once, what lasts, and the way back."""

import numpy as np
import pytest
from PySide6.QtCore import QSettings, Qt

from add_viewer.models.display import Display
from add_viewer.views.settings import Settings


@pytest.fixture
def dialog(person, qtbot, monkeypatch):
    monkeypatch.setenv("ADD_CACHE_GB", "8")
    qtbot.waitUntil(person.window.isActiveWindow)
    qtbot.keyClick(person.window, Qt.Key.Key_Comma, Qt.KeyboardModifier.ControlModifier)
    opened = person.window.aids.settings
    assert opened.isVisible()
    yield opened
    opened.close()


def choose(dialog, name: str, value: str) -> None:
    """As a person does it: the box tells of it only when somebody chose."""
    box = dialog.choices[name]
    box.setCurrentIndex(box.findData(value))
    box.activated.emit(box.currentIndex())


def test_other_heat_colours_reach_the_skin_and_the_bar(person, dialog):
    person.open()
    person.click(6868)
    person.wait_for_kernel()
    warm = person.pixels()
    choose(dialog, "kernel_colours", "grey")
    grey = person.pixels()
    assert (np.abs(grey - warm).max(axis=2) > 40).mean() > 0.002
    heated = grey[np.abs(grey - warm).max(axis=2) > 40]
    assert np.ptp(heated, axis=1).mean() < 30, "grey is grey"
    assert person.window.view.colour_bar._tones == "grey"


def test_what_is_chosen_lasts_and_is_reset(person, dialog, tmp_path, qtbot):
    choose(dialog, "kernel_scale", "log")
    choose(dialog, "up_axis", "+z")
    dialog.autosave.click()
    dialog.limit.setValue(3.5)
    assert not person.assembly.keeping.autosaves
    store = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
    store.sync()
    later = Display()
    Settings(store).restore_display(later)
    assert (later["kernel_scale"], later["up_axis"], later["autosave"]) == ("log", "+z", False)
    assert Settings(store).cache_limit == 3.5
    qtbot.mouseClick(dialog.all_button, Qt.MouseButton.LeftButton)
    assert person.window.display.as_dict() == Display().as_dict()
    assert dialog.autosave.isChecked()
    assert dialog.limit.value() == 8.0
    assert person.assembly.keeping.autosaves


def test_changes_from_elsewhere_reach_the_dialog(person, dialog):
    person.window.display.set("theme", "dark")
    assert dialog.choices["theme"].currentData() == "dark"
    dialog.close()
    person.window.display.set("theme", "light")  # the closed dialog must not be asked


def test_reset_panels_brings_back_what_was_closed_and_floating(person, dialog, qtbot):
    person.open()
    person.window.curve_dock.setFloating(True)
    person.window.parameter_dock.close()
    qtbot.mouseClick(dialog.panels_button, Qt.MouseButton.LeftButton)
    for dock in (person.window.curve_dock, person.window.parameter_dock):
        assert dock.isVisible()
        assert not dock.isFloating()
    assert person.window.dockWidgetArea(person.window.parameter_dock) == Qt.DockWidgetArea.LeftDockWidgetArea
