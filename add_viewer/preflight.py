"""What must be there before Qt starts: without it Qt aborts where Python cannot catch, and blames something else."""

from __future__ import annotations

import ctypes
import os
import shutil
import sys
from collections.abc import Callable
from typing import Any

LIBRARIES = {
    "libglib-2.0.so.0": "libglib2.0-0",
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libfontconfig.so.1": "libfontconfig1",
    "libdbus-1.so.3": "libdbus-1-3",
}
X11_LIBRARIES = {
    "libxcb-cursor.so.0": "libxcb-cursor0",
    "libxkbcommon-x11.so.0": "libxkbcommon-x11-0",
    "libxcb-icccm.so.4": "libxcb-icccm4",
    "libxcb-keysyms.so.1": "libxcb-keysyms1",
    "libxcb-shape.so.0": "libxcb-shape0",
}
"""Shared libraries and the Debian packages that hold them."""

SCREEN = "-screen 0 1440x900x24"
_RESTARTED = "ADD_VIEWER_VIRTUAL_SCREEN"


def missing_packages(load: Callable[[str], object] = ctypes.CDLL, *, platform: str = sys.platform) -> list[str]:
    """Debian packages whose libraries Qt will look for and not find; none on other systems than Linux."""
    if not platform.startswith("linux"):
        return []
    wanted = LIBRARIES | ({} if os.environ.get("WAYLAND_DISPLAY") else X11_LIBRARIES)
    return [package for library, package in wanted.items() if not _loads(load, library)]


def has_display(*, platform: str = sys.platform) -> bool:
    """Whether there is a screen to open a window on; "offscreen" draws no 3-D and does not count."""
    if not platform.startswith("linux"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def restart_on_virtual_screen(arguments: list[str]) -> str:
    """Run this program again on a screen in memory; returns only if that is impossible, with the reason."""
    xvfb_run = shutil.which("xvfb-run")
    if xvfb_run is None or shutil.which("Xvfb") is None or shutil.which("xauth") is None:
        return "There is no display, and no virtual one to draw on. Install one: sudo apt-get install xvfb xauth"
    if os.environ.get(_RESTARTED):
        return "There is no display, and the virtual one did not start."
    os.environ[_RESTARTED] = "1"
    os.environ["QT_QPA_PLATFORM"] = "xcb"
    sys.stdout.flush()
    os.execv(xvfb_run, [xvfb_run, "-a", "-s", SCREEN, sys.executable, "-m", "add_viewer.app", *arguments])


def display_answers(load: Callable[[str], object] = ctypes.CDLL) -> bool:
    """Whether the X server that DISPLAY names lets us in; Qt aborts if it does not. True where X is not used."""
    if os.environ.get("WAYLAND_DISPLAY") or not os.environ.get("DISPLAY") or not sys.platform.startswith("linux"):
        return True
    try:
        xcb: Any = load("libxcb.so.1")
    except OSError:
        return True
    xcb.xcb_connect.restype = ctypes.c_void_p
    connection = ctypes.c_void_p(xcb.xcb_connect(None, None))
    refused = bool(xcb.xcb_connection_has_error(connection))
    xcb.xcb_disconnect(connection)
    return not refused


def complaint(*, for_picture: bool) -> str | None:
    """Why no window can open, in one line; None if one can."""
    missing = missing_packages()
    if missing:
        return f"Qt needs system libraries that are missing. Install them: sudo apt-get install {' '.join(missing)}"
    if not has_display() and not for_picture:
        return (
            "There is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set). "
            "On a desktop start a graphical session; elsewhere try: add-viewer humans/0 --screenshot picture.png"
        )
    if not display_answers():
        return f"The display {os.environ['DISPLAY']} does not answer. Is it running, and may you use it?"
    return None


def _loads(load: Callable[[str], object], library: str) -> bool:
    try:
        load(library)
    except OSError:
        return False
    return True
