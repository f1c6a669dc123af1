"""An open shape: the geometry as it is computed with, and what is known about where it came from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from add_core.geometry import PointCloud, TriangleMesh

from .coarse import Coarse, coarse_of
from .kept_mirror import packed
from .outline import outline_of

Shape = TriangleMesh | PointCloud
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False, kw_only=True)
class OpenShape:
    """One shape of the session. Two are equal only if they are the same object.

    key : unique in the session.
    reference : what reopens it, a path or a shipped name such as "humans/0".
    shape : scaled to unit geodesic diameter, so that α and t compare between shapes.
    diameter : geodesic diameter in the file's own unit: own length = diameter × shown length.
    unit : the file's own length unit, "" if unknown.
    symmetry : (n,) the mirror of every vertex, or None. symmetry_confidence : 0 to 1 where the shape itself was
        asked for it, None where it is known.
    template : the shipped collection whose vertices are places that shapes share, "" if nothing of that kind is known.
    places : (n,) the place of every vertex; None where vertex i is place i.
    fields : per-vertex quantities that came with the file, each (n,) or (n, k).
    up, front : axes such as "+z" and "-y"; "" if unknown.
    """

    key: str
    reference: str
    name: str
    shape: Shape
    diameter: float
    unit: str = ""
    symmetry: IntArray | None = None
    symmetry_confidence: float | None = None
    template: str = ""
    places: IntArray | None = None
    fields: Mapping[str, FloatArray] = field(default_factory=dict)
    up: str = ""
    front: str = ""

    @property
    def vertex_count(self) -> int:
        return self.shape.vertex_count

    @cached_property
    def found_mirror(self) -> str:
        """The mirror map that was found for this shape, as `kept_mirror` packs it; "" if none was."""
        return "" if self.symmetry is None or self.symmetry_confidence is None else packed(self.symmetry)

    @cached_property
    def coarse(self) -> Coarse | None:
        """What is drawn in its place while the camera moves; None if it is small."""
        return coarse_of(self.shape)

    @cached_property
    def outline(self) -> FloatArray:
        """(m, 3) by which cameras are placed."""
        return outline_of(self.shape.vertices)

    def make_ready(self) -> OpenShape:
        """Find what drawing needs, before the window's thread asks for it; returns itself."""
        for mesh in (self.shape, None if self.coarse is None else self.coarse.shape):
            if isinstance(mesh, TriangleMesh):
                mesh.vertex_normals  # noqa: B018 - found once, kept there
        self.outline  # noqa: B018
        return self

    def travel_light(self) -> None:
        """Forget what follows from the rest, three quarters of it, while only undo keeps this."""
        for part in (self, self.shape):
            for name in vars(part).keys() - {known.name for known in fields(part)}:
                vars(part).pop(name, None)

    def mirror(self, vertex: int) -> int | None:
        """The mirror image of `vertex`; None if unknown or `vertex` lies on the mirror plane."""
        if self.symmetry is None or int(self.symmetry[vertex]) == vertex:
            return None
        return int(self.symmetry[vertex])

    @property
    def scale_sentence(self) -> str:
        """What 1 means where lengths are shown."""
        unit = self.unit or "of the file's units"
        return f"Lengths in geodesic diameters: 1 ⌀ = {self.diameter:.3g} {unit}"
