"""Opening shapes: from files and from the shipped collections."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from add_core.geometry import normalize
from add_core.io import ShippedPlace, load_shape_and_fields, shipped_place

from ..models.results import Results
from ..models.session import Session
from ..models.shapes import OpenShape, Shape
from .running import Run, explain

Read = Callable[[str], OpenShape]
"""Reads what a reference names, as `read_shape` does."""


class OpeningController:
    """Reads shapes off the window's thread; one that cannot be read leaves the session as it was."""

    def __init__(self, session: Session, results: Results, run: Run, read: Read | None = None) -> None:
        self._session, self._results, self._run = session, results, run
        self._read = read or read_shape
        self._waiting = 0
        self.opened: Callable[[OpenShape], None] = lambda shape: None
        self.failed: Callable[[str, str], None] = lambda reference, reason: None

    def open(self, reference: str | Path) -> None:
        """Open a path or a shipped name such as "humans/0"."""
        name = str(reference)
        self._waiting += 1
        self._results.set_busy(f"Opening {Path(name).name if '/' in name and Path(name).exists() else name} …")
        self._run(
            "open",
            lambda: self._read(name),
            done=self._done,
            failed=lambda error: self._failed(name, error),
            queue=True,
        )

    def _done(self, shape: OpenShape) -> None:
        self._finish()
        self._session.add_shape(shape)
        self.opened(shape)

    def _failed(self, reference: str, error: BaseException) -> None:
        self._finish()
        reason = explain(error)
        self._results.report(reason)
        self.failed(reference, reason)

    def _finish(self) -> None:
        self._waiting -= 1
        if self._waiting == 0:
            self._results.set_busy("")


def read_shape(reference: str) -> OpenShape:
    """Read a path or a shipped name and scale the shape to unit geodesic diameter.

    Raises ShapeFileError or GeometryError, worded for the person who asked.
    """
    place = None if Path(reference).exists() else shipped_place(reference)
    if place is not None:
        return _read_shipped(place).make_ready()
    path = Path(reference).expanduser()
    loaded = load_shape_and_fields(path)
    key = str(path.resolve())
    opened = _open_shape(loaded.shape, key=key, reference=key, name=loaded.shape.name or path.stem)
    return replace(opened, fields=loaded.fields).make_ready()


def _read_shipped(place: ShippedPlace) -> OpenShape:
    collection = place.collection
    opened = _open_shape(
        collection[place.index],
        key=place.name,
        reference=place.name,
        name=_capital(collection.names[place.index]),
    )
    return replace(
        opened,
        unit=collection.unit,
        symmetry=collection.symmetry,
        template=collection.template or collection.title,
        places=None if collection.landmarks is None else collection.landmarks(place.index).places,
        up=collection.up,
        front=collection.front,
    )


def _open_shape(shape: Shape, *, key: str, reference: str, name: str) -> OpenShape:
    scaled = normalize(shape)
    return OpenShape(key=key, reference=reference, name=name, shape=scaled, diameter=_ratio(shape, scaled))


def _ratio(shape: Shape, scaled: Shape) -> float:
    extents = (float(np.linalg.norm(np.ptp(each.vertices, axis=0))) for each in (shape, scaled))
    before, after = extents
    return before / after if after > 0 else 1.0


def _capital(name: str) -> str:
    return name[:1].upper() + name[1:]
