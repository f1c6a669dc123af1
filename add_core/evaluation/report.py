"""Scores written down: a table, CSV, JSON, the paper's three-panel figure, and one HTML page with all of them."""

from __future__ import annotations

import base64
import csv
import html
import io
import json
from collections.abc import Sequence
from pathlib import Path

from ..errors import ParameterError
from .figures import panels
from .scores import Scores

ORDER = ("CMC@1", "CMC@10", "CMC@50", "AUC", "mean error", "P(right side)")


def columns(scores: Sequence[Scores]) -> list[str]:
    """Names of all numbers that any of the scores has, protocol by protocol, asymmetric (the harder) first."""
    names = {name for score in scores for name in score.numbers}
    return sorted(names, key=lambda name: (next((k for k, head in enumerate(ORDER) if name.startswith(head)), 9), name))


def table(scores: Sequence[Scores]) -> str:
    """A table for a terminal, one line a method."""
    names = columns(scores)
    rows = [["method", *names]] + [[score.method, *(_number(score, name) for name in names)] for score in scores]
    widths = [max(len(row[k]) for row in rows) for k in range(len(names) + 1)]
    return "\n".join(
        "  ".join(
            cell.ljust(width) if k == 0 else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        for row in rows
    )


def save_report(
    scores: Sequence[Scores], folder: Path, *, title: str, command: str = "", notes: Sequence[str] = ()
) -> None:
    """Write scores.csv, scores.json, curves.csv, curves.svg and index.html into `folder`, which is made if need be.

    title : heading and first line of the figure. command : the command that makes the report again. notes : sentences
        on how it was measured. Raises ParameterError if there are no scores or the folder cannot be made, or as
        `panels` does.
    """
    if not scores:
        raise ParameterError("scores must hold at least one method, but it is empty.")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _write_tables(scores, folder, title=title, command=command, notes=notes)
    except OSError as error:
        raise ParameterError(f"the report cannot be written to {folder}: {error.strerror or error}.") from None


def _write_tables(scores: Sequence[Scores], folder: Path, *, title: str, command: str, notes: Sequence[str]) -> None:
    names = columns(scores)
    with (folder / "scores.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["method", "pairs", *names])
        writer.writerows(
            [s.method, s.pairs, *(f"{s.numbers[n]:.6g}" if n in s.numbers else "" for n in names)] for s in scores
        )
    with (folder / "curves.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["method", "protocol", "setting", "x", "y"])
        for score in scores:
            for curve in score.curves:
                writer.writerows(
                    [score.method, curve.protocol, curve.setting, f"{x:.6g}", f"{y:.6g}"]
                    for x, y in zip(curve.x, curve.y, strict=True)
                )
    facts = {
        "title": title,
        "command": command,
        "notes": list(notes),
        "methods": [{"method": s.method, "pairs": s.pairs, **s.numbers} for s in scores],
    }
    (folder / "scores.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    figure = panels(scores, title=title)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    (folder / "curves.svg").write_bytes(buffer.getvalue())
    page = html_page(scores, buffer.getvalue(), title=title, command=command, notes=notes)
    (folder / "index.html").write_text(page, encoding="utf-8")


def html_page(scores: Sequence[Scores], figure: bytes, *, title: str, command: str, notes: Sequence[str]) -> str:
    """One page that needs no other file: the table and an SVG `figure`."""
    names = columns(scores)
    head = "".join(f"<th>{html.escape(name)}</th>" for name in ["method", *names])
    body = "".join(
        f"<tr><td>{html.escape(s.method)}</td>" + "".join(f"<td>{_number(s, name)}</td>" for name in names) + "</tr>"
        for s in scores
    )
    picture = base64.b64encode(figure).decode("ascii")
    said = "".join(f"<p>{html.escape(note)}</p>" for note in notes)
    made = f"<p>Made by <code>{html.escape(command)}</code></p>" if command else ""
    style = (
        "body{font:15px/1.5 system-ui,sans-serif;max-width:75rem;margin:2rem auto;padding:0 1rem}"
        "table{border-collapse:collapse}th,td{padding:.3rem .6rem;text-align:right;border-bottom:1px solid #ccc}"
        "th:first-child,td:first-child{text-align:left}img{max-width:100%}"
    )
    top = f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{html.escape(title)}</title>'
    return (
        f"{top}<style>{style}</style><h1>{html.escape(title)}</h1>{said}{made}"
        f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        f'<p><img alt="Curves of all protocols" src="data:image/svg+xml;base64,{picture}"></p></html>\n'
    )


def _number(score: Scores, name: str) -> str:
    return f"{score.numbers[name]:.3f}" if name in score.numbers else "–"
