"""What has been drawn into a folder already, so that the same command goes on where it was stopped."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from .. import __version__
from ..io.atomic import write_atomically

FILE = "figures.json"


@dataclass(frozen=True)
class Entry:
    """A finished figure. files : names in the folder, the picture first. quality, image : how it was asked for.
    training : minutes for each network that was trained for it, 0 if none was. command : what was
    run. version : of the program that drew it.
    """

    number: int
    files: tuple[str, ...]
    caption: str
    missing: tuple[str, ...]
    quality: str
    image: str
    seconds: float
    training: float = 0.0
    command: str = ""
    version: str = __version__


class Record:
    """The entries of a folder, kept in a file beside the figures."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._entries: dict[int, Entry] = {entry.number: entry for entry in _read(folder / FILE)}

    def __iter__(self) -> Iterator[Entry]:
        return iter(sorted(self._entries.values(), key=lambda entry: entry.number))

    def finished(self, number: int, *, quality: str, image: str, training: float = 0.0) -> Entry | None:
        """The entry of a figure that was drawn in this way by this version and whose files are there; or None."""
        found = self._entries.get(number)
        wanted = (quality, image, training, __version__)
        if found is None or (found.quality, found.image, found.training, found.version) != wanted:
            return None
        return found if all((self._folder / name).is_file() for name in found.files) else None

    def add(self, entry: Entry) -> None:
        """Remember an entry, now and for the next run."""
        self._entries[entry.number] = entry
        listed = [asdict(self._entries[number]) for number in sorted(self._entries)]
        write_atomically(self._folder / FILE, (json.dumps(listed, indent=1, ensure_ascii=False) + "\n").encode())


def _read(path: Path) -> list[Entry]:
    """Entries of a file; none if it is missing or is not one of ours: then figures are simply drawn again."""
    try:
        listed: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))
        return [Entry(**{**item, "files": tuple(item["files"]), "missing": tuple(item["missing"])}) for item in listed]
    except (OSError, ValueError, TypeError, KeyError):
        return []
