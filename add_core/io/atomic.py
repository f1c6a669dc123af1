"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from ..errors import ShapeFileError


def write_atomically(path: Path, data: bytes) -> None:
    """Put `data` at `path`: readers see the old file or the whole new one, even if the disk fills or the program dies.

    Raises ShapeFileError if it cannot be written.
    """
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    try:
        try:
            with temporary.open("xb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.replace(temporary, path)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        raise ShapeFileError(f"cannot be written ({error.strerror or error}).") from None
