"""Optimal spectral descriptors of Litman and Bronstein 2014: the best linear ones, in closed form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import torch
from scipy.linalg import eigh

from .._check import FloatArray, IntArray, count_in, positive
from ..errors import ParameterError
from .architectures import Architecture, build
from .inputs import FLOOR, InputRecipe, Moments
from .layers import FC
from .model import Model
from .pairs import PairSampler
from .training_set import PreparedShape

BATCHES, PAIRS = 200, 512


def optimal_coefficients(
    positives: FloatArray, negatives: FloatArray, *, outputs: int, ridge: float = 1e-6
) -> FloatArray:
    """A (outputs, M) of f = A g that spreads wrong pairs most while it keeps true pairs together.

    positives, negatives : (P, M) and (R, M), differences of the geometry vectors of pairs. The rows of A are the
    generalised eigenvectors of Σ₋ a = μ Σ₊ a with the greatest μ, scaled so that A Σ₊ Aᵀ = I: true pairs then differ
    alike in all of the outputs.

    ridge : added to Σ₊, as a share of its mean eigenvalue, so that splines on which all pairs agree do not divide by 0.
    Raises ParameterError if there are more outputs than splines, or true pairs do not differ at all.
    """
    width = positives.shape[1]
    count_in("outputs", outputs, 1, width)
    within, between = (pairs.T @ pairs / len(pairs) for pairs in (positives, negatives))
    mean = float(np.trace(within)) / width
    if not mean > 0:
        raise ParameterError("positives must differ for a trade-off to learn, but all differences are zero.")
    within = within + positive("ridge", ridge) * mean * np.eye(width)
    vectors = eigh(between, within, subset_by_index=(width - outputs, width - 1))[1]
    return np.ascontiguousarray(vectors[:, ::-1].T)


def linear_recipe(recipe: InputRecipe) -> InputRecipe:
    """The recipe that this method takes, of as many eigenpairs and splines."""
    return replace(recipe, alphas=(0.0,), angles=1, logarithm=False)


def linear_part(shape: PreparedShape) -> PreparedShape:
    """Inputs (n, 1, M) by `linear_recipe` of a shape prepared with logarithms, α = 0 being the first channel."""
    values = np.exp(np.asarray(shape.values[:, :1], dtype=np.float32)) - np.float32(FLOOR)
    return replace(shape, values=values, moments=Moments.of(values, shape.mass))


def optimal_spectral_descriptor(
    shapes: Sequence[PreparedShape],
    recipe: InputRecipe,
    *,
    outputs: int = 16,
    symmetry: IntArray | None = None,
    seed: int = 0,
) -> Model:
    """The descriptor learned from prepared shapes, as a model of one linear layer.

    shapes : prepared with `recipe`, which must be linear (logarithm=False) and have one channel: α = 0 for the
        original method.
    symmetry : (P,), the place that mirrors each place: mirror images are among the negatives, though no isotropic
        descriptor can tell them apart.
    """
    if recipe.logarithm or recipe.channels != 1:
        raise ParameterError(
            f"recipe must be linear with one channel, but logarithm is {recipe.logarithm} "
            f"and there are {recipe.channels} channels."
        )
    width = recipe.splines
    plain = Moments(np.zeros((1, width), np.float32), np.ones((1, width), np.float32))
    sampler = PairSampler(shapes, pairs=PAIRS, seed=seed, symmetry=symmetry, moments=plain)
    true, wrong = [], []
    for step in range(BATCHES):
        batch = sampler.batch(step)
        one, two = batch.one[:, 0].astype(np.float64), batch.two[:, 0].astype(np.float64)
        other = np.random.default_rng([seed, step, 1]).permutation(len(one))
        different = batch.places != batch.places[other]
        true.append(one - two)
        wrong.append((one - two[other])[different])
    coefficients = optimal_coefficients(np.concatenate(true), np.concatenate(wrong), outputs=outputs)
    network = build(Architecture("OSD", f"SC FC{outputs}", channels=1, splines=width, bias=False))
    (layer,) = (layer for layer in network.layers if isinstance(layer, FC))
    with torch.no_grad():
        layer.weight.copy_(torch.from_numpy(coefficients))
    return Model(network, recipe, plain, "set", {"settings": {"method": "closed form"}, "steps": 0, "history": []})
