"""A session as a file: versioned JSON that names its shapes by relative paths, so that a folder can move as a whole."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from .arrangement import Arrangement, ShapeLook
from .diffusion import Diffusion
from .fields import FieldChoice
from .kept_mirror import unpacked
from .matching import Matching
from .picks import PICK_LIMIT, Pick
from .plain import PlainDataError, from_plain, to_plain
from .session import SessionState
from .shapes import OpenShape

FORMAT, VERSION, ENDING = "add-viewer session", 1, ".addsession"
LARGEST = 40_000_000
"""Bytes; more is no session."""
_EMPTY = SessionState()
_RANGED = ("diffusion", "field", "compare", "arrangement", "matching")


class SessionFileError(PlainDataError):
    """A file holds no session that can be opened; the message says why and what to do."""


@dataclass(frozen=True)
class CameraPlace:
    """Where the eye of one view is. Angles in degrees, lengths in geodesic diameters.

    shape : its number. fitted : as far away as the whole shape needs; a window of another size then fits it anew.
    """

    shape: int
    panel: int = 0
    azimuth: float = 0.0
    elevation: float = 0.0
    focal: tuple[float, float, float] = (0.0, 0.0, 0.0)
    distance: float = 1.0
    fitted: bool = False


@dataclass(frozen=True)
class KeptShape:
    """A shape of the session. reference : a shipped name, or a path; in the file relative, beginning with a dot.

    mirror : the mirror map that was found for it, see `kept_mirror`, "" if none was. confidence : in that map, 0 to 1.
    """

    reference: str
    name: str = ""
    vertices: int = 0
    visible: bool = True
    wireframe: bool = False
    point_size: float = 1.0
    mirror: str = ""
    confidence: float | None = None

    def with_mirror(self, shape: OpenShape) -> OpenShape:
        """The shape as it was opened, with the mirror map that had been found for it, if that still fits."""
        if shape.symmetry is not None or not self.mirror:
            return shape
        symmetry = unpacked(self.mirror, shape.vertex_count)
        if symmetry is None:
            return shape
        return replace(shape, symmetry=symmetry, symmetry_confidence=self.confidence)


@dataclass(frozen=True)
class KeptPick:
    """A picked vertex of shape number `shape`."""

    shape: int
    vertex: int
    slot: int
    mirror_of: int | None = None


@dataclass(frozen=True)
class KeptSession:
    """What a session file holds. active : number of a shape. layout : the window's panels, as Qt packs them."""

    shapes: tuple[KeptShape, ...] = ()
    active: int | None = None
    diffusion: Diffusion = _EMPTY.diffusion
    picks: tuple[KeptPick, ...] = ()
    field: FieldChoice = _EMPTY.field
    compare: FieldChoice | None = None
    arrangement: Arrangement = _EMPTY.arrangement
    matching: Matching = _EMPTY.matching
    cameras: tuple[CameraPlace, ...] = ()
    layout: str = ""
    saved: str = ""

    @classmethod
    def of(cls, state: SessionState, cameras: Sequence[CameraPlace] = (), layout: str = "") -> KeptSession:
        """What is worth keeping of `state`."""
        number = {shape.key: index for index, shape in enumerate(state.shapes)}
        picks = (KeptPick(number[p.shape], p.vertex, p.slot, p.mirror_of) for p in state.picks if p.shape in number)
        return cls(
            shapes=tuple(_kept_shape(shape, state.look(shape.key)) for shape in state.shapes),
            active=None if state.active_key is None else number.get(state.active_key),
            diffusion=state.diffusion,
            picks=tuple(picks),
            field=state.field,
            compare=state.compare,
            arrangement=state.arrangement,
            matching=state.matching,
            cameras=tuple(cameras),
            layout=layout,
            saved=datetime.now(UTC).isoformat(timespec="seconds"),
        )

    def state(self, opened: Sequence[OpenShape | None]) -> SessionState:
        """The session with the shapes that could be opened, in the order of `shapes`, without what belongs to others.

        Picks beyond a shape's last vertex are left out too: its file has changed.
        """
        opened = [shape and kept.with_mirror(shape) for kept, shape in zip(self.shapes, opened, strict=True)]
        shapes = tuple({shape.key: shape for shape in opened if shape is not None}.values())
        active = opened[self.active] if self.active is not None and self.active < len(opened) else None
        return SessionState(
            shapes=shapes,
            active_key=active.key if active else (shapes[-1].key if shapes else None),
            looks=tuple(self._looks(opened)),
            diffusion=self.diffusion,
            picks=tuple(self._picks(opened)),
            field=self.field,
            compare=self.compare,
            arrangement=self.arrangement,
            matching=self.matching,
        )

    def _looks(self, opened: Sequence[OpenShape | None]) -> list[ShapeLook]:
        pairs = [(kept, shape) for kept, shape in zip(self.shapes, opened, strict=True) if shape is not None]
        looks = [ShapeLook(shape.key, kept.visible, kept.wireframe, kept.point_size) for kept, shape in pairs]
        return [look.with_changes() for look in looks if look != ShapeLook(look.key)]

    def _picks(self, opened: Sequence[OpenShape | None]) -> list[Pick]:
        picks = []
        for kept in self.picks:
            shape = opened[kept.shape] if 0 <= kept.shape < len(opened) else None
            ends = [kept.vertex] if kept.mirror_of is None else [kept.vertex, kept.mirror_of]
            if shape is not None and all(0 <= end < shape.vertex_count for end in ends):
                picks.append(Pick(shape.key, kept.vertex, kept.slot % PICK_LIMIT, kept.mirror_of))
        return picks


# -- text -------------------------------------------------------------------------------------------------------------


def session_text(kept: KeptSession, folder: Path | None, **more: object) -> str:
    """The file's text. folder : where it will lie, to write paths relative to it; None keeps them as they are."""
    content = to_plain(_with_paths(kept, lambda path: _relative(path, folder)))
    return json.dumps({"format": FORMAT, "version": VERSION, **more, **content}, indent=1, ensure_ascii=False) + "\n"


def read_session(path: Path) -> KeptSession:
    """What the file at `path` holds, its paths made absolute. Raises SessionFileError, or OSError."""
    if path.stat().st_size > LARGEST:
        raise SessionFileError(f"{path.name} is no session of this app: it is too large.")
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError):
        raise SessionFileError(f"{path.name} is no session of this app, or it is damaged: it holds no JSON.") from None
    if not isinstance(content, Mapping) or content.get("format") != FORMAT:
        raise SessionFileError(f'{path.name} is no session of this app: "format" must be {FORMAT!r}.')
    try:
        return _read_content(content, path)
    except PlainDataError as error:
        raise SessionFileError(f"{path.name} is damaged: {error}") from None


def kept_process(path: Path) -> tuple[int, str]:
    """The process that wrote a session which `read_session` can read: its number, and when it began."""
    kept = json.loads(path.read_text(encoding="utf-8")).get("process")
    is_process = isinstance(kept, list) and len(kept) == 2 and isinstance(kept[0], int)
    return (kept[0], str(kept[1])) if is_process else (0, "")


def _read_content(content: Mapping[str, Any], path: Path) -> KeptSession:
    version = content.get("version")
    if version != VERSION:
        newer = isinstance(version, int) and version > VERSION
        remedy = "Update the app to open it." if newer else f"This app reads version {VERSION}."
        raise SessionFileError(f"{path.name} is of version {version!r}, which this app does not know. {remedy}")
    kept = from_plain(KeptSession, content, "")
    ranged = {name: _in_range(getattr(kept, name)) for name in _RANGED}
    return _with_paths(replace(kept, **ranged), lambda text: _absolute(text, path.parent))


def _in_range(value: Any) -> Any:
    """The same with every number brought into range, as if a person had asked for it."""
    return None if value is None else type(value)().with_changes(**to_plain(value))


def _kept_shape(shape: OpenShape, look: ShapeLook) -> KeptShape:
    drawn = (look.visible, look.wireframe, look.point_size)
    found = (shape.found_mirror, shape.symmetry_confidence)
    return KeptShape(shape.reference, shape.name, shape.vertex_count, *drawn, *found)


def _with_paths(kept: KeptSession, change: Any) -> KeptSession:
    """The same with `change` applied to whatever may be a path: shapes, and models that describe them."""

    def field(choice: FieldChoice) -> FieldChoice:
        return replace(choice, descriptor=change(choice.descriptor))

    return replace(
        kept,
        shapes=tuple(replace(shape, reference=change(shape.reference)) for shape in kept.shapes),
        field=field(kept.field),
        compare=None if kept.compare is None else field(kept.compare),
        matching=replace(kept.matching, descriptor=change(kept.matching.descriptor)),
    )


def _relative(reference: str, folder: Path | None) -> str:
    """An absolute path seen from `folder`; a shipped name, and a path on another drive, stay as they are."""
    if folder is None or not os.path.isabs(reference):
        return reference
    try:
        seen = Path(os.path.relpath(reference, folder.resolve())).as_posix()
    except ValueError:
        return reference
    return seen if seen.startswith("..") else f"./{seen}"


def _absolute(reference: str, folder: Path) -> str:
    return os.path.normpath(folder.resolve() / reference) if reference.startswith(("./", "../")) else reference
