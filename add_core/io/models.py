"""Which trained models ship with the project, told without loading torch."""

from __future__ import annotations

from .._assets import asset
from ..errors import ShapeFileError


def shipped_models() -> tuple[str, ...]:
    """Names that `add_core.learning.load_model` knows, in alphabetical order."""
    try:
        folder = asset("models", "README.md").parent
    except ShapeFileError:
        return ()
    return tuple(sorted(path.stem for path in folder.glob("*.safetensors")))
