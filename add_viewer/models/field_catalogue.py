"""Every field that can be drawn, grouped, with a sentence of help, and found by words."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .descriptor_names import descriptor_name
from .fields import FieldChoice
from .searching import fold
from .session import SessionState

GROUPS = ("Heat", "Distance", "Symmetry", "Spectrum", "Signatures", "Geometry", "From file", "Transfer")


@dataclass(frozen=True)
class FieldEntry:
    """One line of the list.

    choice : what choosing it draws. controls : which controls matter for it, of "alpha", "theta", "time", "model",
        "saturation", "index", "matching". words : further words that find it.
    """

    group: str
    title: str
    help: str
    choice: FieldChoice
    controls: frozenset[str] = frozenset()
    words: str = ""


_HEAT = frozenset({"model", "alpha", "theta", "time"})
_OPERATOR = frozenset({"model", "alpha", "theta"})
_MATCH = frozenset({"matching"})

_FIXED = (
    FieldEntry(
        "Heat",
        "Heat kernel",
        "Where unit heat lies after time t, running along θ as much as α says.",
        FieldChoice("heat"),
        _HEAT,
        "diffusion anisotropic isotropic live h",
    ),
    FieldEntry(
        "Heat",
        "Rose of directions",
        "Heat in four directions at once, each in the hue of its θ.",
        FieldChoice("rose"),
        _HEAT - {"theta"},
        "angles figure 3 hues several",
    ),
    FieldEntry(
        "Heat",
        "Wave kernel",
        "A band of frequencies around 1/t instead of heat's low ones.",
        FieldChoice("kernel", name="wave"),
        _HEAT,
        "band pass filter",
    ),
    FieldEntry(
        "Heat",
        "Mexican-hat kernel",
        "The rim of the spreading heat: λt · exp(−λt).",
        FieldChoice("kernel", name="mexican-hat"),
        _HEAT,
        "band pass filter wavelet",
    ),
    FieldEntry("Heat", "Bare skin", "The shape alone, for looking at its form.", FieldChoice("skin"), words="none"),
    FieldEntry(
        "Symmetry",
        "Heat by θ and −θ",
        "θ at a point and −θ at its mirror image give mirrored kernels.",
        FieldChoice("rose", name="mirror"),
        _HEAT,
        "reflection mirror pair",
    ),
    FieldEntry(
        "Spectrum",
        "Eigenfunction",
        "A vibration of the surface: the anisotropic Laplacian's eigenfunction of that number.",
        FieldChoice("eigenfunction"),
        _OPERATOR | {"index"},
        "laplacian harmonic mode phi",
    ),
    FieldEntry(
        "Geometry",
        "Maximum curvature",
        "The normal curvature of greatest size; θ is measured from its direction.",
        FieldChoice("curvature", name="max"),
        words="principal bend",
    ),
    FieldEntry(
        "Geometry",
        "Minimum curvature",
        "The normal curvature across the direction of the greatest.",
        FieldChoice("curvature", name="min"),
        words="principal bend",
    ),
    FieldEntry(
        "Geometry",
        "Mean curvature",
        "Half the sum of both: how far the surface bulges.",
        FieldChoice("curvature", name="mean"),
    ),
    FieldEntry(
        "Geometry",
        "Gaussian curvature",
        "Their product: positive on caps, negative on saddles, 0 where it unrolls.",
        FieldChoice("curvature", name="gaussian"),
    ),
    FieldEntry(
        "Geometry",
        "Trust in the directions",
        "Where the principal directions are sure, and where neighbours lend them.",
        FieldChoice("curvature", name="confidence"),
        words="confidence umbilic flat",
    ),
    FieldEntry(
        "Transfer",
        "Place colours",
        "Every place of the source has a colour; they land where the matching says.",
        FieldChoice("transfer"),
        _MATCH,
        "correspondence colour figure 9 10 map",
    ),
    FieldEntry(
        "Transfer",
        "Carried heat",
        "The source's heat kernel, as the matching carries it to the others.",
        FieldChoice("transfer", name="heat"),
        _MATCH | _HEAT,
        "correspondence field",
    ),
    FieldEntry(
        "Transfer",
        "Error of the matching",
        "How far along the surface each point is matched from its true place.",
        FieldChoice("error"),
        _MATCH,
        "geodesic truth quality princeton",
    ),
)


def catalogue(state: SessionState, descriptors: tuple[str, ...]) -> tuple[FieldEntry, ...]:
    """The entries for the open shapes and the names of the descriptor store, in the order of the groups."""
    entries = [*_FIXED]
    for name in descriptors:
        entries += _of_descriptor(name)
    for name in dict.fromkeys(name for shape in state.shapes for name in shape.fields):
        choice = FieldChoice("file", name=name, index=0)
        controls = frozenset({"index"}) if _is_wide(state, name) else frozenset()
        entries.append(FieldEntry("From file", name, "A quantity that the shape's own file holds.", choice, controls))
    return tuple(sorted(entries, key=lambda entry: GROUPS.index(entry.group)))


def _of_descriptor(name: str) -> list[FieldEntry]:
    known = descriptor_name(name)
    return [
        FieldEntry(
            "Distance",
            f"Distance in {known.title}",
            f"How unlike the picked point every point is. {known.help}",
            FieldChoice("distance", name),
            frozenset({"saturation"}),
            "descriptor figure 6 similarity map nearest",
        ),
        FieldEntry(
            "Symmetry",
            f"Left from right in {known.title}",
            f"Where points can be told from their mirror image. {known.help}",
            FieldChoice("ambiguity", name),
            words="ambiguity mirror reflection",
        ),
        FieldEntry(
            "Signatures",
            f"{known.title}, one number",
            f"A single number of the descriptor at every point. {known.help}",
            FieldChoice("signature", name, index=0),
            frozenset({"index"}),
            "component signature",
        ),
    ]


def _is_wide(state: SessionState, name: str) -> bool:
    return any(name in shape.fields and shape.fields[name].ndim == 2 for shape in state.shapes)


def found_by(entries: tuple[FieldEntry, ...], text: str) -> tuple[FieldEntry, ...]:
    """The entries in which every word of `text` begins a word, or is in the title; those with all in the title first.

    Greek letters may be written out.
    """
    wanted = fold(text).split()

    def fits(entry: FieldEntry) -> bool:
        title = fold(entry.title)
        words = fold(f"{title} {entry.group} {entry.help} {entry.words}").split()
        return all(word in title or any(each.startswith(word) for each in words) for word in wanted)

    hits = [entry for entry in entries if fits(entry)]
    return tuple(sorted(hits, key=lambda entry: not all(word in fold(entry.title) for word in wanted)))


def entry_of(entries: tuple[FieldEntry, ...], choice: FieldChoice) -> FieldEntry:
    """The entry that a choice belongs to, with the choice as it is; one made for it if the list has none."""
    for entry in entries:
        one = entry.choice
        if (one.kind, one.name) == (choice.kind, choice.name) and (
            one.kind not in ("distance", "ambiguity", "signature") or one.descriptor == choice.descriptor
        ):
            return replace(entry, choice=choice)
    if choice.kind in ("distance", "ambiguity", "signature"):
        made = next(entry for entry in _of_descriptor(choice.descriptor) if entry.choice.kind == choice.kind)
        return replace(made, choice=choice)
    group = "From file" if choice.kind == "file" else "Heat"
    return FieldEntry(group, choice.name or choice.kind.capitalize(), "", choice)
