"""Pictures of shapes without a window: colours that mean something everywhere, in the app and in figures."""

from .position_colours import position_colours

__all__ = ["position_colours"]
