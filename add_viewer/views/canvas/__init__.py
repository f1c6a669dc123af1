"""The 3-D view: the only part of the app that knows PyVista and VTK."""

from .canvas import Canvas

__all__ = ["Canvas"]
