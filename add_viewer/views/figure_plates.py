"""What goes into a figure: the picture of each view on nothing, cut to the shapes, and the words that belong to it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QImage

from add_core.drawing.colour_maps import Tones

from ..models.fields import ShapeField
from .shape_view import ShapeView

Pixels = NDArray[np.uint8]
_AIR = 0.03
"""Room around the shapes, as a share of the cut picture."""


@dataclass(frozen=True, eq=False)
class Bar:
    """A colour bar: quantity, notes, ticks at positions in [0, 1], and its colours."""

    title: str
    notes: tuple[str, ...]
    ticks: tuple[tuple[float, str], ...]
    tones: Tones


@dataclass(frozen=True, eq=False)
class Plate:
    """One view. pixels : (h, w, 4), not premultiplied, transparent beside the shape. row, column : its place."""

    pixels: Pixels
    row: int
    column: int
    name: str
    caption: str
    bar: Bar | None


def plates_of(views: Sequence[ShapeView], scale: float) -> list[Plate]:
    """The views as they stand, `scale` times as fine as on the screen, all cut alike: sizes stay comparable."""
    return cut_alike([step() for step in plate_steps(views, scale)])


def plate_steps(views: Sequence[ShapeView], scale: float) -> list[Callable[[], Plate]]:
    """What draws each view's plate, uncut: a fine one takes a second, so that the window works between two."""
    rows = sorted({view.y() for view in views})
    columns = sorted({view.x() for view in views})
    return [partial(_plate, view, rows.index(view.y()), columns.index(view.x()), scale) for view in views]


def _plate(view: ShapeView, row: int, column: int, scale: float) -> Plate:
    pixels = pixels_of(view.canvas.picture(scale, transparent=True))
    shape, field = view.shape, view.field
    name = "" if shape is None else shape.name
    caption = "" if field is None else field.caption
    return Plate(pixels, row, column, name, caption, None if field is None else _bar(field))


def _bar(field: ShapeField) -> Bar | None:
    if field.values is None:
        return None
    notes = tuple(note for note in field.notes if note)
    return Bar(field.title, notes, tuple(field.scale.ticks()), field.tones)


def cut_alike(plates: list[Plate]) -> list[Plate]:
    """All views cut to the smallest window that holds every shape, seen from the middle of each view."""
    height = max(plate.pixels.shape[0] for plate in plates)
    width = max(plate.pixels.shape[1] for plate in plates)
    seen = np.zeros((height, width), dtype=bool)
    centred = [_centred(plate.pixels, height, width) for plate in plates]
    for pixels in centred:
        seen |= pixels[..., 3] > 0
    if not seen.any():
        return plates
    top, bottom = _extent(np.flatnonzero(seen.any(axis=1)), height)
    left, right = _extent(np.flatnonzero(seen.any(axis=0)), width)
    window = slice(top, bottom), slice(left, right)
    return [replace(plate, pixels=pixels[window]) for plate, pixels in zip(plates, centred, strict=True)]


def _centred(pixels: Pixels, height: int, width: int) -> Pixels:
    h, w = pixels.shape[:2]
    if (h, w) == (height, width):
        return pixels
    room = np.zeros((height, width, 4), dtype=np.uint8)
    top, left = (height - h) // 2, (width - w) // 2
    room[top : top + h, left : left + w] = pixels
    return room


def _extent(at: NDArray[np.int64], length: int) -> tuple[int, int]:
    air = round(_AIR * len(at))
    return max(0, int(at[0]) - air), min(length, int(at[-1]) + 1 + air)


def pixels_of(image: QImage) -> Pixels:
    """(h, w, 4) RGBA of a picture."""
    image = image.convertToFormat(QImage.Format.Format_RGBA8888)
    flat = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat[:, : 4 * image.width()].reshape(image.height(), image.width(), 4).copy()
