"""Keeping sessions: saving and opening them, and never losing one, whatever ends the app."""

from __future__ import annotations

import logging
import secrets
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..models.results import Notice, Results
from ..models.session import Session
from ..models.session_file import (
    CameraPlace,
    KeptSession,
    SessionFileError,
    kept_process,
    read_session,
    session_text,
)
from ..models.shapes import OpenShape
from .data_folder import data_folder
from .exporting import write_atomically
from .opening import Read, read_shape
from .running import Later, Run, explain

LAST = "last.json"
_log = logging.getLogger(__name__)


@dataclass
class Outside:
    """What belongs to a session but to no model: read when it is kept, written when it is opened again."""

    cameras: Callable[[], tuple[CameraPlace, ...]] = tuple
    layout: Callable[[], str] = str
    apply: Callable[[KeptSession], None] = lambda _kept: None


@dataclass(frozen=True)
class Process:
    """This process and how to know whether another still runs: its number, and when it began."""

    pid: int
    began: str
    is_alive: Callable[[int, str], bool]


@dataclass(frozen=True)
class Leftover:
    """A session that an app which no longer runs did not close."""

    path: Path
    kept: KeptSession


@dataclass(frozen=True)
class _Opened:
    kept: KeptSession
    shapes: tuple[OpenShape | None, ...]
    problems: tuple[str, ...]


def sessions_home() -> Path:
    """Where running sessions are kept."""
    return data_folder() / "sessions"


class KeepingController:
    """Saves and opens sessions, and keeps the running one in `home` after every change.

    Every app keeps its own file there, with its process in it: a file whose process has ended was left by a crash.
    opened : called with the path of a session that a person opened or saved.
    """

    def __init__(
        self,
        session: Session,
        results: Results,
        run: Run,
        later: Later,
        process: Process,
        *,
        home: Path | None = None,
        read: Read = read_shape,
    ) -> None:
        self._session, self._results, self._run, self._later = session, results, run, later
        self._process, self._read = process, read
        self.home = home or sessions_home()
        self.outside = Outside()
        self.path: Path | None = None
        self.opened: Callable[[Path], None] = lambda path: None
        self.failed: Callable[[str], None] = lambda reason: None
        self.autosaves = True
        self._mine = self.home / f"running-{process.pid}-{secrets.token_hex(4)}.json"
        self._waits = self._complained = False
        session.history_changed.connect(self.remember_soon)

    # -- what a person does -------------------------------------------------------------------------------------------

    def save(self, path: Path) -> None:
        """Write the session to `path`, whole or not at all. Raises OSError."""
        path = path.absolute()
        text = session_text(self.snapshot(), path.parent)
        write_atomically(path, lambda temporary: _write(temporary, text))
        self.path = path
        self.opened(path)

    def open(self, path: Path) -> None:
        """Put the session at `path` in the place of this one; undo brings this one back."""
        path = path.absolute()
        self._open(path, lambda answer: self._done(answer, path))

    def open_last(self) -> None:
        """Go on with the session that was open when the app was closed last; where to save it is asked anew."""
        if self.last is not None:
            self._open(self.last, lambda answer: self._done(answer, None))

    def snapshot(self) -> KeptSession:
        """Everything that is worth keeping, as it is now."""
        return KeptSession.of(self._session.state, self.outside.cameras(), self.outside.layout())

    def _open(self, path: Path, done: Callable[[_Opened], None]) -> None:
        self._results.set_busy(f"Opening {path.name} …")
        self._run("open", lambda: self._load(path), done=done, failed=self._failed, queue=True)

    def _load(self, path: Path) -> _Opened:
        kept = read_session(path)
        shapes: list[OpenShape | None] = []
        problems = []
        for each in kept.shapes:
            try:
                shape = self._read(each.reference)
            except Exception as error:  # noqa: BLE001 - the others still open, and the person hears of this one
                shapes.append(None)
                problems.append(f"{each.name or each.reference} is missing: {explain(error)}")
                continue
            shapes.append(shape)
            if each.vertices and shape.vertex_count != each.vertices:
                problems.append(
                    f"{each.name} has changed: it had {each.vertices:,} vertices and has {shape.vertex_count:,}."
                )
        return _Opened(kept, tuple(shapes), tuple(problems))

    def _done(self, answer: _Opened, path: Path | None) -> None:
        self._results.set_busy("")
        self.path = path
        self._session.restore(answer.kept.state(answer.shapes))
        self.outside.apply(answer.kept)
        if answer.problems:
            self._results.report(" ".join(("The session is open, but not all of it.", *answer.problems)))
        if path is not None:
            self.opened(path)

    def _failed(self, error: BaseException) -> None:
        self._results.set_busy("")
        reason = explain(error)
        self._results.report(reason)
        self.failed(reason)

    # -- never losing anything ----------------------------------------------------------------------------------------

    def remember_soon(self) -> None:
        """Keep the session a moment later; changes until then are kept with it."""
        if self.autosaves and not self._waits:
            self._waits = True
            self._later(self.remember)

    def remember(self) -> None:
        """Keep the session now, in the user's own folder."""
        self._waits = False
        if not self.autosaves:
            return
        try:
            self._write_mine(self.snapshot())
        except OSError as error:
            self._complain(error)

    def _write_mine(self, kept: KeptSession) -> None:
        text = session_text(kept, None, process=[self._process.pid, self._process.began])
        self.home.mkdir(parents=True, exist_ok=True)
        write_atomically(self._mine, lambda temporary: _write(temporary, text))

    def _complain(self, error: OSError) -> None:
        _log.warning("the session was not kept: %s", error)
        if not self._complained:  # once: the next change would only say it again
            self._complained = True
            self._results.noticed.emit(
                Notice(f"This session cannot be kept safe from a crash: {explain(error)} Save it with Ctrl+S.")
            )

    def leftovers(self) -> list[Leftover]:
        """Sessions with shapes that ended apps did not close, the newest first; empty ones are deleted."""
        found = []
        for path in self.home.glob("running-*.json"):
            try:
                kept, (pid, began) = read_session(path), kept_process(path)
            except (SessionFileError, OSError) as error:  # perhaps of a later version: left alone
                _log.warning("%s is left alone: %s", path, error)
                continue
            if self._process.is_alive(pid, began):
                continue
            if kept.shapes:
                found.append(Leftover(path, kept))
            else:
                path.unlink(missing_ok=True)
        return sorted(found, key=lambda leftover: leftover.kept.saved, reverse=True)

    def restore(self, leftover: Leftover) -> None:
        """Go on with a session that a crash ended. Another app that asked first has it."""
        try:
            leftover.path.rename(self._mine)
            self._write_mine(leftover.kept)
        except OSError:
            self._results.report("That session has been restored in another window already.")
            return
        self._open(self._mine, lambda answer: self._done(answer, None))

    def discard(self, leftover: Leftover) -> None:
        """Forget a session that a crash ended."""
        leftover.path.unlink(missing_ok=True)

    @property
    def last(self) -> Path | None:
        """The session as it was when the app was closed last."""
        path = self.home / LAST
        return path if path.is_file() else None

    def end(self) -> None:
        """The app is closed by its person: nothing will have to be restored, but the session stays at hand."""
        if self._session.state.shapes and self.autosaves:
            self.remember()
            with suppress(OSError):
                self._mine.replace(self.home / LAST)
        self.autosaves = False
        self._mine.unlink(missing_ok=True)


def _write(path: Path, text: str) -> Any:
    return path.write_text(text, encoding="utf-8")
