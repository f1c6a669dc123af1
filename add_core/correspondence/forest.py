"""Correspondence learned by a random forest: which points of a reference have such a descriptor?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from .._check import IntArray, count_in, descriptor_array, index_array
from ..errors import ParameterError


class CorrespondenceForest:
    """Random forest from descriptors to the vertices of a reference shape, after Rodolà et al. 2014.

    As there, every leaf keeps the distribution of the reference vertices that reached it in training, and a point's
    soft match is the mean over its leaves. Unlike there, splits minimise the scatter of the reference's positions, not
    the entropy of thousands of labels, which keeps training in seconds and memory small.

    Needs scikit-learn. `soft_matches` (n, N) can be refined by `FunctionalMap.from_matches` or `zoomout`, as Rodolà et
    al. do.
    """

    def __init__(self, forest: Any, leaves: csr_array, offsets: IntArray) -> None:
        self._forest, self._leaves, self._offsets = forest, leaves, offsets

    @classmethod
    def train(
        cls,
        descriptors: Sequence[ArrayLike],
        labels: Sequence[ArrayLike],
        reference: ArrayLike,
        *,
        trees: int = 30,
        least: int = 5,
        seed: int = 0,
    ) -> CorrespondenceForest:
        """Train on shapes whose correspondence to the reference is known.

        descriptors : one (n_i, d) a shape. labels : one (n_i,) a shape, the reference vertex of each point.
        reference : (N, 3) or (N, c), positions of the reference's vertices. trees : how many. least : points in a leaf.
        Raises ParameterError if scikit-learn is not installed or arrays do not fit together.
        """
        try:
            from sklearn.ensemble import RandomForestRegressor
        except ImportError:  # an extra: nothing else needs it
            raise ParameterError(
                "Random forests need scikit-learn, which is not installed. Run: pip install scikit-learn"
            ) from None
        places = descriptor_array("reference", reference)
        parts = [descriptor_array("descriptors", part) for part in descriptors]
        if not parts or len(parts) != len(labels):
            raise ParameterError(f"labels must be given for {len(parts)} shapes (at least 1), not for {len(labels)}.")
        values = np.concatenate([descriptor_array("descriptors", part, width=parts[0].shape[1]) for part in parts])
        label = np.concatenate(
            [index_array("labels", own, len(places), count=len(part)) for own, part in zip(labels, parts, strict=True)]
        )
        forest = RandomForestRegressor(
            count_in("trees", trees, 1, 10_000), min_samples_leaf=count_in("least", least, 1, 10**6),
            max_features=1 / 3, random_state=seed,
        )  # fmt: skip
        forest.fit(values, places[label])
        sizes = np.array([tree.tree_.node_count for tree in forest.estimators_])
        offsets = np.concatenate([[0], np.cumsum(sizes)[:-1]])
        reached = forest.apply(values) + offsets
        shape = (int(sizes.sum()), len(places))
        counts = csr_array((np.ones(reached.size), (reached.ravel(), np.repeat(label, len(sizes)))), shape=shape)
        totals = np.maximum(np.asarray(counts.sum(axis=1)).ravel(), 1.0)
        counts.data /= np.repeat(totals, np.diff(counts.indptr))
        return cls(forest, counts, offsets)

    def soft_matches(self, descriptors: ArrayLike) -> csr_array:
        """Shares (n, N) in which each point belongs to the reference's vertices; rows sum to 1.

        descriptors : (n, d), of the width trained on.
        """
        values = descriptor_array("descriptors", descriptors, width=self._forest.n_features_in_)
        reached = self._forest.apply(values) + self._offsets
        n, trees = reached.shape
        rows = np.repeat(np.arange(n), trees)
        chosen = csr_array((np.full(n * trees, 1.0 / trees), (rows, reached.ravel())), shape=(n, self._leaves.shape[0]))
        return csr_array(chosen @ self._leaves)

    def matches(self, descriptors: ArrayLike) -> IntArray:
        """The reference vertex with the largest share for each point: (n,); descriptors (n, d) as in training."""
        return likeliest(self.soft_matches(descriptors))


def likeliest(soft: csr_array) -> IntArray:
    """The column of the largest entry in each row of soft matches (n, N): (n,)."""
    return np.asarray(soft.argmax(axis=1), dtype=np.int64).ravel()
