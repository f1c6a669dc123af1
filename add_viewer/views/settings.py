"""What is kept between starts: taste, window layout, recent files."""

from __future__ import annotations

from PySide6.QtCore import QByteArray, QSettings
from PySide6.QtWidgets import QMainWindow

from ..models.display import Display

RECENT_LIMIT = 10
LAYOUT_VERSION = 1
"""Raised when panels are added or renamed: a state that Qt packed for others must not be restored."""


class Settings:
    """The user's settings in the place that the platform has for them."""

    def __init__(self, store: QSettings | None = None) -> None:
        self._store = store or QSettings("AnisotropicDiffusionDescriptors", "add-viewer")

    def restore_display(self, display: Display) -> None:
        """Give `display` its kept values and keep every change from now on."""
        for name, value in display.as_dict().items():
            kept = self._store.value(f"display/{name}", value)
            display.set(name, kept in (True, "true") if isinstance(value, bool) else kept)
        display.changed.connect(self._keep_display)
        self._display = display

    def _keep_display(self, name: str) -> None:
        self._store.setValue(f"display/{name}", self._display[name])

    def restore_window(self, window: QMainWindow) -> bool:
        """Bring back size, place and docks; False if nothing is known."""
        geometry, state = self._store.value("window/geometry"), self._store.value("window/state")
        if not isinstance(geometry, QByteArray) or not isinstance(state, QByteArray):
            return False
        return window.restoreGeometry(geometry) and window.restoreState(state, LAYOUT_VERSION)

    def keep_window(self, window: QMainWindow) -> None:
        """Remember size, place and docks."""
        self._store.setValue("window/geometry", window.saveGeometry())
        self._store.setValue("window/state", window.saveState(LAYOUT_VERSION))

    @property
    def recent(self) -> list[str]:
        return self._list("recent")

    def add_recent(self, reference: str) -> None:
        """Put `reference` first."""
        others = [each for each in self.recent if each != reference]
        self._store.setValue("recent", [reference, *others][:RECENT_LIMIT])

    def remove_recent(self, reference: str) -> None:
        """Forget one of them."""
        self._store.setValue("recent", [each for each in self.recent if each != reference])

    def clear_recent(self) -> None:
        self._store.setValue("recent", [])

    @property
    def recent_commands(self) -> list[str]:
        """What was done through the command palette lately, the newest first."""
        return self._list("palette/recent")

    @recent_commands.setter
    def recent_commands(self, names: list[str]) -> None:
        self._store.setValue("palette/recent", names)

    def _list(self, name: str) -> list[str]:
        kept = self._store.value(name, [])
        return [kept] if isinstance(kept, str) else [str(each) for each in kept] if isinstance(kept, list) else []

    @property
    def cache_limit(self) -> float | None:
        """Gigabytes that spectra may take on disk; None: as the core has it."""
        try:
            return float(str(self._store.value("cache/gigabytes", "")))
        except ValueError:
            return None

    @cache_limit.setter
    def cache_limit(self, gigabytes: float) -> None:
        self._store.setValue("cache/gigabytes", gigabytes)

    @property
    def folder(self) -> str:
        """Where files were opened or saved last."""
        return str(self._store.value("folder", ""))

    @folder.setter
    def folder(self, path: str) -> None:
        self._store.setValue("folder", path)
