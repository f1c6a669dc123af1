"""Giving memory back: what was freed stays with the process otherwise, also after large shapes were closed."""

from __future__ import annotations

import ctypes
import sys


def give_back() -> None:
    """Let the C library return what is free to the system; nothing where it does so by itself."""
    if sys.platform.startswith("linux"):
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # glibc alone has it
        if trim is not None:
            trim(0)
