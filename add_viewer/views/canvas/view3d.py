"""A PyVista scene in a Qt widget, with exactly one VTK render for each Qt paint."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

os.environ.setdefault("QT_API", "pyside6")

from PySide6.QtCore import QEvent, QTimer
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QEnterEvent, QHideEvent, QKeyEvent, QResizeEvent
from pyvistaqt import QtInteractor

SAMPLES = 4
"""Samples a pixel in pictures at rest; in software each doubles the time."""

SOON = 80
"""Milliseconds that a small change waits for a larger one, to be drawn with it."""

STILL = 200
"""Milliseconds without a change after which a picture is at rest."""

_COLOURS_AND_DEPTH = 0x4000 | 0x100
"""GL_COLOR_BUFFER_BIT and GL_DEPTH_BUFFER_BIT."""


class View3D(QtInteractor):  # type: ignore[misc]
    """QtInteractor whose renders are merged into Qt's paints, and whose mouse and keys belong to the window.

    QtInteractor renders on every change and then again when Qt paints; here a change only asks for a paint. VTK's own
    key bindings ("w", "q", …) and mouse styles are switched off: `Canvas` moves the camera.
    """

    def __init__(self, parent: Any = None) -> None:
        self._resizing = False
        super().__init__(parent, auto_update=False, multi_samples=SAMPLES, lighting="none")
        self.samples = SAMPLES
        self._stillness = QTimer(self, singleShot=True, interval=STILL)
        self._stillness.timeout.connect(self._refine)
        self._waiting = QTimer(self, singleShot=True, interval=SOON)
        self._waiting.timeout.connect(self.draw_moving)
        self._Iren.EnableRenderOff()
        self._Iren.SetInteractorStyle(None)

    def draw_moving(self) -> None:
        """Paint soon, with one sample a pixel: while things move, speed counts; edges are smoothed once they rest."""
        if self.render_window is None:  # closed
            return
        self.render_window.SetMultiSamples(0)
        self.show_moving(True)
        self._stillness.start()
        self.update()

    @property
    def is_moving(self) -> bool:
        """Whether a picture of smoother edges is about to follow."""
        return bool(self._stillness.isActive())

    def draw_soon(self) -> None:
        """Paint within a moment, and only once if what is shown changes meanwhile."""
        if not self._waiting.isActive():
            self._waiting.start()

    def _refine(self) -> None:
        if not getattr(self, "_closed", False):
            self.render_window.SetMultiSamples(self.samples)
            self.show_moving(False)
            self.update()

    def show_moving(self, on: bool) -> None:
        """Draw what is quick to draw, or everything. Subclasses know what that is."""

    def _render(self, *_args: Any, **_options: Any) -> None:
        self._rendered = True
        if not getattr(self, "_closed", False):
            self.update()

    def resizeEvent(self, event: QResizeEvent) -> None:
        if getattr(self, "_closed", False):  # its graphics context is gone by then
            return
        self._resizing = True
        super().resizeEvent(event)
        self._resizing = False
        self.draw_moving()

    def hideEvent(self, event: QHideEvent) -> None:
        """Give the pictures back that are drawn into, tens of megabytes at full size; the next paint makes new ones."""
        super().hideEvent(event)
        if not getattr(self, "_closed", False) and self.isValid():
            self.makeCurrent()
            state = self.render_window.GetState()
            for pictures in (self.render_window.GetRenderFramebuffer(), self.render_window.GetDisplayFramebuffer()):
                pictures.Resize(1, 1)
                state.PushFramebufferBindings()
                pictures.Bind()
                state.vtkglClear(_COLOURS_AND_DEPTH)  # until something is drawn, the driver keeps what was there
                state.PopFramebufferBindings()
            self.doneCurrent()

    def paintGL(self) -> None:
        iren: Any = self.__dict__.get("_Iren")
        if getattr(self, "_closed", False) or not hasattr(iren, "EnableRenderOn"):
            return
        if self._resizing or not self.isVisible():  # Qt paints then too, and once more when all have their places
            return
        self._waiting.stop()
        with self.rendering_at_once():
            super().paintGL()

    @contextmanager
    def rendering_at_once(self) -> Iterator[None]:
        """Within, VTK's requests to render are carried out and not left to the next paint."""
        self._Iren.EnableRenderOn()
        try:
            yield
        finally:
            self._Iren.EnableRenderOff()

    # What QtInteractor would do with these events belongs to the window: propagate.

    def keyPressEvent(self, event: QKeyEvent) -> None:
        event.ignore()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        event.ignore()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        event.ignore()

    def dropEvent(self, event: QDropEvent) -> None:
        event.ignore()

    def enterEvent(self, event: QEnterEvent) -> None:
        event.ignore()

    def leaveEvent(self, event: QEvent) -> None:
        event.ignore()
