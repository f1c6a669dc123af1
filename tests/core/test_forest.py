"""The random forest finds points that it can, and says in which shares it doubts the others."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.correspondence import CorrespondenceForest
from add_core.errors import ParameterError
from add_core.geometry.shapes import sphere

PLACES = sphere(2).vertices
N = len(PLACES)


def test_a_forest_finds_points_by_noisy_descriptors():
    pytest.importorskip("sklearn", reason="the extra `forest` is not installed")
    random = np.random.default_rng(0)
    shapes = [PLACES + 0.01 * random.normal(size=PLACES.shape) for _ in range(8)]
    forest = CorrespondenceForest.train(shapes, [np.arange(N)] * 8, PLACES, trees=20)
    unseen = PLACES + 0.01 * random.normal(size=PLACES.shape)
    assert (forest.matches(unseen) == np.arange(N)).mean() > 0.9
    soft = forest.soft_matches(unseen)
    assert soft.shape == (N, N)
    assert_allclose(soft.sum(axis=1), 1.0, rtol=1e-12)
    assert soft.nnz < 0.3 * N * N


def test_what_descriptors_cannot_tell_apart_is_shared_between_both():
    pytest.importorskip("sklearn", reason="the extra `forest` is not installed")
    blind = np.abs(PLACES) @ np.diag([1.0, 2.0, 3.0])
    forest = CorrespondenceForest.train([blind] * 4, [np.arange(N)] * 4, PLACES, trees=10, least=1)
    mirror = np.array([np.abs(PLACES - place * [-1, 1, 1]).sum(axis=1).argmin() for place in PLACES])
    soft = forest.soft_matches(blind).toarray()
    row = np.arange(N)
    assert_allclose(soft[row, row], soft[row, mirror], atol=0.15)


def test_labels_must_fit():
    pytest.importorskip("sklearn", reason="the extra `forest` is not installed")
    with pytest.raises(ParameterError, match="labels must be given for 1 shapes"):
        CorrespondenceForest.train([PLACES], [], PLACES)
    with pytest.raises(ParameterError, match=r"labels must have shape \(162,\), but it has \(2,\)"):
        CorrespondenceForest.train([PLACES], [[0, 1]], PLACES)


def test_a_missing_library_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "sklearn.ensemble", None)
    with pytest.raises(ParameterError, match="Random forests need scikit-learn"):
        CorrespondenceForest.train([PLACES], [np.arange(N)], PLACES)
