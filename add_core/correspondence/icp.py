"""Iterative closest points among eigenfunctions: a functional map made orthogonal."""

from __future__ import annotations

import numpy as np

from .._check import count_in, instance_of
from .functional_map import FunctionalMap


def icp(start: FunctionalMap, *, iterations: int = 10) -> FunctionalMap:
    """Alternate between points and an orthogonal map of the same size (Ovsjanikov et al. 2012, section 6.2).

    Each step matches points by the map, takes the map of these matches, and replaces it by the nearest one with
    orthonormal columns or rows: isometries have such maps. It ends early where the matches no longer change.
    start : the map to begin with; the result has its size. iterations : steps at most.
    Raises ParameterError if `iterations` is out of range.
    """
    instance_of("start", start, FunctionalMap)
    found = start
    k2, k1 = start.map_12.shape
    for _ in range(count_in("iterations", iterations, 1, 100_000)):
        step = FunctionalMap.from_matches(found.spectrum_1, found.spectrum_2, found.match_21, count=(k1, k2))
        left, _, right = np.linalg.svd(step.map_12, full_matrices=False)
        refined = FunctionalMap(left @ right, found.spectrum_1, found.spectrum_2)
        if np.array_equal(refined.match_21, found.match_21):
            return refined
        found = refined
    return found
