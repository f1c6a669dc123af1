"""Optimal spectral descriptors against the optimum that they claim to be."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.errors import ParameterError
from add_core.geometry.shapes import ellipsoid
from add_core.learning import InputRecipe, TrainingShape
from add_core.learning.optimal_spectral import (
    linear_part,
    linear_recipe,
    optimal_coefficients,
    optimal_spectral_descriptor,
)
from add_core.learning.training_set import prepare

RECIPE = InputRecipe(alphas=(0.0,), angles=1, eigenpairs=30, splines=8, logarithm=False)


def differences(seed, scale, count=4000):
    return np.random.default_rng(seed).normal(size=(count, len(scale))) * scale


def test_the_spline_that_separates_best_comes_first():
    """Independent splines: the ratio of wrong to true variance decides, 4, 100, 1 and 25."""
    true, wrong = differences(0, [1, 0.1, 2, 1]), differences(1, [2, 1, 2, 5])
    coefficients = optimal_coefficients(true, wrong, outputs=3)
    assert np.abs(coefficients).argmax(axis=1).tolist() == [1, 3, 0]


def test_true_pairs_differ_by_one_in_every_output():
    mixing = np.random.default_rng(2).normal(size=(5, 5))
    true, wrong = differences(0, np.ones(5)) @ mixing, differences(1, [1, 2, 3, 4, 5])
    coefficients = optimal_coefficients(true, wrong, outputs=3, ridge=1e-12)
    covariance = coefficients @ (true.T @ true / len(true)) @ coefficients.T
    assert_allclose(covariance, np.eye(3), atol=1e-9)


def test_no_other_direction_separates_better():
    mixing = np.random.default_rng(2).normal(size=(5, 5))
    true, wrong = differences(0, np.ones(5)) @ mixing, differences(1, [1, 2, 3, 4, 5])
    best = optimal_coefficients(true, wrong, outputs=1, ridge=1e-12)[0]

    def separation(a):
        return ((wrong @ a) ** 2).mean() / ((true @ a) ** 2).mean()

    others = np.random.default_rng(3).normal(size=(200, 5))
    assert max(map(separation, others)) <= separation(best) * (1 + 1e-12)
    assert separation(best + 0.05 * others[0]) < separation(best)


def test_the_linear_part_of_inputs_with_logarithms_is_what_the_linear_recipe_makes(tmp_path):
    recipe = replace(RECIPE, alphas=(0.0, 30.0), angles=2, logarithm=True)
    shape = TrainingShape(ellipsoid(1.0, 0.8, 0.6, subdivisions=2), np.arange(162))
    (both,), (linear,) = (
        prepare([shape], each, tmp_path, precision="float32", workers=1) for each in (recipe, linear_recipe(recipe))
    )
    assert_allclose(linear_part(both).values, linear.values, rtol=1e-4, atol=1e-5)
    assert_allclose(linear_part(both).moments.mean, linear.moments.mean, rtol=1e-4)


def test_a_descriptor_learned_from_shapes_describes_them(tmp_path):
    shapes = []
    for seed in range(3):
        mesh = ellipsoid(1.0, 0.7 + 0.01 * seed, 0.5, subdivisions=2)
        shapes.append(TrainingShape(mesh, np.arange(mesh.vertex_count)))
    model = optimal_spectral_descriptor(prepare(shapes, RECIPE, tmp_path, workers=1), RECIPE, outputs=4)
    assert model.describe(shapes[0].shape, workers=1, cache=False).shape == (162, 4)


def test_impossible_requests_are_explained():
    with pytest.raises(ParameterError, match="outputs must be from 1 to 4"):
        optimal_coefficients(np.ones((3, 4)), np.ones((3, 4)), outputs=5)
    with pytest.raises(ParameterError, match="all differences are zero"):
        optimal_coefficients(np.zeros((3, 4)), np.ones((3, 4)), outputs=2)
    with pytest.raises(ParameterError, match="linear with one channel"):
        optimal_spectral_descriptor([], InputRecipe())
