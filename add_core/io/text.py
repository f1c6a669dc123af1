"""Numbers out of text, with complaints that name the line."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from .._check import FloatArray
from ..errors import ShapeFileError

Line = tuple[int, list[str]]
"""A line's number in the file, from 1, and its words."""


def lines_of(data: bytes, *, comment: str = "#") -> list[Line]:
    """The lines that hold anything besides a comment."""
    # Comments may be in any encoding; numbers are ASCII in all of them.
    text = data.decode("utf-8", errors="replace").removeprefix("\ufeff")
    words = ((number, line.partition(comment)[0].split()) for number, line in enumerate(text.splitlines(), start=1))
    return [(number, line) for number, line in words if line]


def float_rows(lines: Sequence[Line], width: int, what: str) -> FloatArray:
    """(len(lines), width): the first `width` numbers of each line. `what` names one row in complaints."""
    rows = []
    for number, words in lines:
        try:
            row = [float(word) for word in words[:width]]
        except ValueError:
            raise ShapeFileError(f"line {number} should be {what}, but it reads {excerpt(words)}.") from None
        if len(row) < width:
            raise ShapeFileError(f"line {number} should be {what}, but it has {len(row)} numbers.")
        rows.append(row)
    return np.array(rows, dtype=np.float64).reshape(-1, width)


def whole(word: str, number: int, what: str) -> int:
    """`word` of line `number` as a whole number that fits an index. `what` names it in complaints."""
    try:
        value = int(word)
    except ValueError:
        raise ShapeFileError(f"line {number} should hold {what}, but it reads {excerpt([word])}.") from None
    if abs(value) >= 2**62:
        raise ShapeFileError(f"line {number} should hold {what}, but it holds {value}.")
    return value


def excerpt(words: Iterable[str]) -> str:
    """The beginning of a line, short and printable."""
    text = " ".join(words)
    shown = text if len(text) <= 40 else text[:37] + "..."
    return repr(shown) if shown.isprintable() else "something that is not text"
