"""Shipped shapes by name: "humans/3"."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from .._check import IntArray, read_only
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


def known_matches(first: ShippedPlace, second: ShippedPlace) -> IntArray | None:
    """(n2,): the vertex of the first shape at the place of each vertex of the second, None for unlike shapes.

    Between people of one connectivity that is the same number; where one of them is remeshed or a cloud, the vertex
    whose place on the common template is nearest, to within a triangle.
    """
    template = first.collection.template or first.collection.title
    if template != (second.collection.template or second.collection.title):
        return None
    one, two = _places(first), _places(second)
    if one is None:  # all places of the template, in order
        return read_only(np.arange(second.collection[second.index].vertex_count) if two is None else two.copy())
    points = SHIPPED[template]()[0].vertices
    wanted = points if two is None else points[two]
    return read_only(np.asarray(KDTree(points[one]).query(wanted)[1], dtype=np.int64))


def _places(place: ShippedPlace) -> IntArray | None:
    """(n,) the template's vertex at each vertex; None where they are the template's own."""
    landmarks = place.collection.landmarks
    if landmarks is None:
        return None
    known = landmarks(place.index)
    places = np.zeros(place.collection[place.index].vertex_count, dtype=np.int64)
    places[known.vertices] = known.places
    return places
