"""Scores of methods over pairs of test shapes, for the figures with curves."""

from __future__ import annotations

from collections.abc import Sequence

from ..contest import Pair, chosen_pairs
from ..evaluation import Scores, averaged
from ..evaluation.samples import sample
from ..io import Collection
from .studio import Studio


def steps(studio: Studio, collection: Collection, methods: Sequence[str]) -> int:
    """Of how many steps `scores` will consist."""
    return len(chosen_pairs(collection, studio.quality.pairs, 0)) * len(methods)


def scores(studio: Studio, collection: Collection, methods: Sequence[str], *, variant: str = "mesh") -> list[Scores]:
    """The mean over the same pairs for each method, in their order."""
    found: dict[str, list[Scores]] = {method: [] for method in methods}
    for numbers in chosen_pairs(collection, studio.quality.pairs, 0):
        source, target = (sample(collection, index, variant) for index in numbers)
        pair = Pair(source, target, studio.describer)
        for method in methods:
            found[method].append(pair.scores(method, queries=studio.quality.queries))
            studio.done()
    return [averaged(found[method]) for method in methods]
