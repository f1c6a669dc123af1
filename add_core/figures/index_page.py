"""One page with every figure of a folder: what it is, how it was made, and how it differs from the paper's."""

from __future__ import annotations

import html
from collections.abc import Iterable, Mapping

from .gallery import FIGURES
from .record import Entry

FILE = "index.html"

_STYLE = """
:root{color-scheme:light}
body{font:15px/1.55 system-ui,sans-serif;color:#22252a;background:#fff}
body{max-width:72rem;margin:2.5rem auto;padding:0 1.5rem}
h1{font-size:1.7rem;font-weight:600;margin:0 0 .5rem}
h2{font-size:1.1rem;font-weight:600;margin:3.5rem 0 .75rem}
p{max-width:52rem;margin:.5rem 0}
figure{margin:0}
figure img,figure object{width:100%;height:auto;border:1px solid #eceded;border-radius:6px}
figcaption{max-width:52rem;margin-top:.6rem}
.quiet{color:#6b7078}.note{color:#8a4b00}
table{border-collapse:collapse;margin:1.5rem 0;width:100%}
th,td{text-align:left;vertical-align:top;padding:.5rem .75rem .5rem 0;border-bottom:1px solid #e4e5e8}
th{font-weight:600}td:first-child{white-space:nowrap}
a{color:#1f63b0}code{background:#f3f3f4;padding:.1rem .3rem;border-radius:3px}
"""


def index_page(entries: Iterable[Entry], *, undrawn: Mapping[int, str] | None = None) -> str:
    """HTML that shows the figures of `entries` from files beside it. undrawn : why figures are not there, by number."""
    made = {entry.number: entry for entry in entries}
    parts = [
        '<!doctype html><html lang="en"><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>Figures of Anisotropic Diffusion Descriptors</title><style>{_STYLE}</style>",
        "<h1>Anisotropic Diffusion Descriptors: the figures, drawn anew</h1>",
        "<p>Each figure of Boscaini, Masci, Rodolà, Bronstein and Cremers (Eurographics 2016), computed and drawn by "
        "this program from the shapes that ship with it: synthetic people with exact correspondence.</p>",
        "<table><thead><tr><th>Figure</th><th>What it shows</th><th>How it differs from the paper's</th></tr></thead>",
        "<tbody>",
    ]
    for figure in FIGURES:
        name = f"Figure {figure.number}"
        link = f'<a href="#{figure.stem}">{name}</a>' if figure.number in made else f"{name} <i>(not drawn)</i>"
        reason = "" if figure.number in made else (undrawn or {}).get(figure.number, "")
        cells = (link, html.escape(figure.shows), html.escape(f"Not drawn: {reason}." if reason else figure.difference))
        parts.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    parts.append("</tbody></table>")
    parts += [_section(made[figure.number], figure.stem, figure.shows) for figure in FIGURES if figure.number in made]
    return "\n".join([*parts, "</html>", ""])


def _section(entry: Entry, stem: str, shows: str) -> str:
    picture, tables = entry.files[0], entry.files[1:]
    if picture.endswith(".pdf"):
        shown = f'<p><a href="{picture}">{picture}</a></p>'
    else:
        shown = f'<a href="{picture}"><img src="{picture}" alt="{html.escape(shows)}" loading="lazy"></a>'
    notes = "".join(f"<p class=note>Left out: {html.escape(line)}</p>" for line in entry.missing)
    numbers = "".join(f' · <a href="{name}">{name}</a>' for name in tables)
    return (
        f'<h2 id="{stem}">Figure {entry.number}. {html.escape(shows)}</h2><figure>{shown}'
        f"<figcaption>{html.escape(entry.caption)}</figcaption></figure>{notes}"
        f"<p class=quiet><code>{html.escape(entry.command)}</code> · {entry.seconds:.0f} s{numbers}</p>"
    )
