"""What can be seen of a control's state, in both themes, and what is read aloud where there are no words."""

import numpy as np
import pytest


@pytest.fixture(params=["light", "dark"])
def theme(request, qapp, screen):
    from add_viewer.views.theme import apply_theme, theme_of

    theme = theme_of(request.param)
    apply_theme(theme)
    return theme


def share(widget, colour):
    """Of the widget's pixels that have very nearly this colour."""
    from PySide6.QtGui import QColor, QImage

    image = widget.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
    pixels = flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(int)
    return (np.abs(pixels - QColor(colour).getRgb()[:3]).max(axis=2) < 12).mean()


def test_a_checked_box_has_a_tick_and_not_colour_alone(theme, qtbot):
    from PySide6.QtWidgets import QCheckBox

    box = QCheckBox()
    qtbot.addWidget(box)
    box.resize(16, 16)
    box.setChecked(True)
    assert share(box, theme.accent) > 0.25
    assert share(box, theme.on_accent) > 0.03


def test_a_primary_button_shows_that_it_has_the_focus(theme, qtbot):
    from PySide6.QtWidgets import QPushButton, QVBoxLayout, QWidget

    window = QWidget()
    qtbot.addWidget(window)
    column, button, other = QVBoxLayout(window), QPushButton(), QPushButton()
    button.setProperty("primary", True)
    for each in (button, other):
        column.addWidget(each)
    window.show()
    window.activateWindow()
    other.setFocus()
    qtbot.waitUntil(other.hasFocus, timeout=2000)
    size, before = button.size(), share(button, theme.text)
    button.setFocus()
    qtbot.waitUntil(button.hasFocus, timeout=2000)
    assert share(button, theme.text) > before + 0.05
    assert button.sizeHint().height() == button.height()
    assert button.size() == size


def test_a_primary_button_that_is_off_looks_so_and_can_be_read(theme, qtbot):
    from PySide6.QtWidgets import QPushButton

    button = QPushButton("Start training")
    qtbot.addWidget(button)
    button.setProperty("primary", True)
    button.ensurePolished()
    on = share(button, theme.accent)
    button.setEnabled(False)
    assert share(button, theme.accent) < 0.01 < 0.5 < on
    assert share(button, theme.line) > 0.5
    assert contrast(theme.muted, theme.line) > 3.0


def contrast(one, two):
    """Of two colours as WCAG measures it."""
    from PySide6.QtGui import QColor

    def light(colour):
        channels = np.array(QColor(colour).getRgbF()[:3])
        return np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4) @ [
            0.2126,
            0.7152,
            0.0722,
        ]

    low, high = sorted((light(one), light(two)))
    return (high + 0.05) / (low + 0.05)


def test_the_buttons_of_every_panel_have_names_of_their_own(assembly):
    from add_viewer.views.dock_title import DockTitle

    titles = assembly.window.findChildren(DockTitle)
    names = [button.accessibleName() for title in titles for button in (title.float_button, title.close_button)]
    assert len(set(names)) == 2 * len(titles) > 6
    assert "Close “What is shown”" in names
