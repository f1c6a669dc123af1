"""Receiver operator characteristic: do true pairs lie nearer than all others?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, IntArray, read_only
from .blocks import checked_descriptors, distance_blocks
from .truth import SurfacePoints, Truth


@dataclass(frozen=True, eq=False)
class ReceiverOperator:
    """Share y of true pairs and share x of false pairs that a threshold on the distance accepts, for every threshold.

    x, y : (p,), ascending from 0 to 1; straight in between. symmetric : whether the mirror image counts as true.
    """

    x: FloatArray
    y: FloatArray
    symmetric: bool

    @property
    def auc(self) -> float:
        """Area under the curve: how often a true pair lies nearer than a false one, ties counting half."""
        return float(np.trapezoid(self.y, self.x))

    @property
    def headline(self) -> float:
        """The area under the curve."""
        return self.auc


def roc(
    queries: ArrayLike,
    targets: ArrayLike,
    truth: ArrayLike | SurfacePoints,
    *,
    symmetry: ArrayLike | None = None,
) -> ReceiverOperator:
    """Receiver operator characteristic of descriptors, over all q·n pairs of points.

    queries (q, d), targets (n, d), truth (q,), symmetry (n,) : as for `cmc`. Positives are the true pairs; in the
        symmetric setting each counts with the smaller of its distances to the true vertex and to that vertex's mirror
        image. Negatives are, in both settings, all pairs but the true ones.

    The curve holds every threshold at which a positive is accepted, so its area is exact; ties become straight lines.
    Raises ParameterError if arrays do not fit together or a descriptor is not finite.
    """
    one, two = checked_descriptors(queries, targets)
    known = Truth.of(truth, symmetry, queries=len(one), targets=len(two))
    positives = np.empty(len(known.rows))
    for block, distances in distance_blocks(one, two, known.rows):
        row = np.arange(len(block))
        positives[block] = np.minimum(distances[row, known.vertex[block]], distances[row, known.mirror[block]])
    thresholds, accepted = np.unique(positives, return_counts=True)
    below = np.zeros(2 * len(thresholds) + 1, dtype=np.int64)
    for block, distances in distance_blocks(one, two, known.rows):
        distances[np.arange(len(block)), known.vertex[block]] = np.inf  # the positive itself
        below += _places(distances, thresholds)
    below[-1] -= len(known.rows)
    false = np.cumsum(below)  # at 2j: negatives nearer than threshold j; at 2j + 1: those at it too
    true = np.repeat(np.concatenate([[0], np.cumsum(accepted)]), 2)[1:]
    x = np.concatenate([[0.0], false / false[-1]])
    y = np.concatenate([[0.0], true / true[-1]])
    return ReceiverOperator(read_only(x), read_only(y), symmetry is not None)


def _places(distances: FloatArray, thresholds: FloatArray) -> IntArray:
    """(2p + 1,): how many distances lie before, at, between and after the p thresholds."""
    flat = distances.ravel()
    place = np.searchsorted(thresholds, flat)
    at = np.concatenate([thresholds, [-1.0]])[place] == flat
    return np.bincount(2 * place + at, minlength=2 * len(thresholds) + 1).astype(np.int64)
