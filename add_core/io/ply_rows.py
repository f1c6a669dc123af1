"""The rows of a PLY file's tables, as text or as bytes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._check import FloatArray
from ..errors import ShapeFileError
from .ply_header import PlyElement, PlyProperty
from .text import excerpt


@dataclass(frozen=True, eq=False)
class Column:
    """One property of all rows; of lists, all items one after another and how many each row has."""

    values: NDArray[np.number]
    counts: NDArray[np.int64] | None = None

    def numbers(self, name: str) -> FloatArray:
        """(rows,) float64, of a property that is one number a row."""
        if self.counts is not None:
            raise ShapeFileError(f"holds lists under {name}, which should be one number.")
        return self.values.astype(np.float64)


class TextRows:
    """Reads the tables of an ascii file, one after another."""

    def __init__(self, data: bytes) -> None:
        self._words = data.split()
        self._next = 0

    def read(self, element: PlyElement) -> dict[str, Column]:
        """Every property of `element`, by name."""
        left = len(self._words) - self._next
        if element.count * len(element.properties) > left:
            raise ShapeFileError(_cut_off(element, f"only {left} numbers follow"))
        if any(column.count_dtype for column in element.properties):
            return self._read_lists(element)
        width = len(element.properties)
        end = self._next + width * element.count
        table = _floats(self._words[self._next : end]).reshape(element.count, width)
        self._next = end
        return {column.name: Column(table[:, k]) for k, column in enumerate(element.properties)}

    def _read_lists(self, element: PlyElement) -> dict[str, Column]:
        words, at = self._words, self._next
        counts: dict[str, list[int]] = {column.name: [] for column in element.properties}
        items: dict[str, list[bytes]] = {column.name: [] for column in element.properties}
        for _ in range(element.count):
            for column in element.properties:
                size = 1
                if column.count_dtype:
                    size = _list_size(words[at]) if at < len(words) else 0
                    counts[column.name].append(size)
                    at += 1
                items[column.name] += words[at : at + size]
                at += size
        if at > len(words):
            raise ShapeFileError(_cut_off(element, "the file ends before"))
        self._next = at
        return {
            column.name: Column(
                _floats(items[column.name]),
                np.array(counts[column.name], dtype=np.int64) if column.count_dtype else None,
            )
            for column in element.properties
        }


class BinaryRows:
    """Reads the tables of a binary file, one after another."""

    def __init__(self, data: bytes, start: int) -> None:
        self._data = data
        self._next = start

    def read(self, element: PlyElement) -> dict[str, Column]:
        """Every property of `element`, by name."""
        left = len(self._data) - self._next
        if element.count * max(element.least_bytes, 1) > left:
            raise ShapeFileError(_cut_off(element, f"only {left} bytes follow"))
        # Nearly always every list of a table has the length of the first: then the rows are one array.
        return self._read_equal_rows(element) or self._read_rows(element)

    def _read_equal_rows(self, element: PlyElement) -> dict[str, Column] | None:
        sizes = self._first_row_sizes(element) if element.count else {}
        if sizes is None:
            return None
        layout: list[tuple[str, np.dtype[np.generic], tuple[int, ...]]] = []
        for k, column in enumerate(element.properties):
            if column.count_dtype:
                layout.append((f"count {k}", column.count_dtype, ()))
            layout.append((f"value {k}", column.dtype, (sizes.get(k, 0),) if column.count_dtype else ()))
        rows = np.dtype(layout)
        if rows.itemsize * element.count > len(self._data) - self._next:
            return None
        table = np.frombuffer(self._data, rows, element.count, self._next) if element.count else np.empty(0, rows)
        columns = {}
        for k, column in enumerate(element.properties):
            counts = table[f"count {k}"].astype(np.int64) if column.count_dtype else None
            if counts is not None and (counts != sizes.get(k, 0)).any():
                return None
            columns[column.name] = Column(table[f"value {k}"].reshape(-1), counts)
        self._next += rows.itemsize * element.count
        return columns

    def _first_row_sizes(self, element: PlyElement) -> dict[int, int] | None:
        """The length of each list in the first row, by the property's place; None if the file ends within it."""
        at, sizes = self._next, {}
        for k, column in enumerate(element.properties):
            size = 1
            if column.count_dtype:
                if at + column.count_dtype.itemsize > len(self._data):
                    return None
                size = sizes[k] = _list_size(np.frombuffer(self._data, column.count_dtype, 1, at)[0])
                at += column.count_dtype.itemsize
            at += size * column.dtype.itemsize
        return sizes if at <= len(self._data) else None

    def _read_rows(self, element: PlyElement) -> dict[str, Column]:
        values: dict[str, list[NDArray[np.number]]] = {column.name: [] for column in element.properties}
        counts: dict[str, list[int]] = {column.name: [] for column in element.properties}
        for _ in range(element.count):
            for column in element.properties:
                size = 1
                if column.count_dtype:
                    size = _list_size(self._take(element, column.count_dtype, 1)[0])
                    counts[column.name].append(size)
                values[column.name].append(self._take(element, column.dtype, size))
        return {column.name: _joined(column, values[column.name], counts[column.name]) for column in element.properties}

    def _take(self, element: PlyElement, dtype: np.dtype[np.generic], count: int) -> NDArray[np.number]:
        end = self._next + count * dtype.itemsize
        if end > len(self._data):
            raise ShapeFileError(_cut_off(element, "the file ends before"))
        taken = np.frombuffer(self._data, dtype, count, self._next)
        self._next = end
        return taken


def _joined(column: PlyProperty, parts: list[NDArray[np.number]], counts: list[int]) -> Column:
    values = np.concatenate(parts) if parts else np.zeros(0)
    return Column(values, np.array(counts, dtype=np.int64) if column.count_dtype else None)


def _list_size(value: object) -> int:
    try:
        size = int(value)  # type: ignore[call-overload]
    except (ValueError, OverflowError):
        size = -1
    if size < 0:
        raise ShapeFileError("has a list whose length is not a whole number.")
    return int(size)


def _floats(words: list[bytes]) -> FloatArray:
    try:
        return np.array([float(word) for word in words], dtype=np.float64)
    except ValueError:
        wrong = next(word for word in words if not _is_number(word))
        raise ShapeFileError(
            f"should hold numbers, but one reads {excerpt([wrong.decode('ascii', 'replace')])}."
        ) from None


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _cut_off(element: PlyElement, found: str) -> str:
    return f"claims {element.count} rows of {element.name}, but {found}. Is it cut off?"
