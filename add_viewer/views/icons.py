"""Icons of one set (Material Design Icons), in the colours of the theme."""

from __future__ import annotations

import qtawesome
from PySide6.QtGui import QIcon


def icon(name: str, colour: str) -> QIcon:
    """The icon `name` of the set, e.g. "mdi6.folder-open-outline", drawn in `colour`."""
    made: QIcon = qtawesome.icon(name, color=colour)
    return made
