"""Which process a number means: the system gives numbers of ended processes to new ones."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class ProcessIdentity:
    """A process's number, and when it began as the system counts it."""

    pid: int
    began: str

    @property
    def is_alive(self) -> bool:
        return beginning(self.pid) == self.began

    @classmethod
    def of(cls, pid: int) -> ProcessIdentity:
        """The process that has the number now."""
        return cls(pid, beginning(pid) or "")


def beginning(pid: int) -> str | None:
    """When the process began, in the system's own words; None if it has ended."""
    if sys.platform.startswith("linux"):
        return _from_proc(pid)
    if sys.platform == "win32":
        return _from_windows(pid)
    said = subprocess.run(
        ["ps", "-o", "lstart=", "-p", str(pid)],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"LC_ALL": "C"},
    )
    return said.stdout.strip() or None


def _from_proc(pid: int) -> str | None:
    try:
        text = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace")
        boot = Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
    except OSError:
        return None
    values = text.rpartition(")")[2].split()  # the name in parentheses may hold spaces
    has_ended = values[0] in "ZX"  # a zombie waits for its parent to notice
    return None if has_ended else f"{boot} {values[19]}"


def _from_windows(pid: int) -> str | None:
    import ctypes

    kernel = ctypes.windll.kernel32  # type: ignore[attr-defined]
    query_limited_information, still_active = 0x1000, 259
    handle = kernel.OpenProcess(query_limited_information, False, pid)
    if not handle:
        return None
    times, code = (ctypes.c_ulonglong * 4)(), ctypes.c_ulong()
    places = [ctypes.byref(times, 8 * number) for number in range(4)]
    known = kernel.GetProcessTimes(handle, *places) and kernel.GetExitCodeProcess(handle, ctypes.byref(code))
    kernel.CloseHandle(handle)
    return str(times[0]) if known and code.value == still_active else None
