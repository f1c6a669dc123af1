"""How much room the spectra on disk take, and how much they may take."""

from __future__ import annotations

import os

from add_core.spectra import SpectraCache

LIMIT = "ADD_CACHE_GB"
"""Read by the core, in this process and in those that it starts."""


def used() -> int:
    """Bytes of all spectra that are kept."""
    return sum(entry.size for entry in SpectraCache.default().entries())


def limit() -> float:
    """Gigabytes that they may take."""
    return SpectraCache.default().limit / 1e9


def set_limit(gigabytes: float) -> None:
    """Let them take so much from the next computation on."""
    os.environ[LIMIT] = f"{gigabytes:g}"


def clear() -> int:
    """Drop them all; returns how many bytes that freed."""
    return SpectraCache.default().clear()
