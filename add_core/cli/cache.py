"""`add-core cache`: the spectra kept on disk."""

from __future__ import annotations

import json

import click

from ..spectra import SpectraCache
from . import options
from .reporting import result


@click.group("cache")
def command() -> None:
    """The spectra kept on disk: list them, or make room.

    Nothing is lost by clearing: spectra are computed anew when they are asked for.
    """


@command.command("list")
@options.as_json
def list_entries(as_json: bool) -> None:
    """What is kept, the most recently used first."""
    cache = SpectraCache.default()
    entries = cache.entries()
    if as_json:
        for entry in entries:
            click.echo(json.dumps({"label": entry.label, "bytes": entry.size, "used": entry.used}))
        return
    for entry in entries:
        click.echo(f"{entry.size / 1e6:9.1f} MB  {entry.label}")
    total = sum(entry.size for entry in entries)
    click.echo(f"{total / 1e6:9.1f} MB  in all, of {cache.limit / 1e6:.0f} MB allowed, in {cache.folder}")


@command.command("clear")
@options.as_json
def clear(as_json: bool) -> None:
    """Remove everything that is kept."""
    result({"freed bytes": SpectraCache.default().clear()}, as_json=as_json)
