"""Shapes to learn from, their inputs computed once and kept in files."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from hashlib import blake2b
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .._check import FloatArray, IntArray, index_array, instance_of, one_of, read_only
from ..errors import GeometryError, ParameterError
from ..geometry import PointCloud, TriangleMesh
from ..io import Collection
from ..spectra.family import method_of
from .inputs import InputRecipe, Inputs, Moments

UNKNOWN = -1
"""Place of a vertex that has no counterpart on other shapes."""

Precision = Literal["float16", "float32"]
Report = Callable[[str, int, int], object]


@dataclass(frozen=True, eq=False)
class TrainingShape:
    """A shape whose vertices have names that other shapes share.

    places : (n,), the same number for the same point of every body, −1 for vertices without a counterpart.
        Connectivity may differ from shape to shape.
    """

    shape: TriangleMesh | PointCloud
    places: IntArray

    def __post_init__(self) -> None:
        instance_of("shape", self.shape, TriangleMesh, PointCloud)
        index_array("places", self.places, 2**31, count=self.shape.vertex_count, least=UNKNOWN)
        if not (np.asarray(self.places) >= 0).any():
            raise ParameterError(f"places must be known for some vertices of {self.shape.name!r}, but all are -1.")


@dataclass(frozen=True, eq=False)
class PreparedShape:
    """Inputs of one shape, mapped from their file.

    values : (n, C, M), not standardised. places : (n,). mass : (n,). positions : (n, 3), only to know who is near whom.
    moments : of the values over the surface. channels : (C,), the order in which the values' channels are to be read.
    """

    values: NDArray[np.floating]
    places: IntArray
    mass: FloatArray
    positions: NDArray[np.float32]
    moments: Moments
    name: str
    channels: IntArray | None = None

    def reflected(self, symmetry: IntArray, channels: IntArray) -> PreparedShape:
        """The mirror image of the shape, which costs no spectra: places swap sides, and channels their angles.

        symmetry : (P,), the place that mirrors each place. channels : (C,), see `InputRecipe.mirror_channels`.
        """
        known = (self.places >= 0) & (self.places < len(symmetry))
        places = np.where(known, np.asarray(symmetry)[np.where(known, self.places, 0)], UNKNOWN)
        return replace(self, places=read_only(places), channels=channels)

    def below(self, count: int) -> PreparedShape:
        """The same shape with the places from `count` on unknown."""
        return replace(self, places=read_only(np.where(self.places < count, self.places, UNKNOWN)))

    def inputs(self, vertices: IntArray, moments: Moments | None = None) -> Inputs:
        """Standardised inputs, shape (B, C, M), of vertices (B,), by `moments` or the shape's own."""
        order = np.argsort(vertices)  # the file is read forwards
        values = np.empty((len(vertices), *self.values.shape[1:]), dtype=np.float32)
        values[order] = self.values[vertices[order]]
        scaled = (moments or self.moments).standardise(values)
        return scaled if self.channels is None else np.ascontiguousarray(scaled[:, self.channels])

    @cached_property
    def vertex_at(self) -> IntArray:
        """(P,): the first vertex at each place, −1 where there is none; P − 1 is the highest place here."""
        known = np.flatnonzero(self.places >= 0)[::-1]
        table = np.full(int(self.places.max()) + 1, UNKNOWN)
        table[self.places[known]] = known
        return read_only(table)


def training_shapes(name: str, shapes: object) -> None:
    """Raise ParameterError unless `shapes` is a sequence of training shapes."""
    remedy = "Name the vertices of each by TrainingShape(shape, places), or give a collection."
    instance_of(name, shapes, Sequence, remedy=remedy)
    for number, item in enumerate(shapes if isinstance(shapes, Sequence) else ()):
        instance_of(f"{name}[{number}]", item, TrainingShape, remedy=remedy)


def places_of(collection: Collection, indices: Iterable[int], *, reference: int = 0) -> list[TrainingShape]:
    """Shapes of a collection, their vertices named after those of its shape `reference`.

    The places of each are (n,): its correspondence to the reference.
    """
    return [TrainingShape(collection[i], collection.correspondence(i, reference)) for i in indices]


def prepare(
    shapes: Sequence[TrainingShape],
    recipe: InputRecipe,
    folder: str | Path,
    *,
    precision: Precision = "float16",
    report: Report | None = None,
    workers: int | None = None,
) -> list[PreparedShape]:
    """Compute the inputs of every shape, or take them from `folder` where they have been computed before.

    Each shape is written as a whole or not at all, so that work which was stopped goes on where it was. One shape at a
    time is in memory; what is returned is mapped from the files. report : called as report(name, done, total).

    Raises ParameterError if the shapes cannot be trained on together, GeometryError if one has no usable surface.
    """
    one_of("precision", precision, ("float16", "float32"))
    if not shapes:
        raise ParameterError("shapes must hold at least one shape to learn from, but it is empty.")
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    prepared = []
    for number, item in enumerate(shapes):
        if report is not None:
            report(item.shape.name, number, len(shapes))
        stem = place / _key(item, recipe, precision)
        if not stem.with_suffix(".npz").exists():
            _write(stem, item, recipe, precision, workers)
        prepared.append(open_prepared(stem))
    if report is not None:
        report("", len(shapes), len(shapes))
    return prepared


def open_prepared(stem: Path) -> PreparedShape:
    """Map what `prepare` wrote: `stem`.npy, values of shape (n, C, M), and `stem`.npz, all else."""
    with np.load(stem.with_suffix(".npz"), allow_pickle=False) as file:
        about = {name: file[name] for name in file.files}
    return PreparedShape(
        np.load(stem.with_suffix(".npy"), mmap_mode="r", allow_pickle=False),
        read_only(about["places"]),
        read_only(about["mass"]),
        read_only(about["positions"]),
        Moments(read_only(about["mean"]), read_only(about["deviation"])),
        str(about["name"]),
    )


def write_prepared(
    stem: Path, values: NDArray[np.floating], *, places: IntArray, mass: FloatArray, positions: FloatArray, name: str
) -> None:
    """Write inputs (n, C, M) with places (n,), mass (n,) and positions (n, 3), the sidecar last."""
    moments = Moments.of(values, mass)
    _replace(stem.with_suffix(".npy"), lambda file: np.save(file, values))
    about: dict[str, Any] = {
        "places": places.astype(np.int64),
        "mass": mass,
        "positions": positions.astype(np.float32),
        "mean": moments.mean,
        "deviation": moments.deviation,
        "name": np.array(name),
    }
    _replace(stem.with_suffix(".npz"), lambda file: np.savez(file, **about))


def _write(stem: Path, item: TrainingShape, recipe: InputRecipe, precision: Precision, workers: int | None) -> None:
    family = recipe.spectra(item.shape, workers=workers, cache=False)
    values = recipe.inputs(family)
    if not np.isfinite(values).all():
        raise GeometryError(f"the inputs of {item.shape.name!r} are not finite. Inspect the shape: add-core info.")
    write_prepared(
        stem,
        values.astype(precision),
        places=np.asarray(item.places),
        mass=np.asarray(family.mass),
        positions=item.shape.vertices,
        name=item.shape.name,
    )


def _replace(target: Path, write: Callable[[Any], object]) -> None:
    unfinished = target.with_name(f".{target.name}.{os.getpid()}.part")
    with unfinished.open("wb") as file:
        write(file)
        file.flush()
        os.fsync(file.fileno())
    unfinished.replace(target)


def _key(item: TrainingShape, recipe: InputRecipe, precision: Precision) -> str:
    """A hash of all that the inputs depend on."""
    shape = item.shape
    method = method_of(shape)
    digest = blake2b(json.dumps([asdict(recipe), precision, method]).encode(), digest_size=12)
    second = shape.faces if isinstance(shape, TriangleMesh) else shape.normals
    for array in (shape.vertices, second, np.asarray(item.places)):
        digest.update(b"none" if array is None else np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()
