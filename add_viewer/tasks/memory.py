"""Memory: giving back what was freed, also after large shapes were closed, and not searching what never is."""

from __future__ import annotations

import ctypes
import gc
import sys


def give_back() -> None:
    """Let the C library return what is free to the system; nothing where it does so by itself."""
    if sys.platform.startswith("linux"):
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # glibc alone has it
        if trim is not None:
            trim(0)


def spare_what_is_here() -> None:
    """Let Python's search for garbage go on, but pass over all that exists now.

    Libraries make nearly 300,000 objects, none of which becomes garbage, but each full search among them holds every
    thread for 80 to 240 ms.
    """
    gc.freeze()
    gc.enable()
