"""The people kept for testing once more: with triangles of their own, and as clouds of points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._assets import asset
from .._check import FloatArray, IntArray
from ..geometry import TriangleMesh, subsample
from ..geometry.sampling import Subsample
from .collection import Collection, Landmarks
from .contents import Shape
from .shipped import humans

FILE = "humans_remeshed_20.npz"
CLOUD_POINTS = 4000


@dataclass(frozen=True, eq=False)
class RemeshedPerson:
    """A test person meshed anew. original : index among `humans()`.

    corners, weights : (n, 3) each; vertex i lies at Σ_j weights[i, j] · original.vertices[corners[i, j]].
    """

    mesh: TriangleMesh
    original: int
    corners: IntArray
    weights: FloatArray

    @property
    def places(self) -> IntArray:
        """(n,) the vertex of the original nearest to each vertex."""
        rows = np.arange(len(self.corners))
        return np.asarray(self.corners[rows, self.weights.argmax(axis=1)])


@cache
def remeshed() -> Collection:
    """The test people, persons 9 and 10 in ten poses each, every one with about 4,100 vertices and faces of its own.

    Places are vertices of `humans()`; a vertex lies at the nearest of them.
    """
    return _variant(
        "remeshed",
        "remeshed",
        lambda position: remeshed_person(position).mesh,
        lambda position: _landmarks(remeshed_person(position).places),
    )


@cache
def clouds() -> Collection:
    """The test people, persons 9 and 10 in ten poses each, as 4,000 of their vertices with normals and no faces."""

    def sampled(position: int) -> Subsample:
        index = remeshed_people()[position]
        # Each cloud starts at another vertex, so that no two share their points.
        return subsample(humans()[index], CLOUD_POINTS, start=(97 * index) % humans()[index].vertex_count)

    return _variant(
        "clouds",
        "points",
        lambda position: sampled(position).cloud,
        lambda position: _landmarks(sampled(position).indices),
    )


@cache
def remeshed_people() -> tuple[int, ...]:
    """Indices among `humans()` of the people that ship remeshed, in order."""
    return tuple(_stored()["shapes"].tolist())


def remeshed_person(position: int) -> RemeshedPerson:
    """The remeshed person at that position in `remeshed_people()`."""
    file = _stored()
    ends = np.cumsum(file["counts"], axis=0)
    (first, first_face), (count, face_count) = ends[position] - file["counts"][position], file["counts"][position]
    rows = slice(first, first + count)
    original = remeshed_people()[position]
    mesh = TriangleMesh(
        file["lo"] + float(file["scale"]) * file["vertices_q"][rows],
        file["faces"][first_face : first_face + face_count].astype(np.int64),
        name=f"{humans().names[original]}, remeshed",
    )
    two = file["place_weights"][rows].astype(np.float64) / 65535
    last = np.maximum(1.0 - two.sum(axis=1, keepdims=True), 0.0)
    person = humans()[original]
    assert isinstance(person, TriangleMesh)
    corners = person.faces[file["place_face"][rows].astype(np.int64)]
    return RemeshedPerson(mesh, original, corners, np.concatenate([two, last], axis=1))


@cache
def _stored() -> dict[str, NDArray[Any]]:
    with np.load(asset("shapes", FILE), allow_pickle=False) as file:
        return {name: file[name] for name in file.files}


def _landmarks(places: IntArray) -> Landmarks:
    return Landmarks(np.arange(len(places), dtype=np.int64), np.asarray(places, dtype=np.int64))


def _variant(
    title: str, word: str, make_shape: Callable[[int], Shape], landmarks: Callable[[int], Landmarks]
) -> Collection:
    people, kept = humans(), remeshed_people()
    assert people.subjects is not None
    assert people.poses is not None
    return Collection(
        title=title,
        names=tuple(f"{people.names[index]}, {word}" for index in kept),
        subjects=tuple(people.subjects[index] for index in kept),
        poses=tuple(people.poses[index] for index in kept),
        training=(),
        unit=people.unit,
        up=people.up,
        front=people.front,
        licence=people.licence,
        template=people.title,
        make_shape=make_shape,
        landmarks=landmarks,
    )
