"""Light and dark: one quiet palette each, one accent colour, the system's font."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QGuiApplication, QPalette, QPen
from PySide6.QtWidgets import QApplication

from .style_sheet import STYLE_SHEET

GRID = 8
"""Every distance in the window is a multiple of this, or half of it, in device-independent pixels."""
_ICONS = Path(__file__).parent.parent / "icons"


@dataclass(frozen=True)
class Theme:
    """Colours of the window as "#rrggbb"; colours that mean something live in `add_core.drawing.colours`."""

    name: str
    window: str
    panel: str
    field: str
    text: str
    muted: str
    line: str
    accent: str
    on_accent: str
    danger: str
    canvas_top: str
    canvas_bottom: str
    grid: str

    def colour(self, name: str) -> QColor:
        return QColor(getattr(self, name))


LIGHT = Theme(
    name="light",
    window="#f4f4f2",
    panel="#fbfbfa",
    field="#ffffff",
    text="#1f2328",
    muted="#646b74",
    line="#d9dadc",
    accent="#2f6db5",
    on_accent="#ffffff",
    danger="#b3261e",
    canvas_top="#fafaf8",
    canvas_bottom="#e6e8eb",
    grid="#e4e5e7",
)
DARK = Theme(
    name="dark",
    window="#26282c",
    panel="#2c2f33",
    field="#1f2124",
    text="#e8e9eb",
    muted="#a2a8b0",
    line="#43474d",
    accent="#7db2ee",
    on_accent="#14181d",
    danger="#ff8a80",
    canvas_top="#36393e",
    canvas_bottom="#232529",
    grid="#3b3f45",
)


def theme_of(choice: str) -> Theme:
    """The theme for "light", "dark" or "system"."""
    if choice == "system":
        dark = QGuiApplication.styleHints().colorScheme() == Qt.ColorScheme.Dark
        return DARK if dark else LIGHT
    return DARK if choice == "dark" else LIGHT


def apply_theme(theme: Theme) -> None:
    """Give `theme` to every window of the app."""
    app = QApplication.instance()
    assert isinstance(app, QApplication)
    app.setStyle("Fusion")
    app.setPalette(_palette(theme))
    icons = {name: (_ICONS / f"{name}-{theme.name}.svg").as_posix() for name in ("tick", "up", "down")}
    app.setStyleSheet(STYLE_SHEET.substitute(asdict(theme), **icons))


def round_pen(colour: QColor, width: float) -> QPen:
    """A solid pen with round ends."""
    return QPen(colour, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap)


def _palette(theme: Theme) -> QPalette:
    role = QPalette.ColorRole
    palette = QPalette()
    for roles, name in (
        ((role.Window, role.ToolTipBase, role.Light, role.Midlight), "window"),
        ((role.Base, role.AlternateBase), "field"),
        ((role.Button,), "panel"),
        ((role.WindowText, role.Text, role.ButtonText, role.ToolTipText, role.BrightText), "text"),
        ((role.Highlight, role.Link, role.Accent), "accent"),
        ((role.HighlightedText,), "on_accent"),
        ((role.Mid, role.Dark, role.Shadow), "line"),
        ((role.PlaceholderText,), "muted"),
    ):
        for each in roles:
            palette.setColor(each, theme.colour(name))
    for each in (role.WindowText, role.Text, role.ButtonText):
        faded = theme.colour("muted")
        faded.setAlpha(140)
        palette.setColor(QPalette.ColorGroup.Disabled, each, faded)
    return palette
