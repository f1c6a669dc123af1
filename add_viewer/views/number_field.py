"""A field to type a number into."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent
from PySide6.QtWidgets import QLineEdit, QWidget


class NumberField(QLineEdit):
    """Emits `entered` with what was typed once it is complete (Enter, Tab, arrow keys); nonsense is put back.

    show_as : how a number reads. step : the number after pressing the up (+1) or down (-1) key.
    """

    entered = Signal(float)

    def __init__(
        self,
        *,
        show_as: Callable[[float], str],
        step: Callable[[float, int], float],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._show_as, self._step = show_as, step
        self._value: float | None = None
        self.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.editingFinished.connect(self._commit)

    @property
    def value(self) -> float | None:
        return self._value

    def show_value(self, value: float | None) -> None:
        """Show `value` without announcing it; what a person is typing stays until they finish."""
        self._value = value
        if not (self.hasFocus() and self.isModified()):
            self.setText("" if value is None else self._show_as(value))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        steps = {Qt.Key.Key_Up: 1, Qt.Key.Key_Down: -1}
        if event.key() in steps and self._value is not None:
            self.setModified(False)
            self.entered.emit(self._step(self._value, steps[Qt.Key(event.key())]))
        elif event.key() == Qt.Key.Key_Escape:
            self._restore()
        else:
            super().keyPressEvent(event)

    def focusInEvent(self, event: QFocusEvent) -> None:
        super().focusInEvent(event)
        if event.reason() != Qt.FocusReason.MouseFocusReason:
            self.selectAll()

    def _commit(self) -> None:
        if not self.isModified():
            return
        typed = _number(self.text())
        self._restore()
        if typed is not None:
            self.entered.emit(typed)

    def _restore(self) -> None:
        self.setModified(False)
        self.show_value(self._value)


def _number(text: str) -> float | None:
    """What a person meant: "45°", "1,5e-3", "30 deg" are numbers."""
    cleaned = text.strip().removesuffix("deg").removesuffix("°").strip().replace(",", ".").replace("−", "-")
    try:
        return float(cleaned)
    except ValueError:
        return None
