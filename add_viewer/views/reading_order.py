"""Tab and Shift+Tab go through a window as one reads it, also to what was put there later."""

from __future__ import annotations

from PySide6.QtCore import QRect, Qt
from PySide6.QtWidgets import QApplication, QScrollArea, QWidget


def reading_order(root: QWidget) -> list[QWidget]:
    """What takes the keyboard in `root`: line by line, each line from left to right, and part after part.

    A part is a widget with others inside: it is left only after its last one.
    """
    parts = [each for each in root.children() if isinstance(each, QWidget) and _is_seen(each)]
    found: list[QWidget] = []
    for line in _lines(parts):
        for part in sorted(line, key=lambda each: each.x()):
            found += [part] if _takes_keys(part) else reading_order(part)
    return found


def go(window: QWidget, *, forward: bool) -> bool:
    """Give the keyboard to the next or the previous control of `window`; False if there is none."""
    stops = reading_order(window)
    here = QApplication.focusWidget()
    if not stops:
        return False
    if here in stops:
        at = (stops.index(here) + (1 if forward else -1)) % len(stops)
    else:
        at = _nearest(stops, here, forward=forward)
    stops[at].setFocus(Qt.FocusReason.TabFocusReason if forward else Qt.FocusReason.BacktabFocusReason)
    _bring_into_sight(stops[at])
    return True


def _nearest(stops: list[QWidget], here: QWidget | None, *, forward: bool) -> int:
    """Where to begin from something that is not in the order: inside of it, or else at an end."""
    inside = [at for at, stop in enumerate(stops) if here is not None and here.isAncestorOf(stop)]
    if forward:
        return inside[0] if inside else 0
    return inside[-1] if inside else len(stops) - 1


def _is_seen(widget: QWidget) -> bool:
    """Panels behind others and the tabs of hidden ones count as visible for Qt, but have no place to be seen in."""
    if not widget.isVisible() or widget.isWindow():
        return False
    parent = widget.parentWidget()
    return parent is None or not parent.isWindow() or not widget.visibleRegion().isEmpty()


def _takes_keys(widget: QWidget) -> bool:
    if isinstance(widget, QScrollArea):
        return False  # it scrolls to whatever in it has the keyboard
    tabs = widget.focusPolicy().value & Qt.FocusPolicy.TabFocus.value
    return bool(tabs) and widget.isEnabled() and widget.focusProxy() is None


def _lines(parts: list[QWidget]) -> list[list[QWidget]]:
    """Parts that stand side by side, at least by half of the lower one's height, from the top to the bottom."""
    lines: list[list[QWidget]] = []
    for part in sorted(parts, key=lambda each: (each.y(), each.x())):
        if lines and all(_beside(part.geometry(), other.geometry()) for other in lines[-1]):
            lines[-1].append(part)
        else:
            lines.append([part])
    return lines


def _beside(one: QRect, two: QRect) -> bool:
    shared = min(one.bottom(), two.bottom()) - max(one.top(), two.top()) + 1
    return 2 * shared > min(one.height(), two.height())


def _bring_into_sight(widget: QWidget) -> None:
    parent = widget.parentWidget()
    while parent is not None:
        if isinstance(parent, QScrollArea):
            parent.ensureWidgetVisible(widget, 0, 16)
        parent = parent.parentWidget()
