"""Turntables and sweeps as a GIF: one picture after the other between the window's other work."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import copy
from dataclasses import dataclass
from functools import partial
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from PIL import Image
from PySide6.QtCore import QObject, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QImage, QPainter

from ..models.diffusion import REACH_MAX, REACH_MIN, Diffusion
from .figure_plates import pixels_of
from .shape_view import ShapeView
from .theme import theme_of

if TYPE_CHECKING:
    from .main_window import MainWindow

Kind = Literal["turntable", "theta", "time"]
_PATIENCE = 15
"""Milliseconds between two looks whether the kernel of a sweep has come."""
_COLOURS = 255


@dataclass(frozen=True)
class AnimationChoice:
    """kind : "turntable" once around; "theta" 0 to 180°; "time" local to global and back. width : pixels.
    rate : pictures a second.
    """

    kind: Kind = "turntable"
    width: int = 640
    seconds: float = 4.0
    rate: int = 15

    @property
    def count(self) -> int:
        """Pictures of the whole animation."""
        return max(2, round(self.seconds * self.rate))


class Recorder(QObject):
    """Takes the pictures of one animation at a time and hands them over.

    progressed : how many of how many are taken. recorded : all of them, as Pillow's images, and the choice.
    stopped : there will be none.
    """

    progressed = Signal(int, int)
    recorded = Signal(list, object)
    stopped = Signal()

    def __init__(self, window: MainWindow, is_idle: Callable[[], bool]) -> None:
        super().__init__(window)
        self._window, self._is_idle = window, is_idle
        self._choice = AnimationChoice()
        self._frames: list[Image.Image] = []
        self._steps: Iterator[Callable[[], QImage | None]] = iter(())
        self._before: Diffusion | None = None
        self._timer = QTimer(self, singleShot=True, interval=_PATIENCE)
        self._timer.timeout.connect(self._go_on)
        self._step: Callable[[], QImage | None] | None = None
        self.is_running = False

    def start(self, choice: AnimationChoice) -> None:
        """Begin; the window goes on working."""
        self._choice, self._frames, self.is_running = choice, [], True
        self._before = self._window.session.state.diffusion if choice.kind != "turntable" else None
        self._steps = self._turns() if choice.kind == "turntable" else self._sweep()
        self._step = next(self._steps)
        self._timer.start()

    def cancel(self) -> None:
        """Stop, and leave everything as it was."""
        if self.is_running:
            self._end()
            self.stopped.emit()

    def _end(self) -> None:
        self.is_running = False
        self._timer.stop()
        if self._before is not None:
            self._window.session.preview(self._before)
            self._before = None

    # -- step by step -------------------------------------------------------------------------------------------------

    def _go_on(self) -> None:
        if not self._window.session.state.shown:
            self.cancel()
            return
        image = None if self._step is None else self._step()
        if image is not None:
            self._frames.append(self._prepared(image))
            self.progressed.emit(len(self._frames), self._pictures)
            self._step = next(self._steps, None)
        if self._step is None:
            self._finish()
        else:
            self._timer.start()

    def _finish(self) -> None:
        frames, choice = self._frames, self._choice
        if choice.kind == "time":  # and back again
            frames = [*frames, *frames[-2:0:-1]]
        self._end()
        self.recorded.emit(frames, choice)

    @property
    def _pictures(self) -> int:
        """Pictures to take: the way back is the way there."""
        return self._choice.count // 2 + 1 if self._choice.kind == "time" else self._choice.count

    def _turns(self) -> Iterator[Callable[[], QImage]]:
        places = {view: _turntable_place(view) for view in self._window.scene.views}
        for number in range(self._choice.count):
            yield partial(self._turned, places, 360.0 * number / self._choice.count)

    def _turned(self, places: dict[ShapeView, _Place], degrees: float) -> QImage:
        """The picture from there; the person's own view stays as it is."""
        views = self._window.scene.views
        own = {view: _place(view) for view in views}
        for view in views:
            place = places.get(view, own[view])
            view.canvas.stand(place.azimuth + degrees, *place.rest, fitted=False)
        image = self._window.scene.picture(self._scale, transparent=True)
        for view, place in own.items():
            view.canvas.stand(place.azimuth, *place.rest, fitted=place.fitted)
        return image

    def _sweep(self) -> Iterator[Callable[[], QImage | None]]:
        count = self._pictures
        values: dict[str, np.ndarray] = {
            "theta": pi * np.arange(count) / count,
            "time": np.geomspace(REACH_MIN, REACH_MAX, count),
        }
        assert self._before is not None
        for value in values[self._choice.kind]:
            name = "theta" if self._choice.kind == "theta" else "reach"
            self._window.session.preview(self._before.with_changes(**{name: float(value)}))
            yield self._settled

    def _settled(self) -> QImage | None:
        """The picture once the kernels are there."""
        return self._window.scene.picture(self._scale, transparent=True) if self._is_idle() else None

    @property
    def _scale(self) -> float:
        return self._choice.width / max(self._window.scene.width(), 1)

    def _prepared(self, image: QImage) -> Image.Image:
        """On one even colour, which a GIF shows without grain, at the size asked for."""
        scene = self._window.scene.size()
        size = QSize(self._choice.width, max(1, round(self._choice.width * scene.height() / max(scene.width(), 1))))
        page = QImage(size, QImage.Format.Format_RGB32)
        page.fill(theme_of(self._window.display["theme"]).colour("canvas_top"))
        painter = QPainter(page)
        fitting = image.scaled(size, Qt.AspectRatioMode.IgnoreAspectRatio, Qt.TransformationMode.SmoothTransformation)
        painter.drawImage(0, 0, fitting)
        painter.end()
        return Image.fromarray(pixels_of(page)[..., :3])


@dataclass(frozen=True)
class _Place:
    """Where an eye is: angles in degrees, then what `stand` takes."""

    azimuth: float
    rest: tuple[Any, ...]
    fitted: bool


def _place(view: ShapeView) -> _Place:
    model = view.canvas.camera_model
    return _Place(model.azimuth, (model.elevation, tuple(model.focal), model.distance), view.canvas.is_fitted)


def _turntable_place(view: ShapeView) -> _Place:
    """Where to begin: a fitted view stands back so far that the shape fits in from every side."""
    own = _place(view)
    extent = view.canvas.extent
    if not own.fitted or extent is None:
        return own
    model = copy(view.canvas.camera_model)
    away = []
    for degrees in range(0, 360, 20):
        model.azimuth = own.azimuth + degrees
        model.fit(extent, view.width() / max(view.height(), 1))
        away.append(model.distance)
    middle = 0.5 * (extent.min(axis=0) + extent.max(axis=0))
    return _Place(own.azimuth, (model.elevation, tuple(middle), max(away)), fitted=False)


def write_gif(path: Path, frames: list[Image.Image], rate: int) -> None:
    """All pictures as an endless GIF; takes seconds, so not in the window's thread."""
    small = [frame.quantize(_COLOURS, dither=Image.Dither.NONE) for frame in frames]
    duration = max(20, 10 * round(100 / rate))  # GIF counts hundredths of a second
    small[0].save(path, format="GIF", save_all=True, append_images=small[1:], duration=duration, loop=0)
