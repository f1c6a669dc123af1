"""The learned windowed Fourier descriptor against the transform that it learns with."""

import numpy as np
import pytest
import torch
from numpy.testing import assert_allclose

from add_core.descriptors import windowed_fourier_transform
from add_core.errors import ParameterError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import ellipsoid
from add_core.learning import InputRecipe, TrainingShape
from add_core.learning.windowed_fourier import FourierShape, WindowedFourierNetwork, learn_windowed_fourier
from add_core.spectra import Spectrum

RECIPE = InputRecipe(alphas=(0.0,), angles=1, eigenpairs=24, splines=10)


def lumpy(seed):
    mesh = ellipsoid(1.0, 0.7, 0.5, subdivisions=2)
    lumps = 1 + (0.2 + 0.01 * seed) * np.sin(2 * mesh.vertices[:, 0] + 1) + 0.15 * np.cos(5 * mesh.vertices[:, 1])
    return TriangleMesh(mesh.vertices * lumps[:, None], mesh.faces)


@pytest.fixture(scope="module")
def shape():
    torch.set_num_threads(1)
    return FourierShape.of(lumpy(0), frequencies=20, recipe=RECIPE)


def test_the_transform_is_that_of_the_descriptor(shape):
    network = WindowedFourierNetwork(10, frequencies=20)
    signals = torch.randn(162, 3, generator=torch.Generator().manual_seed(0))
    points = torch.tensor([5, 17, 100])
    window = (shape.splines @ network.window).detach().numpy()
    spectrum = Spectrum(np.arange(20.0), shape.functions.numpy().astype(float), shape.mass.numpy().astype(float))
    expected = windowed_fourier_transform(spectrum, signals.numpy().astype(float), window=window.astype(float))
    assert_allclose(network.transform(signals, shape, points).detach(), expected[points], atol=1e-4)


def test_signs_of_eigenfunctions_do_not_matter(shape):
    network = WindowedFourierNetwork(10, frequencies=20)
    signs = torch.from_numpy(np.random.default_rng(0).choice([-1.0, 1.0], 20).astype(np.float32))
    flipped = FourierShape(shape.vectors, shape.functions * signs, shape.mass, shape.splines)
    assert_allclose(network.describe(flipped), network.describe(shape), atol=1e-4)


def test_the_gradient_of_the_window_matches_finite_differences(shape):
    double = FourierShape(*(getattr(shape, name).double() for name in ("vectors", "functions", "mass", "splines")))
    network = WindowedFourierNetwork(10, frequencies=20, outputs=2).double()
    points = torch.tensor([3, 80])

    def outputs(window):
        return torch.func.functional_call(network, {"window": window}, (double, points))

    assert torch.autograd.gradcheck(outputs, (network.window.detach().clone().requires_grad_(),))


def test_learning_brings_true_pairs_together():
    shapes = [TrainingShape(lumpy(seed), np.arange(162)) for seed in range(2)]
    separations = []
    for steps in (0, 60):
        network = learn_windowed_fourier(shapes, steps=steps, pairs=64, frequencies=20, recipe=RECIPE)
        one, two = (network.describe(FourierShape.of(item.shape, frequencies=20, recipe=RECIPE)) for item in shapes)
        distances = ((one[:, None] - two[None]) ** 2).sum(axis=2)
        separations.append(distances.mean() / np.diag(distances).mean())
    assert separations[1] > 3 * separations[0]


def test_shapes_without_shared_places_are_explained():
    with pytest.raises(ParameterError, match="share at least 192 places, but two of them share 162"):
        learn_windowed_fourier([TrainingShape(lumpy(0), np.arange(162))] * 2, steps=1, recipe=RECIPE)
    with pytest.raises(ParameterError, match="at least two shapes"):
        learn_windowed_fourier([TrainingShape(lumpy(0), np.arange(162))])
