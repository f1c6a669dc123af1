"""The session's actions: save, open, go on with the last one, and what a crash left."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from PySide6.QtCore import QByteArray
from PySide6.QtWidgets import QFileDialog

from ..models.session_file import ENDING, CameraPlace, KeptSession
from .restore_banner import RestoreBanner
from .saving import not_saved
from .settings import LAYOUT_VERSION

if TYPE_CHECKING:
    from .main_window import MainWindow

SESSION_FILTER = f"Sessions (*{ENDING});;All files (*)"


class Keeping(Protocol):
    """What keeps sessions, as the views see it."""

    path: Path | None

    @property
    def last(self) -> Path | None:
        """The session as it was when the app was closed last."""

    def save(self, path: Path) -> None:
        """Write the session."""

    def open(self, path: Path) -> None:
        """Open a session."""

    def open_last(self) -> None:
        """Go on with it."""

    def remember_soon(self) -> None:
        """Something changed that no model tells of."""


class SessionFiles:
    """Asks where, says what happened, and brings cameras and panels back."""

    def __init__(self, window: MainWindow, keeping: Keeping, explain: Callable[[BaseException], str]) -> None:
        self._window, self._keeping, self._explain = window, keeping, explain
        self._layout = ""
        self.banner = RestoreBanner()
        window.add_above(self.banner)
        window.scene.camera_moved.connect(keeping.remember_soon)
        for name, do in (
            ("save_session", self.save),
            ("save_session_as", self.ask_save),
            ("open_session", self.ask_open),
            ("last_session", keeping.open_last),
        ):
            window.menus.on(name, do)
        window.session.history_changed.connect(self._show_state)
        window.menus.file.aboutToShow.connect(self._show_state)
        self._show_state()

    def _show_state(self) -> None:
        opened = bool(self._window.session.state.shapes)
        for name in ("save_session", "save_session_as"):
            self._window.menus.actions[name].setEnabled(opened)
        self._window.menus.actions["last_session"].setEnabled(self._keeping.last is not None)

    # -- what a person does -------------------------------------------------------------------------------------------

    def save(self) -> None:
        """Save where it was saved before, or ask."""
        if self._keeping.path is None:
            self.ask_save()
        else:
            self.save_as(self._keeping.path)

    def ask_save(self) -> None:
        """Ask for a place, then save."""
        shape = self._window.session.state.active
        name = "session" if shape is None else shape.name.replace("/", "-").replace(",", "")
        start = self._keeping.path or Path(self._window.settings.folder) / f"{name}{ENDING}"
        chosen = QFileDialog.getSaveFileName(self._window, "Save session", str(start), SESSION_FILTER)[0]
        if chosen:
            path = Path(chosen)
            self.save_as(path if path.suffix else path.with_suffix(ENDING))

    def save_as(self, path: Path) -> None:
        """Save to `path` and say so."""
        self._window.message.begin()
        try:
            self._keeping.save(path)
        except OSError as error:
            self._window.results.noticed.emit(not_saved(path, error, self._explain))
            return
        self._window.message.succeed()
        self._window.settings.folder = str(path.parent)
        self._window.statusBar().showMessage(f"Saved {path}", 6000)

    def ask_open(self) -> None:
        """Ask which session to open."""
        folder = self._window.settings.folder
        chosen = QFileDialog.getOpenFileName(self._window, "Open session", folder, SESSION_FILTER)[0]
        if chosen:
            self._window.settings.folder = str(Path(chosen).parent)
            self._window.message.begin()
            self._keeping.open(Path(chosen))

    # -- what no model holds ------------------------------------------------------------------------------------------

    def cameras(self) -> tuple[CameraPlace, ...]:
        """Where the eyes of the views are."""
        state = self._window.session.state
        numbers = {shape.key: index for index, shape in enumerate(state.shapes)}
        views = [view for view in self._window.scene.views if view.key in numbers]
        return tuple(_camera(view, numbers[view.key or ""]) for view in views)

    def layout(self) -> str:
        """The panels' places, packed by Qt, as base64; while they are hidden, as they were before."""
        if self._window.pages.currentWidget() is self._window.scene:
            packed = self._window.saveState(LAYOUT_VERSION).toBase64()
            self._layout = bytes(packed.data()).decode("ascii")
        return self._layout

    def apply(self, kept: KeptSession) -> None:
        """Put panels and cameras where they were."""
        if kept.layout:
            packed = QByteArray.fromBase64(kept.layout.encode("ascii", "ignore"))
            self._window.restoreState(packed, LAYOUT_VERSION)
        shapes = self._window.session.state.shapes
        by_place = {(view.key, view.panel): view for view in self._window.scene.views}
        for camera in kept.cameras:
            with suppress(IndexError):
                view = by_place.get((shapes[camera.shape].key, camera.panel))
                if view is not None:
                    place = (camera.azimuth, camera.elevation, camera.focal, camera.distance)
                    view.canvas.stand(*place, fitted=camera.fitted)


class Crashed(Protocol):
    """What knows of sessions that a crash left."""

    def leftovers(self) -> list[Any]:
        """The newest first."""

    def restore(self, leftover: Any) -> None:
        """Go on with one."""

    def discard(self, leftover: Any) -> None:
        """Forget one."""


class Recovery:
    """Offers what a crash left, one session after the other."""

    def __init__(self, keeping: Crashed, banner: RestoreBanner) -> None:
        self._keeping, self._banner = keeping, banner
        self._waiting: list[Any] = []
        banner.restore.connect(lambda: self._answer(keeping.restore))
        banner.discard.connect(lambda: self._answer(keeping.discard))

    def offer(self) -> None:
        """Ask about the sessions that are there now."""
        self._waiting = self._keeping.leftovers()
        self._ask()

    def _ask(self) -> None:
        self._banner.hide()
        if self._waiting:
            self._banner.offer(self._waiting[0].kept)

    def _answer(self, do: Callable[[Any], None]) -> None:
        do(self._waiting.pop(0))
        self._ask()


def _camera(view: Any, number: int) -> CameraPlace:
    """Of a camera that shows the whole shape only the side is kept: how far away it is depends on the view."""
    model, fitted = view.canvas.camera_model, view.canvas.is_fitted
    kept = CameraPlace(number, view.panel, float(model.azimuth), float(model.elevation), fitted=fitted)
    if fitted:
        return kept
    x, y, z = (float(each) for each in model.focal)
    return replace(kept, focal=(x, y, z), distance=float(model.distance))
