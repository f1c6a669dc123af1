"""Deleting folders of gigabytes without keeping the window waiting."""

from __future__ import annotations

import shutil
import threading
from contextlib import suppress
from pathlib import Path

GONE = ".gone-"


def dispose(folder: Path) -> None:
    """Put a folder out of sight at once and delete it meanwhile, with what an earlier window did not get done."""
    with suppress(OSError):  # it was not there, or is in use: then it stays
        folder.rename(folder.with_name(GONE + folder.name))
    threading.Thread(target=_delete, args=(folder.parent,), daemon=True).start()


def _delete(parent: Path) -> None:
    for folder in parent.glob(f"{GONE}*"):
        shutil.rmtree(folder, ignore_errors=True)
