"""What libraries complain of, in the words of this one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ..errors import AddError, ShapeFileError


@contextmanager
def complaints_about(kind: str) -> Iterator[None]:
    """Raise ShapeFileError with the reason in one line, whatever a library raises while it reads a file of `kind`."""
    try:
        yield
    except AddError:
        raise
    except Exception as error:
        reason = "rows of different length" if "inhomogeneous" in str(error) else str(error).partition(";")[0]
        reason = " ".join("".join(letter if letter.isprintable() else " " for letter in reason).split())
        reason = reason[:120].rstrip(".") or type(error).__name__
        article = "an" if kind[0] in "AEIOFHLMNRSX" else "a"
        raise ShapeFileError(f"is not {article} {kind} file that can be read ({reason}). Is it damaged?") from error
