"""`add-core info`: counts, components, boundary, area and defects of shapes."""

from __future__ import annotations

import json

import click

from ..errors import AddError
from ..geometry import ShapeReport, inspect
from .application import MISTAKE, complain
from .shapes import open_shape


@click.command("info")
@click.argument("shapes", metavar="SHAPE...", nargs=-1, required=True)
@click.option("--json", "as_json", is_flag=True, help="One JSON object a line for each shape.")
@click.pass_context
def command(context: click.Context, shapes: tuple[str, ...], as_json: bool) -> None:
    """Counts, components, boundary, area and defects of shapes.

    Lengths are in the unit of the file. Shapes that cannot be opened are named on stderr; the others are still
    reported, and the exit status is 2.
    """
    failed = False
    for name in shapes:
        try:
            report = inspect(open_shape(name))
        except AddError as error:
            complain(error)
            failed = True
            continue
        if as_json:
            click.echo(json.dumps({"file": name, **report.as_dict()}))
        else:
            _print(name, report)
    if failed:
        context.exit(MISTAKE)


def _print(title: str, report: ShapeReport) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(show_header=False, box=None, pad_edge=False)
    for quantity, value in _rows(report):
        table.add_row(Text(quantity, style="dim"), Text(value))
    console = Console(highlight=False)
    console.print(Text(title, style="bold"), soft_wrap=True)
    console.print(table)
    for defect in report.defects:
        console.print(Text(f"! {defect}", style="yellow"), soft_wrap=True)
    if not report.defects:
        console.print(Text("no defects", style="green"))


def _rows(report: ShapeReport) -> list[tuple[str, str]]:
    size = [high - low for low, high in zip(report.lower, report.upper, strict=True)]
    rows = [("kind", report.kind), ("vertices", f"{report.vertices:,}")]
    if report.faces is not None:
        rows += [
            ("faces", f"{report.faces:,}"),
            ("edges", f"{report.edges:,}"),
            ("components", f"{report.components:,}"),
            ("boundary", _boundary(report)),
            ("Euler characteristic", f"{report.euler_characteristic}"),
            ("area", f"{report.area:.6g} (unit of length)²"),
        ]
    if report.volume is not None:
        rows.append(("volume", f"{report.volume:.6g} (unit of length)³"))
    if report.has_normals is not None:
        rows.append(("normals", "given" if report.has_normals else "none"))
    return [*rows, ("box", " × ".join(f"{length:.6g}" for length in size))]


def _boundary(report: ShapeReport) -> str:
    if not report.boundary_edges:
        return "none, the surface is closed" if report.volume is not None else "none"
    loops = "loop" if report.boundary_loops == 1 else "loops"
    return f"{report.boundary_loops:,} {loops}, {report.boundary_edges:,} edges"
