"""File → Export figure: what the window shows, composed on one white page."""

from __future__ import annotations

from io import BytesIO
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication, QImage
from PySide6.QtWidgets import QDialog

from .figure_dialog import FigureDialog, ask_figure
from .figure_page import Page, PageChoice
from .figure_plates import Plate, plates_of
from .theme import LIGHT

if TYPE_CHECKING:
    from .main_window import MainWindow
    from .saving import Saving

_PREVIEW_DPI = 90
_FINEST = 6
"""How many times as fine as the screen the shapes are drawn at most."""


class FigureExport:
    """Takes the views' pictures, asks how the page shall be, and saves it."""

    def __init__(self, window: MainWindow, saving: Saving) -> None:
        self._window, self._saving = window, saving
        window.menus.on("figure", self.ask)

    def ask(self) -> None:
        """Ask for size, contents and place, then save the figure."""
        plates = self.plates(1.0)
        dialog = FigureDialog(
            lambda choice: self._picture(plates, choice), has_curves=self._has_curves, parent=self._window
        )
        self.dialog = dialog
        if dialog.exec() != QDialog.DialogCode.Accepted:
            return
        path = ask_figure(self._window, self._window.settings.folder, self._saving.name)
        if path is not None:
            self.save(path, dialog.choice)

    def save(self, path: Path, choice: PageChoice) -> None:
        """Save the figure, its shapes as fine as asked for."""
        QGuiApplication.setOverrideCursor(Qt.CursorShape.WaitCursor)
        try:
            views = self._window.scene.views
            pixels = choice.dpi * choice.cell(len({view.x() for view in views})) / 25.4
            shown = max(view.width() for view in views)
            scale = min(max(1, ceil(pixels / shown)), _FINEST)
            page = self.page(self.plates(scale), choice)
            self._saving.write(path, lambda temporary: page.save(temporary))
        finally:
            QGuiApplication.restoreOverrideCursor()

    def plates(self, scale: float) -> list[Plate]:
        """The views, `scale` times as fine as on the screen."""
        return plates_of(self._window.scene.views, scale)

    def page(self, plates: list[Plate], choice: PageChoice) -> Page:
        """The page of these views, with the curves if there are any."""
        return Page(plates, choice, self._draw_curves if self._has_curves else None)

    @property
    def _has_curves(self) -> bool:
        return bool(self._window.curves.scene().shown)

    def _draw_curves(self, figure: Any, width: float, height: float) -> None:
        self._window.curves.draw_into(figure, width, height, LIGHT)

    def _picture(self, plates: list[Plate], choice: PageChoice) -> QImage:
        buffer = BytesIO()
        page = self.page(plates, choice)
        page.figure.savefig(buffer, format="png", dpi=_PREVIEW_DPI, facecolor="white")
        return QImage.fromData(buffer.getvalue())
