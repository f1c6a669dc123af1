"""`add-viewer [FILE…] [--session FILE] [--screenshot PNG]`: where everything is put together."""

from __future__ import annotations

import argparse
import gc
import sys
from pathlib import Path

from add_core import __version__

from . import preflight

_DESCRIPTION = "See how heat runs on a shape, in any direction."
_FILES = (
    "shape files (OFF, OBJ, PLY, STL, VTK, VTP, glTF, GLB, XYZ), or shipped shapes such as humans/0, poses/12, dogs/3"
)


def main(arguments: list[str] | None = None) -> int:
    """Run the app; the exit status is 0, or 2 for a mistake that the person can mend."""
    given = sys.argv[1:] if arguments is None else arguments
    options = _parser().parse_args(given)
    problem = preflight.complaint(for_picture=options.screenshot is not None)
    if problem is None and not preflight.has_display():
        problem = preflight.restart_on_virtual_screen(given)
    if problem is None and options.screenshot is not None and not options.screenshot.absolute().parent.is_dir():
        problem = f"The folder of {options.screenshot} does not exist. Create it first."
    if problem is not None:
        return _fail(problem)
    gc.disable()  # libraries make no garbage as they load; the window lets it be collected
    from .controllers.opening import read_shape
    from .tasks.ahead import Ahead

    read = Ahead(read_shape, options.files)  # while the window's libraries load
    from .assembly import Assembly, application  # Qt loads here, after the checks
    from .views.graphics import graphics_problem

    app = application()
    problem = graphics_problem()
    if problem is not None:
        return _fail(problem)
    chosen = {"session": options.session, "size": options.size, "theme": options.theme, "pick": options.pick}
    return Assembly(options.files, options.screenshot, app=app, read=read, **chosen).run()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="add-viewer", description=_DESCRIPTION)
    parser.add_argument("files", metavar="FILE", nargs="*", help=_FILES)
    parser.add_argument("--screenshot", metavar="PNG", type=Path, help="save a picture of the window and end")
    parser.add_argument("--session", metavar="FILE", type=Path, help="open a session that was saved")
    parser.add_argument("--size", metavar="WxH", type=_size, help="size of the window, e.g. 1440x900")
    parser.add_argument("--theme", choices=("system", "light", "dark"), help="colours of the window, for this time")
    parser.add_argument(
        "--pick", metavar="VERTEX", type=int, action="append", default=[], help="pick a vertex of the first shape"
    )
    parser.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    return parser


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.lower().partition("x")
    try:
        size = int(width), int(height)
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected WxH such as 1440x900, but it is {text!r}") from None
    if not all(200 <= each <= 8000 for each in size):
        raise argparse.ArgumentTypeError(f"both sides must be from 200 to 8000, but it is {text}")
    return size


def _fail(problem: str) -> int:
    sys.stderr.write(f"add-viewer: {problem}\n")
    return 2


if __name__ == "__main__":
    raise SystemExit(main())
