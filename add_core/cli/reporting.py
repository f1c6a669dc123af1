"""How a command says how far it is and what came out: for a person on a terminal, or as JSON lines for a machine."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import click

Advance = Callable[[int, int], None]


def result(values: dict[str, Any], *, as_json: bool) -> None:
    """Print named results: one JSON object on a line, or a line each."""
    if as_json:
        click.echo(json.dumps({"event": "result"} | {name.replace(" ", "_"): value for name, value in values.items()}))
        return
    width = max(map(len, values))
    for name, value in values.items():
        click.echo(f"{name:<{width}}  {value}")


@contextmanager
def progress(title: str, *, as_json: bool) -> Iterator[Advance]:
    """A bar on a terminal, or a JSON line for each step, on stderr; call what it yields with (done, total)."""
    if as_json:
        yield lambda done, total: click.echo(
            json.dumps({"event": "progress", "done": done, "total": total, "label": title}), err=True
        )
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(title)
        yield lambda done, total: bar.update(task, completed=done, total=total)
