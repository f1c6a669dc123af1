"""How the open shapes stand beside each other, and how each of them is drawn."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal

Layout = Literal["grid", "strip", "single"]
LAYOUTS: tuple[Layout, ...] = ("grid", "strip", "single")
POINT_SIZES = (0.25, 4.0)


@dataclass(frozen=True)
class Arrangement:
    """layout : "grid", "strip" (one row) or "single" (the active shape alone). linked : one camera for all views.
    common_range : one colour range for all shapes, instead of each its own.
    """

    layout: Layout = "grid"
    linked: bool = True
    common_range: bool = False

    def with_changes(self, **changes: Any) -> Arrangement:
        """The same with `changes`; an unknown layout is ignored."""
        made = replace(self, **changes)
        return made if made.layout in LAYOUTS else replace(made, layout=self.layout)


@dataclass(frozen=True)
class ShapeLook:
    """key : of the shape. visible : whether it has a view. wireframe : draw the triangles' edges.
    point_size : factor for the discs of a point cloud, 0.25 to 4.
    """

    key: str
    visible: bool = True
    wireframe: bool = False
    point_size: float = 1.0

    def with_changes(self, **changes: Any) -> ShapeLook:
        """The same with `changes`, brought into range."""
        made = replace(self, **changes)
        return replace(made, point_size=min(max(float(made.point_size), POINT_SIZES[0]), POINT_SIZES[1]))


UPRIGHT = 0.6
"""Width / height of what usually stands in a view."""


def columns(count: int, layout: Layout, aspect: float, *, step: int = 1) -> int:
    """Columns of a grid of `count` views in a room of this width / height: upright shapes as large as they can be.

    step : columns are a multiple of it, so that a split view never breaks the row of one field.
    """
    if layout != "grid" or count < 1:
        return max(count, 1)
    sizes = {wide: min(aspect / (UPRIGHT * wide), 1.0 / -(-count // wide)) for wide in range(step, count + 1, step)}
    return max(sizes, key=lambda wide: (sizes[wide], -wide))
