"""A window on small shapes, driven like a person drives it."""

from __future__ import annotations

import fcntl
import os
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from add_core.geometry import shapes
from add_viewer.models.shapes import OpenShape


@dataclass
class ManualRun:
    """Work waits until a test does it: controllers are tested without threads and without Qt."""

    waiting: list[tuple[str, Callable[[], Any], Callable[[Any], None], Callable[[BaseException], None]]] = field(
        default_factory=list
    )

    def __call__(self, lane, work, *, done, failed, queue=False) -> None:
        self.waiting.append((lane, work, done, failed))

    def answer(self, index: int = 0) -> None:
        """Do one waiting piece of work and deliver the answer."""
        _, work, done, failed = self.waiting.pop(index)
        try:
            value = work()
        except Exception as error:  # noqa: BLE001
            failed(error)
        else:
            done(value)

    def answer_all(self) -> None:
        while self.waiting:
            self.answer()


@pytest.fixture
def run() -> ManualRun:
    return ManualRun()


def torus_shape(key: str = "torus", *, symmetry: np.ndarray | None = None) -> OpenShape:
    """A small torus, whose principal directions are known everywhere."""
    mesh = shapes.torus(major=0.3, minor=0.12, around=24, through=12)
    return OpenShape(key=key, reference=key, name=key, shape=mesh, diameter=1.0, symmetry=symmetry, up="+y", front="+z")


@pytest.fixture
def make_torus() -> Callable[..., OpenShape]:
    return torus_shape


@pytest.fixture
def torus() -> OpenShape:
    return torus_shape()


@pytest.fixture(autouse=True)
def data_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the app keeps a person's data: in a test, nowhere else than in its own folder."""
    folder = tmp_path / "data"
    monkeypatch.setenv("ADD_DATA_DIR", str(folder))
    return folder


@pytest.fixture
def screen() -> Iterator[None]:
    """The screen for one test at a time: windows of two processes would take the keyboard from each other."""
    display = os.environ.get("DISPLAY")
    if not display:
        pytest.skip('needs a screen: xvfb-run -a -s "-screen 0 1440x900x24" python -m pytest')
    lock = Path(tempfile.gettempdir()) / f"add-viewer-tests{display.replace('/', '_')}.lock"
    with lock.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@pytest.fixture
def assembly(screen, qapp, tmp_path: Path) -> Iterator[Any]:
    """The whole app with settings of its own, nothing opened."""
    from PySide6.QtCore import QSettings

    from add_viewer.assembly import Assembly

    store = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
    made = Assembly([], store=store, size=(1200, 800), theme="light")
    made.window.show()
    made.window.activateWindow()
    yield made
    made.stop()
    made.window.deleteLater()
    qapp.processEvents()


class Person:
    """What a person at the window does, with mouse and keys."""

    def __init__(self, assembly: Any, qtbot: Any) -> None:
        self.assembly, self.qtbot = assembly, qtbot
        self.window, self.session, self.results = assembly.window, assembly.session, assembly.results

    @property
    def canvas(self) -> Any:
        """Where the active shape is drawn."""
        return self.window.view.canvas

    def open(self, reference: str = "humans/0") -> None:
        self.window.open_requested.emit(reference)
        self.qtbot.waitUntil(lambda: self.session.state.active_key == reference, timeout=20000)
        self.qtbot.waitUntil(lambda: self.results.weyl_eigenvalue is not None, timeout=20000)

    def place(self, vertex: int):
        return self.canvas.place_of(vertex).toPoint()

    def click(self, vertex: int, modifier: Any = None, button: Any = None) -> None:
        from PySide6.QtCore import Qt

        self.qtbot.mouseClick(
            self.canvas,
            button or Qt.MouseButton.LeftButton,
            modifier or Qt.KeyboardModifier.NoModifier,
            self.place(vertex),
        )

    def type_into(self, field: Any, text: str) -> None:
        from PySide6.QtCore import Qt

        field.setFocus()
        field.selectAll()
        self.qtbot.keyClicks(field, text)
        self.qtbot.keyClick(field, Qt.Key.Key_Return)

    def wait_for_kernel(self, before: Any = None) -> Any:
        self.qtbot.waitUntil(
            lambda: self.results.kernel is not None and self.results.kernel is not before, timeout=20000
        )
        return self.results.kernel

    def pixels(self) -> np.ndarray:
        """(h, w, 3) what the canvas shows now."""
        from PySide6.QtGui import QImage

        image = self.canvas.grabFramebuffer().convertToFormat(QImage.Format.Format_RGB888)
        flat = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
        return flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(int)


@pytest.fixture
def person(assembly: Any, qtbot: Any) -> Person:
    return Person(assembly, qtbot)
