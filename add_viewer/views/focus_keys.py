"""Keys that belong to the control with the focus before they are shortcuts of the window."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLineEdit,
    QWidget,
)

_PRESSED = (QAbstractButton, QComboBox, QAbstractItemView, QAbstractSpinBox, QLineEdit)
_ENTER = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
_KEYS = (Qt.Key.Key_Space, Qt.Key.Key_Select, *_ENTER)


class FocusKeys(QObject):
    """Watches windows: Space and Enter press the focused control; Space plays only where no control wants it.

    Qt asks the control, and then what it lies in, whether a key is theirs and no shortcut. Buttons do not claim Space,
    and outside of dialogs Enter does not press them.
    """

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() in (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress) and isinstance(event, QKeyEvent):
            focused = QApplication.focusWidget()
            if event.key() in _KEYS and not event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier:
                if event.type() == QEvent.Type.ShortcutOverride:
                    return _claim(event, isinstance(focused, _PRESSED))
                return _claim(event, event.key() in _ENTER and not event.isAutoRepeat() and _press(focused))
        return super().eventFilter(watched, event)


def _claim(event: QKeyEvent, wanted: bool) -> bool:
    if wanted:
        event.accept()
    return wanted


def _press(focused: QWidget | None) -> bool:
    """What a click would do."""
    if isinstance(focused, QAbstractButton):
        focused.click()
    elif isinstance(focused, QComboBox):
        focused.showPopup()
    else:
        return False
    return True
