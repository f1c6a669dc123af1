"""Shipped shapes by name: "humans/3"."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from ..errors import ShapeFileError
from .collection import Collection
from .shipped import dogs, humans, poses
from .shipped_variants import clouds, remeshed

SHIPPED: dict[str, Callable[[], Collection]] = {
    "humans": humans,
    "poses": poses,
    "dogs": dogs,
    "remeshed": remeshed,
    "clouds": clouds,
}
"""The shipped collections by name."""


@dataclass(frozen=True, eq=False)
class ShippedPlace:
    """A place in a shipped collection. name : how to write it, e.g. "humans/3"."""

    collection: Collection
    index: int

    @property
    def name(self) -> str:
        return f"{self.collection.title}/{self.index}"


def shipped_place(name: str) -> ShippedPlace | None:
    """The place that "humans/3" (or "humans:3") names; None if `name` is not of that form.

    Raises ShapeFileError if the collection has no such shape.
    """
    written = re.fullmatch(rf"({'|'.join(SHIPPED)})[/:](\d+)", name)
    if written is None:
        return None
    place = ShippedPlace(SHIPPED[written[1]](), int(written[2]))
    last = len(place.collection) - 1
    if place.index > last:
        title = place.collection.title
        raise ShapeFileError(f"{title} holds shapes {title}/0 to {title}/{last}, but {name} was asked for.")
    return place
