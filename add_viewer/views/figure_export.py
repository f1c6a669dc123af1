"""File → Export figure: what the window shows, composed on one white page."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QTimer
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QDialog

from .figure_dialog import FigureDialog, ask_figure
from .figure_page import Page, PageChoice
from .figure_plates import Plate, cut_alike, plate_steps, plates_of
from .shape_view import ShapeView
from .slow_export import SlowExport
from .theme import LIGHT

if TYPE_CHECKING:
    from .main_window import MainWindow
    from .saving import Saving

_PREVIEW_DPI = 90
_FINEST = 6
"""How many times as fine as the screen the shapes are drawn at most."""
_PAUSE = 10
"""Milliseconds for the window between two views."""


class FigureExport(SlowExport):
    """Takes the views' pictures, asks how the page shall be, and saves it while the window works on.

    run : does work off the window's thread.
    """

    def __init__(self, window: MainWindow, saving: Saving, run: Callable[..., None]) -> None:
        super().__init__(window, saving, run, "figure")
        self._steps: list[Callable[[], Plate]] = []
        self._plates: list[Plate] = []
        self._views: list[ShapeView] = []
        self._choice = PageChoice()
        self._timer = QTimer(window, singleShot=True, interval=_PAUSE)
        self._timer.timeout.connect(self._go_on)
        self.bar.cancel.clicked.connect(self.cancel)

    def ask(self) -> None:
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

    # -- saving, step by step -----------------------------------------------------------------------------------------

    def save(self, path: Path, choice: PageChoice) -> None:
        """Save the figure, its shapes as fine as asked for: one view after the other, then the page on the thread."""
        self._choice, self._plates = choice, []
        self._views = list(self._window.scene.views)
        pixels = choice.dpi * choice.cell(len({view.x() for view in self._views})) / 25.4
        shown = max(view.width() for view in self._views)
        self._steps = plate_steps(self._views, min(max(1, ceil(pixels / shown)), _FINEST))
        self._begin(path)
        self._draw_next()

    @property
    def is_running(self) -> bool:
        """Whether a figure is on its way."""
        return self.bar.isVisibleTo(self._window)

    def cancel(self) -> None:
        """Leave the figure; nothing was written."""
        self._timer.stop()
        self._rest()

    def _go_on(self) -> None:
        if self._window.scene.views != self._views:
            self.cancel()
            self._not_saved("the views changed meanwhile.")
        elif self._steps:
            self._plates.append(self._steps.pop(0)())
            self._draw_next()
        else:
            self._write(self.page(cut_alike(self._plates), self._choice).save)

    def _draw_next(self) -> None:
        self.bar.show_progress(f"Drawing {self._path.name} …", len(self._plates), len(self._views) + 1)
        self._timer.start()

    def _rest(self) -> None:
        self._steps, self._plates, self._views = [], [], []
        super()._rest()

    # -- the page -----------------------------------------------------------------------------------------------------

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
