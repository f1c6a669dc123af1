"""Saving pictures and curves: ask, write whole or not at all, say what happened."""

from __future__ import annotations

import errno
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication, QDialog, QMessageBox

from ..models.results import Notice
from . import dialogs
from .main_window import MainWindow
from .theme import LIGHT

_FORBIDDEN = "Choose a folder that you may write to, such as your own."
REMEDIES = {
    errno.EACCES: _FORBIDDEN,
    errno.EPERM: _FORBIDDEN,
    errno.EROFS: _FORBIDDEN,
    errno.ENOENT: "Choose a folder that is there.",
    errno.ENOTDIR: "Choose a folder that is there.",
    errno.ENOSPC: "Free some space, or choose a folder on another disk.",
}
"""What to do about a file that could not be written, by the system's number of the reason."""


class WriteAtomically(Protocol):
    """Writes through a temporary file."""

    def __call__(self, path: Path, write: object) -> None: ...


class Saving:
    """The saving actions of the window."""

    def __init__(self, window: MainWindow, write_atomically, curves_table, explain) -> None:  # type: ignore[no-untyped-def]
        self._window = window
        self.write_whole, self._table, self.explain = write_atomically, curves_table, explain
        window.menus.on("screenshot", self.ask_picture)
        window.menus.on("curves", self.ask_curves)
        window.menus.on("open", self.ask_open)
        window.start.browse.connect(self.ask_open)
        window.menus.on("script", self.copy_script)
        self.write_script: Callable[[], str] = str
        window.menus.on("about", lambda: QMessageBox.about(window, "About", window.about_text))

    def copy_script(self) -> None:
        """Put the Python lines that compute what is shown on the clipboard."""
        script = self.write_script()
        if script:
            QApplication.clipboard().setText(script)
            lines = script.count("\n")
            self._window.statusBar().showMessage(f"Copied {lines} lines of Python; they need add_core alone", 6000)

    def ask_open(self) -> None:
        """Let the person choose files and open them."""
        for path in dialogs.ask_open(self._window, self._window.settings.folder):
            self._window.settings.folder = str(Path(path).parent)
            self._window.open_requested.emit(path)

    def ask_picture(self) -> None:
        """Ask for size and place, then save the view."""
        view = self._window.scene
        dialog = dialogs.PictureDialog(view.width(), view.height(), self._window)
        if dialog.exec() != QDialog.DialogCode.Accepted:
            return
        path = dialogs.ask_picture(self._window, self._window.settings.folder, self.name)
        if path is not None:
            self.save_picture(path, dialog.choice)

    def save_picture(self, path: Path, choice: dialogs.PictureChoice) -> None:
        """Save the view as a PNG."""
        view = self._window.scene
        image = view.picture(choice.scale, transparent=choice.transparent, labels=choice.labels)
        self.write(path, lambda temporary: save_image(image, temporary))

    def ask_curves(self) -> None:
        """Ask for place and format, then save the curves."""
        path = dialogs.ask_curves(self._window, self._window.settings.folder, f"{self.name} curves")
        if path is not None:
            self.save_curves(path)

    def save_curves(self, path: Path) -> None:
        """Save the curves as PNG, SVG or PDF for print, or as CSV."""
        if path.suffix.lower() == ".csv":
            results, alpha = self._window.results, self._window.session.state.diffusion.alpha
            text = self._table(results.curves, alpha)
            self.write(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))
        else:
            self.write(path, lambda temporary: self._window.curves.save(temporary, LIGHT))

    def write(self, path: Path, write) -> None:  # type: ignore[no-untyped-def]
        """Let `write` fill the file at `path`, whole or not at all, and say what happened."""
        self._window.message.begin()
        try:
            self.write_whole(path, write)
        except OSError as error:
            self.tell_not_saved(path, error)
            return
        self.tell_saved(path)

    def may_write(self, path: Path) -> bool:
        """Whether a file can be made beside `path`; if not, says so before any work is done for it."""
        try:
            with tempfile.TemporaryFile(dir=path.parent):
                return True
        except OSError as error:
            self.tell_not_saved(path, OSError(error.errno, error.strerror, str(path)))
            return False

    def tell_not_saved(self, path: Path, error: BaseException) -> None:
        """Say why there is no file at `path`, and what to do."""
        self._window.results.noticed.emit(not_saved(path, error, self.explain))

    def tell_saved(self, path: Path) -> None:
        """Say where it is, and begin there next time."""
        self._window.message.succeed()
        self._window.settings.folder = str(path.parent)
        self._window.statusBar().showMessage(f"Saved {path}", 6000)

    @property
    def name(self) -> str:
        """What a file about the active shape may be called."""
        shape = self._window.session.state.active
        return "shape" if shape is None else shape.name.replace("/", "-").replace(",", "")


def not_saved(path: Path, error: BaseException, explain: Callable[[BaseException], str]) -> Notice:
    """The message about a file that could not be written."""
    remedy = REMEDIES.get(error.errno, "") if isinstance(error, OSError) and error.errno is not None else ""
    return Notice(" ".join(part for part in (f"{path.name} was not saved: {explain(error)}", remedy) if part))


def save_image(image: QImage, path: Path) -> None:
    """Write a picture; raises OSError if Qt cannot."""
    if not image.save(str(path), "PNG"):  # type: ignore[call-overload]  # the stub wants bytes, Qt text
        raise OSError(5, "the picture could not be written; is the disk full?", str(path))
