"""Collections of shapes with known correspondence, whatever they are stored in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from .._check import IntArray, one_of, read_only
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh
from .contents import Shape


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Which vertices of one shape lie at which numbered places of a template that its collection shares.

    vertices, places : (k,) each. A vertex may lie at several places, and a place be without a vertex.
    """

    vertices: IntArray
    places: IntArray


@dataclass(frozen=True, eq=False, kw_only=True)
class Collection:
    """Shapes of one kind, in a fixed order, with the map between any two of them.

    `len(collection)`, `collection[i]` and iteration give the shapes; each is made when it is asked for.

    title : what to call the collection.
    names : one readable name a shape, e.g. "person 3, walk".
    symmetry : (n,) or None, the vertex that mirrors each vertex, its own inverse; the same for every shape.
    subjects : one name a shape, of the individual that it shows, or None.
    poses : one name a shape, or None.
    training : indices of the shapes that the literature trains on, the others being for testing; None without a custom.
    unit : length unit of the vertices, "" if unknown.
    up, front : the axes that point up and that the shapes look along, e.g. "+z" and "-y"; "" if unknown.
    licence : under which terms the shapes may be used, in a few words.
    template : title of the collection whose vertices are the places of the landmarks, "" for places of their own.
    make_shape : gives the shape of an index. landmarks : gives those of an index, None if the shapes share their faces.
    pairs : gives the map between the shapes of two indices where it is known as such.
    """

    title: str
    names: tuple[str, ...]
    symmetry: IntArray | None = None
    subjects: tuple[str, ...] | None = None
    poses: tuple[str, ...] | None = None
    training: tuple[int, ...] | None = None
    unit: str = ""
    up: str = ""
    front: str = ""
    licence: str = ""
    template: str = ""
    make_shape: Callable[[int], Shape] = field(repr=False)
    landmarks: Callable[[int], Landmarks] | None = field(default=None, repr=False)
    pairs: Callable[[int, int], IntArray | None] | None = field(default=None, repr=False)

    def __len__(self) -> int:
        return len(self.names)

    def __getitem__(self, index: int) -> Shape:
        return self.make_shape(self._checked(index))

    def __iter__(self) -> Iterator[Shape]:
        return (self.make_shape(index) for index in range(len(self)))

    def correspondence(self, i: int, j: int) -> IntArray:
        """(n_i,): the vertex of shape j at the same place as each vertex of shape i, -1 where j has none.

        Raises ParameterError if the shapes neither share their faces nor come with landmarks.
        """
        i, j = self._checked(i), self._checked(j)
        first, second = self.make_shape(i), self.make_shape(j)
        known = None if self.pairs is None or i == j else self.pairs(i, j)
        if known is not None:
            return known
        if self.landmarks is None:
            if not _same_connectivity(first, second):
                raise ParameterError(
                    f"{self.names[i]} and {self.names[j]} have different faces and no correspondence file (.vts, .map)."
                )
            return read_only(np.arange(first.vertex_count, dtype=np.int64))
        source, target = self.landmarks(i), self.landmarks(j)
        vertex_at = np.full(max(source.places.max(), target.places.max()) + 1, -1, dtype=np.int64)
        # The first of several answers counts, so it is written last.
        vertex_at[target.places[::-1]] = target.vertices[::-1]
        found = vertex_at[source.places]
        result = np.full(first.vertex_count, -1, dtype=np.int64)
        known = np.flatnonzero(found >= 0)[::-1]
        result[source.vertices[known]] = found[known]
        return read_only(result)

    def split(self, part: str) -> IntArray:
        """Indices of the shapes to "train" on or to "test" with, ascending and disjoint.

        Raises ParameterError if `part` is another word, or nobody has agreed on a split of this collection.
        """
        one_of("part", part, ("train", "test"))
        if self.training is None:
            raise ParameterError(f"{self.title} has no customary split into training and test shapes. Choose indices.")
        chosen = np.isin(np.arange(len(self)), self.training)
        return read_only(np.flatnonzero(chosen if part == "train" else ~chosen).astype(np.int64))

    def _checked(self, index: int) -> int:
        if not isinstance(index, int | np.integer):
            raise ParameterError(f"index must be the number of one shape, but it is {index!r}. Take several in a loop.")
        # IndexError, as lists raise it: Python's own protocols end on it.
        if not -len(self) <= index < len(self):
            raise IndexError(f"{self.title} has shapes 0 to {len(self) - 1}, but {index} was asked for.")
        return int(index) % len(self)


def _same_connectivity(first: Shape, second: Shape) -> bool:
    if isinstance(first, PointCloud) or isinstance(second, PointCloud):
        # Points have no faces to compare; equal numbers are all there is to go by.
        return (
            isinstance(first, PointCloud) == isinstance(second, PointCloud)
            and first.vertex_count == second.vertex_count
        )
    return isinstance(second, TriangleMesh) and np.array_equal(first.faces, second.faces)
