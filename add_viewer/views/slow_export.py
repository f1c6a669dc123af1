"""Exports that take a while: a bar above the views says how far they are, and the window stays free."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QProgressBar, QPushButton

from ..models.results import Notice
from .theme import GRID, Theme

if TYPE_CHECKING:
    from .main_window import MainWindow
    from .saving import Saving


class ExportBar(QFrame):
    """How far an export is, and the way out."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("export")
        self.text, self.progress, self.cancel = QLabel(), QProgressBar(), QPushButton("Cancel")
        self.progress.setTextVisible(False)
        row = QHBoxLayout(self)
        row.setContentsMargins(2 * GRID, GRID, 2 * GRID, GRID)
        row.setSpacing(2 * GRID)
        row.addWidget(self.text)
        row.addWidget(self.progress, 1)
        row.addWidget(self.cancel)
        self.hide()

    def show_progress(self, words: str, done: int, total: int) -> None:
        """What is being done, and so many steps of so many."""
        self.text.setText(words)
        self.progress.setRange(0, total)
        self.progress.setValue(done)

    def show_theme(self, theme: Theme) -> None:
        """A bar with the accent colour at its edge."""
        self.setStyleSheet(
            f"#export {{ background: {theme.panel}; border: none; border-left: 4px solid {theme.accent};"
            f" border-bottom: 1px solid {theme.line}; }}"
        )


class SlowExport:
    """What such exports share. run : does work off the window's thread. action : of the menu that begins it."""

    def __init__(self, window: MainWindow, saving: Saving, run: Callable[..., None], action: str) -> None:
        self._window, self._saving, self._run, self._action = window, saving, run, action
        self._path = Path()
        self.bar = ExportBar()
        window.add_above(self.bar)
        window.menus.on(action, self.ask)

    def ask(self) -> None:
        """Ask what to export and where to save it, then begin."""
        raise NotImplementedError

    def _begin(self, path: Path) -> None:
        self._path = path
        self._window.message.begin()
        self._window.menus.actions[self._action].setEnabled(False)
        self.bar.cancel.setEnabled(True)
        self.bar.show()

    def _write(self, write: Callable[[Path], object]) -> None:
        """Write the file by `write` on the thread, as a whole or not at all."""
        path = self._path
        self.bar.text.setText(f"Writing {path.name} …")
        self.bar.cancel.setEnabled(False)
        self._run(
            "export",
            lambda: self._saving.write_whole(path, write),
            done=lambda _answer: self._written(path),
            failed=self._failed,
            queue=True,
        )

    def _written(self, path: Path) -> None:
        self._rest()
        self._saving.tell_saved(path)

    def _failed(self, error: BaseException) -> None:
        self._rest()
        self._saving.tell_not_saved(self._path, error)

    def _not_saved(self, reason: str) -> None:
        self._window.results.noticed.emit(Notice(f"{self._path.name} was not saved: {reason}"))

    def _rest(self) -> None:
        self.bar.hide()
        self._window.menus.actions[self._action].setEnabled(bool(self._window.session.state.shapes))
