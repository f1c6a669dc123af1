"""Copy as script: the Python lines that compute what is shown, with public names of the core alone."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from add_core import __version__
from add_core.io import shipped_place

from ..models.fields import FieldChoice, FieldKind
from ..models.picks import Pick
from ..models.session import SessionState
from ..models.shapes import OpenShape

Carried = Mapping[str, tuple[Pick, ...]]


@dataclass
class Script:
    """Lines, and the names that they import. shapes : by key, what they are called in the script."""

    state: SessionState
    shapes: dict[str, str]
    lines: list[str] = field(default_factory=list)
    _imports: dict[str, set[str]] = field(default_factory=dict)

    def use(self, module: str, *names: str) -> None:
        """Import `names` from a package of the core."""
        self._imports.setdefault(module, set()).update(names)

    def say(self, *lines: str) -> None:
        """Add lines."""
        self.lines += lines

    @property
    def text(self) -> str:
        """The whole script."""
        imports = [
            f"from {module} import {', '.join(sorted(names))}" for module, names in sorted(self._imports.items())
        ]
        head = [f"# What add-viewer {__version__} showed, computed by add_core alone.", "import numpy as np", ""]
        return "\n".join([*head, *imports, "", *self.lines, ""])


Writer = Callable[[Script, FieldChoice], None]


def script_of(state: SessionState, carried: Carried, writers: Mapping[FieldKind, Writer]) -> str:
    """The script for the shown shapes and fields; "" if no shape is shown.

    carried : by shape, the active shape's picks as the matching carries them. writers : by kind of field.
    """
    shown = state.shown
    if not shown:
        return ""
    script = Script(state, _names(shown))
    script.use("add_core.geometry", "normalize")
    script.use("add_core.io", "save_shape")
    script.say("# Lengths are in geodesic diameters from here on: α and t compare between shapes.", "shapes = {")
    script.say(*(f"    {script.shapes[shape.key]!r}: normalize({_opening(script, shape)})," for shape in shown), "}")
    _say_picks(script, carried)
    script.say("fields = {name: {} for name in shapes}")
    for choice in dict.fromkeys(state.choices):
        script.say("")
        writers[choice.kind](script, choice)
    script.say(
        "",
        "for name, shape in shapes.items():",
        '    save_shape(shape, f"{name}.ply", fields=fields[name])  # opens in ParaView and MeshLab, and here',
    )
    return script.text


def _opening(script: Script, shape: OpenShape) -> str:
    place = None if Path(shape.reference).exists() else shipped_place(shape.reference)
    if place is None:
        script.use("add_core.io", "load_shape")
        return f"load_shape({shape.reference!r})"
    script.use("add_core.io", place.collection.title)
    return f"{place.collection.title}()[{place.index}]"


def _say_picks(script: Script, carried: Carried) -> None:
    """The picked vertices of each shown shape, its own or carried to it."""
    picks = {shape.key: script.state.picks_on(shape.key) or carried.get(shape.key, ()) for shape in script.state.shown}
    if any(picks.values()):
        numbers = (f"{script.shapes[key]!r}: {[pick.vertex for pick in own]}" for key, own in picks.items())
        script.say("picks = {" + ", ".join(numbers) + "}")


def _names(shapes: tuple[OpenShape, ...]) -> dict[str, str]:
    """Short names that are file names too, each once."""
    found: dict[str, str] = {}
    for shape in shapes:
        plain = re.sub(r"[^a-z0-9]+", "-", shape.name.lower()).strip("-") or "shape"
        others = set(found.values())
        numbered = (f"{plain}-{number}" for number in range(2, len(shapes) + 2))
        found[shape.key] = plain if plain not in others else next(each for each in numbered if each not in others)
    return found
