"""Folders of shapes as collections. Nothing is downloaded."""

from __future__ import annotations

import fnmatch
import re
from functools import lru_cache
from pathlib import Path

from .._check import IntArray, count_in, instance_of
from ..errors import ShapeFileError
from ..geometry import TriangleMesh, mirror_map
from .collection import Collection, Landmarks
from .contents import Shape
from .files import StrPath, file_path, load_shape
from .formats import extensions
from .landmark_files import find_landmarks, find_pairs, find_symmetry
from .layouts import Layout, Member, layout_of, whereabouts


def open_collection(path: StrPath, *, only: str = "*", neutral: int | None = None) -> Collection:
    """The shapes in a folder, in the order of their numbers, as a Collection.

    Recognises FAUST's registrations (tr_reg_000.ply, …; also their folder training/registrations from further up),
    SCAPE (mesh000.ply, …) and TOSCA (cat0.off, .mat or .vert, …) by their file names, with the customary splits; any
    other folder is taken as it is. Shapes correspond vertex by vertex if they share their faces; otherwise through
    files name.vts or name.map beside them or in a folder `corres`, or one_two.map in a folder `groundtruth` as with
    SHREC'19 (see `landmark_files`). A mirror map is read from
    symmetry.txt. Shapes are read when they are asked for, and the last few are kept.

    only : a pattern that file names without extension must fit, e.g. "cat*". Of several formats of a shape one counts.
    neutral : the index of a shape that stands symmetrically; without symmetry.txt the mirror map is found from it.

    Raises ShapeFileError if there is no such folder or no shape in it, saying where the known data sets are to be had.
    """
    instance_of("only", only, str)
    folder = _folder_of_shapes(file_path(path))
    files = tuple(file for file in _shape_files(folder) if fnmatch.fnmatchcase(file.stem, only))
    if not files:
        raise ShapeFileError(f"{path}: no shape in it is named {only}.")
    layout = layout_of([file.stem for file in files])
    members = [_member(layout, file.stem) for file in files]
    numbered = find_landmarks(files)
    paired = None if numbered else find_pairs(files)
    if neutral is not None:
        count_in("neutral", neutral, 0, len(files) - 1)

    @lru_cache(maxsize=8)
    def make_shape(index: int) -> Shape:
        return load_shape(files[index])

    def landmarks(index: int) -> Landmarks:
        assert numbered is not None
        return numbered.of(index, make_shape(index).vertex_count)

    def pairs(i: int, j: int) -> IntArray | None:
        assert paired is not None
        return paired.of(i, j, (make_shape(i).vertex_count, make_shape(j).vertex_count))

    return Collection(
        title=layout.title if layout else folder.name,
        names=tuple(member.name for member in members),
        symmetry=None if numbered or paired else _symmetry(folder, None if neutral is None else make_shape(neutral)),
        subjects=_all_or_none([member.subject for member in members]),
        poses=_all_or_none([member.pose for member in members]),
        training=_training(members),
        unit=layout.unit if layout else "",
        up=layout.up if layout else "",
        front=layout.front if layout else "",
        licence=layout.licence if layout else "",
        make_shape=make_shape,
        landmarks=None if numbered is None else landmarks,
        pairs=None if paired is None else pairs,
    )


def _symmetry(folder: Path, neutral: Shape | None) -> IntArray | None:
    stored = find_symmetry(folder)
    if stored is None and isinstance(neutral, TriangleMesh):
        return mirror_map(neutral)
    return stored


def _folder_of_shapes(path: Path) -> Path:
    """`path` itself, or the one folder below it that holds shapes."""
    if not path.is_dir():
        what = "is a file, not a folder." if path.exists() else "there is no such folder."
        raise ShapeFileError(f"{path}: {what} Nothing is downloaded. {whereabouts(str(path))}")
    if _shape_files(path):
        return path
    below = [folder for folder in sorted(path.glob("**/")) if folder != path and _shape_files(folder)]
    registrations = [folder for folder in below if layout_of([file.stem for file in _shape_files(folder)])]
    found = registrations if len(registrations) == 1 else below
    if len(found) > 1:
        names = ", ".join(str(folder.relative_to(path)) for folder in found[:5])
        raise ShapeFileError(f"{path}: several folders in it hold shapes ({names}). Open one of them.")
    if not found:
        raise ShapeFileError(f"{path}: holds no shapes. Nothing is downloaded. {whereabouts(str(path))}")
    return found[0]


def _shape_files(folder: Path) -> tuple[Path, ...]:
    """One file a shape, numbers in names counting as numbers: cat2 before cat10."""
    rank = {ext: place for place, ext in enumerate(extensions())}
    chosen: dict[str, Path] = {}
    for file in sorted(folder.iterdir()):
        suffix = file.suffix.lower()
        if suffix in rank and not file.name.startswith(".") and file.is_file():
            other = chosen.get(file.stem)
            if other is None or rank[suffix] < rank[other.suffix.lower()]:
                chosen[file.stem] = file
    return tuple(chosen[stem] for stem in sorted(chosen, key=_natural))


def _natural(stem: str) -> list[tuple[int, int, str]]:
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in re.split(r"([0-9]+)", stem) if part]


def _member(layout: Layout | None, stem: str) -> Member:
    match = layout.stem.fullmatch(stem) if layout else None
    return layout.member(match) if layout and match else Member(stem)


def _training(members: list[Member]) -> tuple[int, ...] | None:
    if any(member.trains is None for member in members):
        return None
    return tuple(index for index, member in enumerate(members) if member.trains)


def _all_or_none(words: list[str | None]) -> tuple[str, ...] | None:
    known = tuple(word for word in words if word is not None)
    return known if len(known) == len(words) else None
