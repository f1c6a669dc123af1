"""Light and dark: one quiet palette each, one accent colour, the system's font."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QGuiApplication, QPalette, QPen
from PySide6.QtWidgets import QApplication

GRID = 8
"""Every distance in the window is a multiple of this, or half of it, in device-independent pixels."""


@dataclass(frozen=True)
class Theme:
    """Colours of the window as "#rrggbb"; colours that mean something live in `models.colours`."""

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
    app.setStyleSheet(_style_sheet(theme))


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


def _style_sheet(theme: Theme) -> str:
    return f"""
QMainWindow::separator {{ background: {theme.line}; width: 1px; height: 1px; }}
DockTitle {{ border-bottom: 1px solid {theme.line}; }}
QMenuBar {{ background: {theme.window}; padding: 2px 4px; border-bottom: 1px solid {theme.line}; }}
QMenuBar::item {{ padding: 4px 8px; border-radius: 4px; background: transparent; }}
QMenuBar::item:selected, QMenu::item:selected {{ background: {theme.accent}; color: {theme.on_accent}; }}
QMenu {{ background: {theme.panel}; border: 1px solid {theme.line}; padding: 4px; }}
QMenu::item {{ padding: 5px 28px 5px 24px; border-radius: 4px; }}
QMenu::item:disabled {{ color: {theme.muted}; }}
QMenu::icon:checked {{ border: 1px solid {theme.accent}; border-radius: 3px; padding: 2px; }}
QDialogButtonBox {{ dialogbuttonbox-buttons-have-icons: 0; }}
QCheckBox {{ spacing: 8px; }}
QCheckBox::indicator {{ width: 12px; height: 12px; border: 1px solid {theme.muted}; border-radius: 3px;
    background: {theme.field}; }}
QCheckBox::indicator:checked {{ background: {theme.accent}; border-color: {theme.accent}; }}
QMenu::separator {{ height: 1px; background: {theme.line}; margin: 4px 8px; }}
QStatusBar {{ background: {theme.window}; border-top: 1px solid {theme.line}; }}
QStatusBar QLabel {{ color: {theme.muted}; padding: 0 8px; }}
QStatusBar::item {{ border: none; }}
QLineEdit {{ background: {theme.field}; border: 1px solid {theme.line}; border-radius: 4px; padding: 3px 6px;
    min-height: 18px; selection-background-color: {theme.accent}; selection-color: {theme.on_accent}; }}
QLineEdit:focus {{ border: 1px solid {theme.accent}; }}
QComboBox {{ min-height: 22px; }}
QPushButton, QToolButton {{ background: {theme.panel}; border: 1px solid {theme.line}; border-radius: 4px;
    padding: 4px 10px; min-height: 18px; }}
QToolButton {{ padding: 4px; }}
QToolButton:disabled, QPushButton:disabled {{ color: {theme.muted}; }}
QToolButton[quiet="true"] {{ border: 1px solid transparent; background: transparent; }}
QPushButton:hover, QToolButton:hover {{ border-color: {theme.muted}; }}
QPushButton:pressed, QToolButton:pressed, QToolButton:checked, QPushButton:checked {{ border-color: {theme.accent};
    color: {theme.accent}; }}
QPushButton:focus, QToolButton:focus {{ border-color: {theme.accent}; }}
QPushButton[primary="true"] {{ background: {theme.accent}; color: {theme.on_accent}; border-color: {theme.accent};
    font-weight: 600; padding: 6px 16px; }}
QToolTip {{ background: {theme.panel}; color: {theme.text}; border: 1px solid {theme.line}; padding: 4px; }}
QLabel[role="muted"] {{ color: {theme.muted}; }}
QLabel[role="heading"] {{ font-weight: 600; }}
QScrollArea, QListView {{ border: none; background: transparent; }}
QScrollBar {{ background: transparent; border: none; margin: 0; }}
QScrollBar:vertical {{ width: 10px; }}
QScrollBar:horizontal {{ height: 10px; }}
QScrollBar::handle {{ background: {theme.line}; border-radius: 4px; margin: 1px; min-height: 32px; min-width: 32px; }}
QScrollBar::handle:hover {{ background: {theme.muted}; }}
QScrollBar::add-line, QScrollBar::sub-line {{ width: 0; height: 0; }}
QScrollBar::add-page, QScrollBar::sub-page {{ background: transparent; }}
QProgressBar {{ border: none; border-radius: 2px; background: {theme.line}; max-height: 4px; }}
QProgressBar::chunk {{ background: {theme.accent}; border-radius: 2px; }}
"""
