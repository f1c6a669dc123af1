"""The random forest of Rodolà et al. 2014 among the methods: trained on the shipped people, asked about others."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.spatial import KDTree

from .._check import FloatArray, IntArray
from ..correspondence import CorrespondenceForest
from ..evaluation.baselines import describe_with
from ..evaluation.samples import Sample
from ..geometry import normalize
from ..io import humans
from ..spectra import compute_spectra


def forest_matches(samples: tuple[Sample, Sample], descriptors: FloatArray, count: int) -> IntArray:
    """(q,): the point of the second sample that a random forest finds for each point of the first.

    descriptors : (q, d), wave kernel signatures of the first. count : K of those that the forest is trained on.
    """
    label = _forest(count).matches(descriptors)
    target = samples[1]
    return np.asarray(KDTree(target.shape.vertices).query(target.original.vertices)[1], dtype=np.int64)[label]


@cache
def _forest(count: int) -> CorrespondenceForest:
    """Trained on one pose of each of the training people; labels are vertices of the first."""
    collection = humans()
    chosen = [int(index) for index in collection.split("train")[::11]]
    described = []
    for index in chosen:
        family = compute_spectra(normalize(collection[index]), alphas=(0.0,), angles=1, count=count)
        described.append(describe_with("wks", family))
    labels = [np.arange(len(values)) for values in described]
    return CorrespondenceForest.train(described, labels, collection[0].vertices)
