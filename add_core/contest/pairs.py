"""Pairs of test shapes, and how well each method finds the points of one on the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .._check import IntArray
from ..correspondence import nearest_matches, zoomout
from ..evaluation import Scores
from ..evaluation.baselines import UNDIRECTED, functional_map_matches, isotropic, refined_matches
from ..evaluation.samples import Sample
from ..evaluation.scores import PROTOCOLS, descriptor_scores, match_scores
from ..geometry.pair_distances import PairDistances
from ..io import Collection
from .describing import Describer
from .forest import forest_matches

MAPS, FOREST = "fm", "rf"
"""Methods that match without comparing descriptors: functional maps and the random forest."""
REFINED, PLAINLY = "+zoomout", "+zoomout-plain"
"""What a name ends in whose matches are refined: by ZoomOut that the method's own descriptor guides, or AHKS where it
does not tell left from right; or by ZoomOut as published."""


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
        or "+zoomout-plain" after it, which give matches and are judged by the Princeton protocol alone. queries : as
        `descriptor_scores`.
        """
        source, target = self._samples
        name = _unrefined(method)
        if name in (MAPS, FOREST) or name != method:
            matches = self.matches(method)
            return match_scores(method, source, target, matches, distances=self._distances, queries=queries)
        one, two = (self._describer.describe(name, sample) for sample in self._samples)
        return descriptor_scores(
            method, source, target, (one, two), protocols=protocols, distances=self._distances, queries=queries
        )

    def matches(self, method: str) -> IntArray:
        """(q,): the target's point for each of the source's; the source is shape 2 of the map."""
        name = _unrefined(method)
        source, target = self._samples
        families = self._describer.spectra(target), self._describer.spectra(source)
        if name == MAPS:
            found = functional_map_matches(*families)
        elif name == FOREST:
            found = forest_matches(
                self._samples, self._describer.describe("wks", source), len(families[1].eigenvalues[0])
            )
        else:
            found = nearest_matches(self._describer.describe(name, source), self._describer.describe(name, target))
        if method.endswith(PLAINLY):
            return np.asarray(zoomout(isotropic(families[0]), isotropic(families[1]), found).match_21)
        if method.endswith(REFINED):
            guide = "ahks" if name == FOREST or name in UNDIRECTED else name
            guides = self._describer.describe(guide, target), self._describer.describe(guide, source)
            return np.asarray(refined_matches(*families, found, guides=guides).match_21)
        return found


def _unrefined(method: str) -> str:
    return method.removesuffix(PLAINLY).removesuffix(REFINED)
