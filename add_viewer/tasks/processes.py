"""Commands of the core in processes of their own, which outlive a crash of the window.

They write to files, not to pipes: when the window is gone they work on, and the next window reads on.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from PySide6.QtCore import QElapsedTimer, QObject, QTimer

from .identity import ProcessIdentity
from .tail import Tail, event_of

OUTPUT, LOG = "output.jsonl", "log.txt"
"""What a command said on stdout and on stderr. Each run begins with an empty line in the one, a date in the other."""

POLL = 150
"""Milliseconds between two looks at a running process."""
GRACE = 5000
"""Milliseconds in which a process that was asked to end may bring its files in order."""

Said = Callable[[list[dict[str, Any]], bool], None]
"""Takes events, and whether they are news (not read again from the file)."""
Ended = Callable[[int | None, str], None]
"""Takes the exit status, None if unknown, and the last line of text in the log."""

_START = """
import json, os, sys
sys.path[:] = json.loads(os.environ.pop("ADD_CORE_SEARCH_PATH"))
if hasattr(os, "nice"):
    os.nice(10)
try:  # Linux shares its cores out among sessions before it looks at the niceness of a process in one of them
    with open("/proc/self/autogroup", "w") as priority:
        priority.write("8")
except OSError:
    pass
from add_core.cli import main
main()
"""
"""The command imports what the window imports, from wherever the window has it, and lets the window go first."""

_SINGLE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1")


class CommandProcess:
    """One command that runs, or ran before this window was opened."""

    def __init__(self, identity: ProcessIdentity, folder: Path, said: Said, ended: Ended) -> None:
        self.identity = identity
        self._said, self._ended = said, ended
        self._tails = [Tail(folder / OUTPUT), Tail(folder / LOG)]
        self._own: subprocess.Popen[bytes] | None = None
        self._last_words, self._is_over = "", False
        self._since_asked = QElapsedTimer()

    @property
    def is_ending(self) -> bool:
        return self._since_asked.isValid()

    @classmethod
    def start(cls, arguments: Sequence[str], folder: Path, *, anew: bool, said: Said, ended: Ended) -> CommandProcess:
        """Run `add-core` with `arguments`. anew : forget what was said before.

        Raises OSError if the process cannot be started.
        """
        if not sys.executable or getattr(sys, "frozen", False):
            raise OSError("This program has no Python of its own to start.")
        folder.mkdir(parents=True, exist_ok=True)
        mode = "wb" if anew else "ab"
        with (folder / OUTPUT).open(mode) as output, (folder / LOG).open(mode) as log:
            made = cls(ProcessIdentity(0, ""), folder, said, ended)
            log.write(f"Started on {time.strftime('%d %B %Y, %H:%M:%S')}\n".encode())
            log.flush()
            output.write(b"\n")
            output.flush()
            made._own = subprocess.Popen(
                [sys.executable, "-P", "-c", _START, *arguments, "--json"],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=log,
                cwd=folder,
                env=os.environ | _SINGLE | {"ADD_CORE_SEARCH_PATH": json.dumps(sys.path)},
                start_new_session=True,
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0)
                | getattr(subprocess, "BELOW_NORMAL_PRIORITY_CLASS", 0),
            )
        made.identity = ProcessIdentity.of(made._own.pid)
        return made

    @property
    def is_alive(self) -> bool:
        """Whether the command still runs."""
        if self._own is not None:
            return self._own.poll() is None
        return self.identity.pid > 0 and self.identity.is_alive

    def ask_to_end(self) -> None:
        """Let the command bring its files in order and end; it is killed if it takes too long."""
        if self.is_alive and not self._since_asked.isValid():
            self._since_asked.start()
            with suppress(ProcessLookupError):
                os.kill(self.identity.pid, signal.SIGTERM)

    def kill(self) -> None:
        """End the command at once, with every process that it started."""
        if not self.is_alive:
            return
        with suppress(ProcessLookupError):
            if hasattr(os, "killpg"):
                os.killpg(self.identity.pid, signal.SIGKILL)
            else:  # Windows: what it started ends when its pipes close
                os.kill(self.identity.pid, signal.SIGTERM)

    def look(self) -> bool:
        """Pass on what is new; False once the process has ended and everything is said."""
        if self._is_over:
            return False
        is_alive = self.is_alive  # asked first: whatever it wrote before its end is then there to be read
        if is_alive and self._since_asked.isValid() and self._since_asked.elapsed() > GRACE:
            self.kill()
        is_news = not any(tail.is_old for tail in self._tails)
        lines = [line for tail in self._tails for line in tail.lines()]
        events = [event for line in lines if (event := event_of(line)) is not None]
        self._last_words = next((line for line in reversed(lines) if _is_text(line)), self._last_words)
        if events:
            self._said(events, is_news)
        if is_alive or any(tail.has_more for tail in self._tails):
            return True
        self._is_over = True  # first: it is said once, even if whoever listens stumbles
        self._ended(None if self._own is None else self._own.returncode, self._last_words)
        return False

    def reap(self) -> None:
        """Take note of the end of a killed process, so that the system can forget it."""
        if self._own is not None:
            self._own.wait()


class ProcessRunner(QObject):
    """Starts commands, and looks at those that run a few times a second; without any it does nothing."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.window = ProcessIdentity.of(os.getpid())
        self._watched: list[CommandProcess] = []
        self._timer = QTimer(self, interval=POLL)
        self._timer.timeout.connect(self._look)

    def start(self, arguments: Sequence[str], folder: Path, *, anew: bool, said: Said, ended: Ended) -> CommandProcess:
        """Run `add-core` with `arguments` in `folder`; see `CommandProcess.start`."""
        return self._watch(CommandProcess.start(arguments, folder, anew=anew, said=said, ended=ended))

    def follow(self, pid: int, began: str, folder: Path, *, said: Said, ended: Ended) -> CommandProcess:
        """Read on what an earlier window started; if it has ended, say again what it said, and that it ended."""
        return self._watch(CommandProcess(ProcessIdentity(pid, began), folder, said, ended))

    @staticmethod
    def is_alive(pid: int, began: str) -> bool:
        """Whether the process that had this number since then still runs."""
        return pid > 0 and ProcessIdentity(pid, began).is_alive

    def stop(self) -> None:
        """Forget what is watched. Processes that were not asked to end work on."""
        self._timer.stop()
        ending = [process for process in self._watched if process.is_ending or not process.is_alive]
        clock = QElapsedTimer()
        clock.start()
        while clock.elapsed() < GRACE and any(process.is_alive for process in ending):
            time.sleep(0.01)
        for process in ending:
            process.kill()
            process.reap()
        self._watched.clear()

    def _watch(self, process: CommandProcess) -> CommandProcess:
        self._watched.append(process)
        self._timer.start()
        return process

    def _look(self) -> None:
        for process in tuple(self._watched):
            if not process.look() and process in self._watched:
                self._watched.remove(process)
        if not self._watched:
            self._timer.stop()


def _is_text(line: str) -> bool:
    return bool(line.strip()) and event_of(line) is None
