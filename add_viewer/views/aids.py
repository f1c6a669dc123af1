"""What helps a person find their way: the command palette, the shortcut sheet, the settings."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from ..models.commands import Command
from .command_palette import CommandPalette
from .settings_dialog import Disk, SettingsDialog
from .shortcut_sheet import ShortcutSheet
from .theme import Theme

if TYPE_CHECKING:
    from .main_window import MainWindow


class Aids:
    """Wires them to the window's menus."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.palette = CommandPalette(window, window.settings)
        self.palette.sources += [self._open_shapes, self._shipped_shapes]
        window.menus.on("palette", self.palette.open)
        window.menus.on("shortcuts", self.show_shortcuts)
        window.menus.on("settings", self.show_settings)
        self.disk: Disk | None = None

    def show_shortcuts(self) -> None:
        """The sheet of what mouse and keyboard do."""
        self.sheet = ShortcutSheet(self._window)
        self.sheet.open()

    def show_settings(self) -> None:
        """The settings, beside the window that they change."""
        assert self.disk is not None, "the assembly says where spectra are kept"
        self.settings = SettingsDialog(self._window.display, self.disk, self._window.reset_layout, self._window)
        self.settings.show()

    def show_theme(self, theme: Theme) -> None:
        """The palette in the theme's colours."""
        self.palette.show_theme(theme)

    # -- what else the palette offers ---------------------------------------------------------------------------------

    def _open_shapes(self) -> Iterator[Command]:
        session = self._window.session
        for shape in session.state.shapes:
            if shape.key != session.state.active_key:
                show = partial(session.show_shape, shape.key)
                yield Command(f"show {shape.key}", f"Go to {shape.name}", "Shapes", show)

    def _shipped_shapes(self) -> Iterator[Command]:
        for gallery in self._window.start.galleries:
            for number, name in enumerate(gallery.shapes):
                reference = f"{gallery.name}/{number}"
                yield Command(
                    name=f"open {reference}",
                    title=f"Open {name}",
                    section=gallery.title,
                    do=partial(self._window.open_requested.emit, reference),
                    help=reference,
                    on_search=True,
                )
