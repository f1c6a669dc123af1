"""The shapes that ship with the project: people and dogs with exact correspondence and exact mirror maps.

All are closed, outward-oriented meshes in metres, z up. People look along -y, dogs along +x. `assets/shapes/README.md`
says how they were made and under which licences.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from .._assets import asset
from .._check import FloatArray, IntArray, read_only
from ..geometry import TriangleMesh
from .collection import Collection


@cache
def humans() -> Collection:
    """Ten people in ten poses each, 100 meshes of 6,890 vertices; the pose runs fastest.

    Split by subject, as is custom with FAUST: persons 1 to 8 train, 9 and 10 test.
    """
    stored = _Stored.read("humans_100x6890.npz")
    poses = tuple(_readable(pose) for pose in stored.poses)
    subjects = tuple(f"person {number + 1}" for number in stored.subjects)
    return Collection(
        title="humans",
        names=tuple(f"{subject}, {pose}" for subject, pose in zip(subjects, poses, strict=True)),
        symmetry=stored.symmetry,
        subjects=subjects,
        poses=poses,
        training=tuple(np.flatnonzero(stored.subjects < 8).tolist()),
        unit="m",
        up="+z",
        front="-y",
        licence="CC0 (MakeHuman)",
        make_shape=lambda index: stored.mesh(index, f"{subjects[index]}, {poses[index]}"),
    )


@cache
def poses() -> Collection:
    """One person in 71 poses, meshes of 12,166 vertices: thirty poses, twenty mirrored, twenty-one blended from two.

    Split as is custom with SCAPE: shapes 10 to 70 train, 0 to 9 test.
    """
    stored = _Stored.read("poses_71x12166.npz")
    poses = tuple(_readable(pose) for pose in stored.poses)
    names = tuple(f"pose {number}, {pose}" for number, pose in enumerate(poses, start=1))
    return Collection(
        title="poses",
        names=names,
        symmetry=stored.symmetry,
        subjects=("person 1",) * len(names),
        poses=poses,
        training=tuple(range(10, 71)),
        unit="m",
        up="+z",
        front="-y",
        licence="CC0 (MakeHuman)",
        make_shape=lambda index: stored.mesh(index, names[index]),
    )


@cache
def dogs() -> Collection:
    """One dog in forty poses, meshes of 6,890 vertices: standing, then 39 drawn at random within its joints' limits.

    Split: shapes 0 to 29 train, 30 to 39 test.
    """
    stored = _Stored.read("dogs_40x6890.npz")
    names = tuple(f"dog {number}" for number in range(1, len(stored.poses) + 1))
    return Collection(
        title="dogs",
        names=names,
        symmetry=stored.symmetry,
        subjects=("dog",) * len(names),
        poses=stored.poses,
        training=tuple(range(30)),
        unit="m",
        up="+z",
        front="+x",
        licence="Apache-2.0 (dm_control)",
        make_shape=lambda index: stored.mesh(index, names[index]),
    )


@dataclass(frozen=True, eq=False)
class _Geometry:
    """Vertices as 16-bit steps: v = lo + scale · q, exact to half a step (0.02 mm)."""

    steps: NDArray[np.uint16]  # (shapes, n, 3)
    lo: FloatArray
    scale: float
    faces: IntArray

    @classmethod
    def read(cls, file_name: str) -> _Geometry:
        with np.load(asset("shapes", file_name), allow_pickle=False) as file:
            return cls(
                steps=file["vertices_q"],
                lo=file["lo"].astype(np.float64),
                scale=float(file["scale"]),
                faces=file["faces"].astype(np.int64),
            )


@dataclass(frozen=True, eq=False)
class _Stored:
    """What names the shapes of a file; their geometry is read when the first of them is asked for."""

    file_name: str
    symmetry: IntArray
    subjects: IntArray
    poses: tuple[str, ...]

    @classmethod
    def read(cls, file_name: str) -> _Stored:
        with np.load(asset("shapes", file_name), allow_pickle=False) as file:
            return cls(
                file_name=file_name,
                symmetry=read_only(file["sym"].astype(np.int64)),
                subjects=file["subject"].astype(np.int64),
                poses=tuple(str(pose) for pose in file["pose"]),
            )

    @cached_property
    def geometry(self) -> _Geometry:
        return _Geometry.read(self.file_name)

    def mesh(self, index: int, name: str) -> TriangleMesh:
        kept = self.geometry
        return TriangleMesh(kept.lo + kept.scale * kept.steps[index], kept.faces, name=name)


def _readable(pose: str) -> str:
    """ "jump+arabesque:0.58" → "jump to arabesque 58 %", "walk_mirror" → "walk mirrored"."""
    ends, _, share = pose.partition(":")
    words = ends.replace("_mirror", " mirrored").replace("+", " to ").replace("_", " ")
    return f"{words} {round(100 * float(share))} %" if share else words
