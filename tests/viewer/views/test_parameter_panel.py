"""How heat runs: the fields, sliders and the dial on the left, driven like a person drives them."""

from math import degrees, radians

import numpy as np
import pytest
from PySide6.QtCore import Qt

THIGH = 6868
CONTROL = Qt.KeyboardModifier.ControlModifier


def test_typed_numbers_reach_the_model_and_come_back_to_the_field(person):
    person.open()
    alpha, theta = person.window.parameters.alpha.field, person.window.parameters.theta
    for typed, expected in (("7.5", 7.5), ("nonsense", 7.5), ("1000", 200.0), ("1,5", 1.5), ("-2", 0.0)):
        person.type_into(alpha, typed)
        assert person.session.state.diffusion.alpha == pytest.approx(expected)
        assert float(alpha.text()) == pytest.approx(expected)
    for typed, expected in (("30", 30), ("-45", 135), ("200°", 20), ("", 20)):
        person.type_into(theta, typed)
        assert degrees(person.session.state.diffusion.theta) == pytest.approx(expected)
        assert float(theta.text()) == pytest.approx(expected)


@pytest.mark.parametrize(("field", "typed"), [("alpha", "0"), ("theta", "90"), ("time", "0.05")])
def test_typing_changes_the_kernel_and_the_picture(person, qtbot, field, typed):
    person.open()
    person.click(THIGH)
    kernel = person.wait_for_kernel()
    before = person.pixels()
    panel = person.window.parameters
    fields = {"alpha": panel.alpha.field, "theta": panel.theta, "time": panel.time.field}
    person.type_into(fields[field], typed)
    changed = person.wait_for_kernel(kernel)
    assert not np.allclose(changed.values, kernel.values)
    assert np.abs(person.pixels() - before).max() > 40
    if field == "time":
        assert changed.time == pytest.approx(0.05)


def test_the_dial_follows_the_mouse_and_snaps_with_control(person, qtbot):
    person.open()
    dial = person.window.parameters.dial
    qtbot.mouseClick(dial, Qt.MouseButton.LeftButton, pos=dial.place_of(radians(68)).toPoint())
    assert degrees(person.session.state.diffusion.theta) == pytest.approx(68, abs=1.5)
    qtbot.mouseClick(dial, Qt.MouseButton.LeftButton, CONTROL, dial.place_of(radians(68)).toPoint())
    assert degrees(person.session.state.diffusion.theta) == pytest.approx(75)
    qtbot.mouseDClick(dial, Qt.MouseButton.LeftButton, pos=dial.place_of(radians(68)).toPoint())
    assert person.session.state.diffusion.theta == 0.0


def test_the_dial_follows_the_keys(person, qtbot):
    person.open()
    none, dial = Qt.KeyboardModifier.NoModifier, person.window.parameters.dial
    for key, modifier, expected in (
        (Qt.Key.Key_Left, none, 11.0),
        (Qt.Key.Key_Right, none, 9.0),
        (Qt.Key.Key_Left, CONTROL, 15.0),
        (Qt.Key.Key_Right, CONTROL, 0.0),
        (Qt.Key.Key_PageUp, none, 25.0),
    ):
        person.session.diffuse(theta=radians(10))
        qtbot.keyClick(dial, key, modifier)
        assert degrees(person.session.state.diffusion.theta) == pytest.approx(expected)
    person.session.diffuse(theta=radians(15))
    qtbot.keyClick(dial, Qt.Key.Key_Left, CONTROL)
    assert degrees(person.session.state.diffusion.theta) == pytest.approx(30)


def test_sliders_follow_the_mouse_and_reset_on_a_double_click(person, qtbot):
    person.open()
    alpha, time = person.window.parameters.alpha.slider, person.window.parameters.time.slider
    qtbot.mouseClick(alpha, Qt.MouseButton.LeftButton, pos=alpha.place_of(5.0).toPoint())
    assert person.session.state.diffusion.alpha == pytest.approx(5.0, abs=0.1)
    qtbot.mouseClick(time, Qt.MouseButton.LeftButton, pos=time.place_of(0.5).toPoint())
    assert person.session.state.diffusion.reach == pytest.approx(0.5, rel=0.05)
    qtbot.mouseDClick(alpha, Qt.MouseButton.LeftButton, pos=alpha.place_of(5.0).toPoint())
    assert person.session.state.diffusion.alpha == 50.0


def test_the_controls_show_what_the_model_says_and_do_not_answer_back(person):
    person.open()
    changes = []
    person.session.diffusion_changed.connect(lambda: changes.append(1))
    person.session.diffuse(alpha=12.0, theta=radians(33), conductivity="constant")
    panel = person.window.parameters
    assert panel.alpha.field.text() == "12"
    assert panel.theta.text() == "33"
    assert panel.model.currentData() == "constant"
    assert changes == [1]
