"""What a step of undo did, in words that follow "Undo:" and "Redo:"."""

from __future__ import annotations

from .field_catalogue import catalogue, entry_of
from .fields import FieldChoice
from .picks import Pick
from .session import Step
from .shapes import OpenShape

_DIFFUSION = {"alpha": "change α", "theta": "turn θ", "reach": "change t", "conductivity": "change the conductivity"}
_LAYOUTS = {"grid": "views in a grid", "strip": "views in one row", "single": "the source alone"}
_LOOKS = {"wireframe": "wireframe of", "point_size": "point size of"}
_ALWAYS = {
    "move": "reorder the shapes",
    "match": "change the matching",
    "saturate": "change the saturation",
    "clear": "clear the picks",
    "restore": "open a session",
}
"""Words of the kinds that need no look at what has changed."""


def words_of(step: Step) -> str:
    """What the person did: "pick vertex 12", "hide Person 2"."""
    kind, _, details = step.kind.partition(" ")
    if kind in _ALWAYS:
        return _ALWAYS[kind]
    if kind == "diffuse":
        return next(words for name, words in _DIFFUSION.items() if name in details.split())
    return _WORDS[kind](step, details)


def _of_opening(step: Step, _details: str) -> str:
    return f"open {_newest(step.after.shapes, step.before.shapes)}"


def _of_closing(step: Step, _details: str) -> str:
    return f"close {_newest(step.before.shapes, step.after.shapes)}"


def _of_symmetry(step: Step, _details: str) -> str:
    return f"mirror map of {_newest(step.after.shapes, step.before.shapes)}"


def _newest(shapes: tuple[OpenShape, ...], others: tuple[OpenShape, ...]) -> str:
    names = (shape.name for shape in reversed(shapes) if not any(shape is other for other in others))
    return next(names, "a shape")


def _of_source(step: Step, _details: str) -> str:
    return f"go to {_name(step, step.after.active_key)}"


def _of_look(step: Step, details: str) -> str:
    key, _, what = details.rpartition(" ")
    words = ("show" if step.after.look(key).visible else "hide") if what == "visible" else _LOOKS[what]
    return f"{words} {_name(step, key)}"


def _name(step: Step, key: str | None) -> str:
    shape = step.after.shape(key or "")
    return "a shape" if shape is None else shape.name


def _of_pick(step: Step, _details: str) -> str:
    return f"pick vertex {_picked(step.after.picks, step.before.picks)}"


def _of_unpick(step: Step, _details: str) -> str:
    return f"remove vertex {_picked(step.before.picks, step.after.picks)}"


def _picked(picks: tuple[Pick, ...], others: tuple[Pick, ...]) -> int:
    """The vertex of a pick that only the first have; of a pair, the picked one, not its mirror image."""
    return min([pick for pick in picks if pick not in others] or picks, key=lambda pick: pick.is_mirror).vertex


def _of_field(step: Step, _details: str) -> str:
    old, new = step.before.field, step.after.field
    if old != new and old.with_changes(index=new.index) == new:
        return f"another number of {_title(step, new)}"
    return f"show {_title(step, new)}"


def _of_comparison(step: Step, _details: str) -> str:
    second = step.after.compare
    return "leave the second field" if second is None else f"show {_title(step, second)} beside"


def _title(step: Step, choice: FieldChoice) -> str:
    return entry_of(catalogue(step.after, ()), choice).title


def _of_arrangement(step: Step, _details: str) -> str:
    old, new = step.before.arrangement, step.after.arrangement
    if old.layout != new.layout:
        return _LAYOUTS[new.layout]
    if old.linked != new.linked:
        return "link the cameras" if new.linked else "free the cameras"
    return "one range of colours" if new.common_range else "colour ranges of their own"


_WORDS = {
    "open": _of_opening,
    "close": _of_closing,
    "symmetry": _of_symmetry,
    "show": _of_source,
    "look": _of_look,
    "pick": _of_pick,
    "unpick": _of_unpick,
    "field": _of_field,
    "scene": _of_field,
    "compare": _of_comparison,
    "arrange": _of_arrangement,
}
