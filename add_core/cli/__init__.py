"""`add-core`: the core on the command line, one module a command."""

from .application import main

__all__ = ["main"]
