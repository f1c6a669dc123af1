"""Correspondence and symmetry maps from text files.

name.vts : line k holds the vertex of shape `name` at place k of a template, as with the remeshed FAUST and SCAPE.
name.map : line v holds the place of the template at which vertex v of shape `name` lies.
one_two.map : line v holds the vertex of shape `two` for vertex v of shape `one`, as with SHREC'19.
symmetry.txt (or .vts, .map; also sym.…) : line v holds the mirror image of vertex v, if all shapes share their faces.
All count from 1, unless a 0 occurs in any of a collection's files.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from .._check import IntArray, read_only
from ..errors import AddError, ShapeFileError
from .collection import Landmarks
from .contents import indices
from .text import float_rows, lines_of

_FOLDERS = (".", "corres", "../corres", "../corr", "../vts", "../maps")
_PAIRS = (*_FOLDERS, "groundtruth", "../groundtruth")
_KINDS = (".vts", ".map")
_SYMMETRY = ("symmetry", "sym")


@dataclass(frozen=True, eq=False)
class LandmarkFiles:
    """The correspondence files of a collection, one a shape, all of one kind."""

    paths: tuple[Path, ...]

    def of(self, index: int, vertex_count: int) -> Landmarks:
        """Those of one shape. Raises ShapeFileError if a number is not that of one of its vertices."""
        numbers, path = self._numbers[index], self.paths[index]
        if path.suffix == ".map":
            if len(numbers) != vertex_count:
                raise ShapeFileError(f"{path}: holds {len(numbers)} lines, but the shape has {vertex_count} vertices.")
            return Landmarks(read_only(np.arange(vertex_count, dtype=np.int64)), numbers)
        if numbers.max() >= vertex_count:
            raise ShapeFileError(f"{path}: names vertex {numbers.max() + 1}, but the shape has {vertex_count}.")
        return Landmarks(numbers, read_only(np.arange(len(numbers), dtype=np.int64)))

    @cached_property
    def _numbers(self) -> tuple[IntArray, ...]:
        """0-based. All files are read before any is understood, because one alone may lack the telling 0."""
        numbers = [_column(path) for path in self.paths]
        base = min(int(column.min()) for column in numbers) > 0
        return tuple(read_only(column - base) for column in numbers)


@dataclass(frozen=True, eq=False)
class PairFiles:
    """Correspondence files of pairs of shapes, each named after both: from the first to the second."""

    shapes: tuple[Path, ...]
    paths: dict[tuple[int, int], Path]

    def of(self, i: int, j: int, vertex_counts: tuple[int, int]) -> IntArray | None:
        """(n_i,): the vertex of shape j for each of shape i, −1 where there is none; None without a file.

        Counted from 1 (0 stands for none), or from 0 if the file reaches no further than that and names vertex 0.
        Raises ShapeFileError if it has not one line a vertex or names one that shape j lacks.
        """
        path = self.paths.get((i, j))
        if path is None:
            return None
        numbers = _column(path)
        if len(numbers) != vertex_counts[0]:
            raise ShapeFileError(
                f"{path}: holds {len(numbers)} lines, but {self.shapes[i].stem} has {vertex_counts[0]} vertices."
            )
        if numbers.max() > vertex_counts[1]:
            raise ShapeFileError(
                f"{path}: names vertex {numbers.max()}, but {self.shapes[j].stem} has {vertex_counts[1]}."
            )
        first = int(numbers.min() > 0 or numbers.max() == vertex_counts[1])
        return read_only(np.asarray(numbers - first))


def find_pairs(shapes: tuple[Path, ...]) -> PairFiles | None:
    """The files one_two.map of any two of the `shapes`, beside them or in a folder `groundtruth`; None without any."""
    for folder in _PAIRS:
        present = {path.name for path in (shapes[0].parent / folder).glob("*_*.map")}
        paths = {
            (i, j): one.parent / folder / f"{one.stem}_{two.stem}.map"
            for i, one in enumerate(shapes)
            for j, two in enumerate(shapes)
            if present and f"{one.stem}_{two.stem}.map" in present
        }
        if paths:
            return PairFiles(shapes, paths)
    return None


def find_landmarks(shapes: tuple[Path, ...]) -> LandmarkFiles | None:
    """The correspondence files of all `shapes`, beside them or in a folder `corres` next to theirs; None without any.

    Raises ShapeFileError if only some shapes have one.
    """
    for folder in _FOLDERS:
        for kind in _KINDS:
            paths = tuple(shape.parent / folder / f"{shape.stem}{kind}" for shape in shapes)
            missing = [path.name for path in paths if not path.is_file()]
            if not missing:
                return LandmarkFiles(paths)
            if len(missing) < len(paths):
                count, folder_path = len(missing), paths[0].parent
                raise ShapeFileError(
                    f"{folder_path}: {count} of {len(paths)} {kind} files are missing (first: {missing[0]})."
                )
    return None


def find_symmetry(folder: Path) -> IntArray | None:
    """(n,), the map in a file named symmetry or sym in `folder`; None without one.

    Raises ShapeFileError if it is not its own inverse.
    """
    for name in _SYMMETRY:
        for kind in (".txt", *_KINDS):
            path = folder / f"{name}{kind}"
            if path.is_file():
                mirror = _column(path)
                mirror = mirror - (int(mirror.min()) > 0)
                if mirror.max() >= len(mirror) or (mirror[mirror] != np.arange(len(mirror))).any():
                    raise ShapeFileError(f"{path}: is no mirror map, because mirroring twice does not lead back.")
                return read_only(mirror)
    return None


def _column(path: Path) -> IntArray:
    try:
        lines = lines_of(path.read_bytes())
        numbers = indices(float_rows(lines, 1, "the number of a vertex")[:, 0])
    except OSError as error:
        raise ShapeFileError(f"{path}: cannot be read ({error.strerror or error}).") from None
    except AddError as error:
        raise type(error)(f"{path}: {error}") from None
    if len(numbers) == 0 or numbers.min() < 0:
        raise ShapeFileError(f"{path}: holds {'a negative number' if len(numbers) else 'no numbers'}.")
    return numbers
