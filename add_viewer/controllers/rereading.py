"""Opening what was open before: a shape that undo still keeps, and whose file has not changed, is not read again."""

from __future__ import annotations

from pathlib import Path
from weakref import WeakValueDictionary

from ..models.shapes import OpenShape
from .opening import Read

Stamp = tuple[str, int, int]


class Rereading:
    """Reads shapes by `read`, each once while it is in use: what was computed for it still counts, and takes no room
    a second time.
    """

    def __init__(self, read: Read) -> None:
        self._read = read
        self._known: WeakValueDictionary[Stamp, OpenShape] = WeakValueDictionary()

    def __call__(self, reference: str) -> OpenShape:
        stamp = _stamp(reference)
        known = self._known.get(stamp)
        if known is None:
            known = self._known[stamp] = self._read(reference)
        return known

    def lighten(self, in_use: tuple[OpenShape, ...]) -> None:
        """Let shapes that are not `in_use`, kept for undo alone, take as little room as they can."""
        meshes = [shape.shape for shape in in_use]
        for known in list(self._known.values()):
            if not any(known.shape is mesh for mesh in meshes):
                known.travel_light()


def _stamp(reference: str) -> Stamp:
    """The file as it is now, by time and size; shipped shapes never change."""
    try:
        path = Path(reference).expanduser().resolve()
        found = path.stat()
    except OSError:
        return (reference, 0, 0)
    return (str(path), found.st_mtime_ns, found.st_size)
