"""`python -m add_core.cli`, where the entry point is not installed."""

from .application import main

main()
