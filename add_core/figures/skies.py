"""Sky light, computed once for each shape however often it is drawn."""

from __future__ import annotations

from .._check import FloatArray
from ..drawing.skylight import sky_share
from ..geometry import PointCloud, TriangleMesh


class Skies:
    """Remembers `sky_share` of the shapes it was asked about."""

    def __init__(self, directions: int) -> None:
        self._directions = directions
        self._known: dict[int, tuple[TriangleMesh | PointCloud, FloatArray]] = {}

    def over(self, shape: TriangleMesh | PointCloud) -> FloatArray:
        """(n,): how much of the sky each vertex sees."""
        # The shape is kept too: its number could go to another one.
        if id(shape) not in self._known:
            self._known[id(shape)] = shape, sky_share(shape, directions=self._directions)
        return self._known[id(shape)][1]
