"""Where the files are that ship with the project."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from .errors import ShapeFileError


def asset(*parts: str) -> Path:
    """The path of a shipped file, e.g. ``asset("shapes", "dogs_40x6890.npz")``.

    A wheel carries the assets inside the package; a checkout keeps them next to it, with the scripts that made them.

    Raises ShapeFileError if the installation lacks the file.
    """
    package = Path(str(files("add_core")))
    for folder in (package / "assets", package.parent / "assets"):
        path = folder.joinpath(*parts)
        if path.is_file():
            return path
    raise ShapeFileError(f"{'/'.join(parts)} ships with the project, but this installation lacks it. Install it again.")
