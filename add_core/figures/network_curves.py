"""Figure 8: the networks of the family against each other."""

from __future__ import annotations

from . import matching
from .compared import ARCHITECTURES, Comparison, shipped_comparison, train_all
from .drawn import Drawn, NotDrawn
from .quality_curves import curve_rows, curve_table, drop
from .studio import Studio


def draw(studio: Studio) -> Drawn:
    """ADD1 to mADD3 on one collection: trained now if the studio has a workshop for it, else from a shipped report.

    Raises NotDrawn if there are neither.
    """
    comparison = _trained(studio) if studio.workshop is not None else shipped_comparison()
    if comparison is None:
        raise NotDrawn(
            "trained networks of several architectures do not ship with this installation; "
            "--train MINUTES trains them, so many minutes each"
        )
    found = comparison.of(ARCHITECTURES)
    rows = [(studio.cast.collection.title, found)]
    absent = [name for name in ARCHITECTURES if not comparison.of((name,))]
    missing = (f"{', '.join(absent)}: not in {comparison.source}",) if absent else ()
    caption = (
        f"Performance of the networks, from {comparison.source}, mean over {found[0].pairs} pairs of test shapes. "
        "Solid: a mirror image counts as right; dashed: it does not. All have 16 numbers a point. CMC@1, symmetric → "
        f"asymmetric: {'; '.join(drop(score) for score in found)}."
    )
    return Drawn(curve_rows(rows), caption, missing, {"csv": curve_table(rows)})


def _trained(studio: Studio) -> Comparison:
    assert studio.workshop is not None
    collection, workshop = studio.cast.collection, studio.workshop
    studio.expect(len(ARCHITECTURES) + matching.steps(studio, collection, ARCHITECTURES))
    runs = train_all(studio, workshop.folder, workshop.minutes)
    source = f"{workshop.minutes:g} minutes of training each on {studio.quality.name} inputs"
    return Comparison(tuple(matching.scores(studio, collection, runs)), source)
