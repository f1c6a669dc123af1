"""Pairs of test shapes, and how well each method finds the points of one on the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .._check import IntArray
from ..correspondence import nearest_matches
from ..evaluation import Scores
from ..evaluation.baselines import functional_map_matches, refined_matches
from ..evaluation.samples import Sample
from ..evaluation.scores import PROTOCOLS, descriptor_scores, match_scores
from ..geometry.pair_distances import PairDistances
from ..io import Collection
from .describing import Describer
from .forest import forest_matches

MAPS, FOREST = "fm", "rf"
"""Methods that match without comparing descriptors: functional maps and the random forest."""
REFINED = "+zoomout"


def chosen_pairs(collection: Collection, pairs: int, seed: int) -> list[tuple[int, int]]:
    """Different ordered pairs of test shapes, drawn at random."""
    test = collection.split("test")
    every = [(int(i), int(j)) for i in test for j in test if i != j]
    order = np.random.default_rng(seed).permutation(len(every))
    return [every[k] for k in order[: min(pairs, len(every))]]


class Pair:
    """The points of a source sample, to be found on a target."""

    def __init__(self, source: Sample, target: Sample, describer: Describer) -> None:
        self._samples, self._describer = (source, target), describer
        self._distances = PairDistances(target.shape)

    def scores(self, method: str, *, protocols: Sequence[str] = PROTOCOLS, queries: int | None = None) -> Scores:
        """How well a method does. method : a descriptor, by `protocols`; "fm", "rf", or any method with "+zoomout"
        after it, which give matches and are judged by the Princeton protocol alone. queries : as `descriptor_scores`.
        """
        source, target = self._samples
        name = method.removesuffix(REFINED)
        if name in (MAPS, FOREST) or name != method:
            matches = self.matches(method)
            return match_scores(method, source, target, matches, distances=self._distances, queries=queries)
        one, two = (self._describer.describe(name, sample) for sample in self._samples)
        return descriptor_scores(
            method, source, target, (one, two), protocols=protocols, distances=self._distances, queries=queries
        )

    def matches(self, method: str) -> IntArray:
        """(q,): the target's point for each of the source's; the source is shape 2 of the map."""
        name = method.removesuffix(REFINED)
        source, target = self._samples
        if name == MAPS:
            found = functional_map_matches(self._describer.spectra(target), self._describer.spectra(source))
        elif name == FOREST:
            count = len(self._describer.spectra(source).eigenvalues[0])
            found = forest_matches(self._samples, self._describer.describe("wks", source), count)
        else:
            found = nearest_matches(self._describer.describe(name, source), self._describer.describe(name, target))
        if name == method:
            return found
        return refined_matches(self._describer.spectra(target), self._describer.spectra(source), found)
