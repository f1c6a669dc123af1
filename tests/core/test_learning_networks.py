"""Layers, networks and losses against formulas, finite differences and the signatures that they contain."""

import numpy as np
import pytest
import torch
from numpy.testing import assert_allclose

from add_core.descriptors import geometry_vectors, heat_kernel_signature, spline_reach, wave_kernel_signature
from add_core.descriptors.splines import splines_at
from add_core.errors import ParameterError
from add_core.geometry.shapes import ellipsoid
from add_core.learning import (
    ASF,
    FC,
    SC,
    Network,
    ReLU,
    Softmax,
    build_network,
    multinomial_loss,
    siamese_loss,
    soft_nearest_loss,
)
from add_core.learning.architectures import SPECIFICATIONS, Architecture
from add_core.learning.losses import squared_distances
from add_core.spectra import compute_spectra


@pytest.fixture(autouse=True)
def _one_thread():
    torch.set_num_threads(1)


@pytest.fixture(scope="module")
def family():
    mesh = ellipsoid(1.0, 0.8, 0.6, subdivisions=3)
    return compute_spectra(mesh, alphas=(0.0, 20.0), angles=2, count=60, workers=1, cache=False)


def random(*shape, seed=0):
    return torch.randn(*shape, dtype=torch.float64, generator=torch.Generator().manual_seed(seed))


def hand_set(family, transfer, count):
    """Spline coefficients of transfer functions: least squares at the eigenvalues of one channel."""
    reach = spline_reach([family])[0]
    eigenvalues = family.eigenvalues[0]
    splines = splines_at(eigenvalues, count=count, reach=reach)
    inside = eigenvalues <= reach
    coefficients = np.linalg.lstsq(splines[inside], transfer(eigenvalues[inside]), rcond=None)[0]
    left_out = family.eigenfunctions[0][:, ~inside] ** 2 @ transfer(eigenvalues[~inside])
    return coefficients.T, left_out


def filtered(family, coefficients):
    layer = ASF(coefficients.shape[1], len(coefficients), bias=False).double()
    with torch.no_grad():
        layer.weight.copy_(torch.from_numpy(coefficients))
        vectors = geometry_vectors(family, count=coefficients.shape[1], normalize=False)
        return layer(torch.from_numpy(vectors)).numpy()[:, 0]


def test_low_pass_filters_make_the_heat_kernel_signature(family):
    times = np.array([0.05, 0.2, 1.0])
    coefficients, left_out = hand_set(family, lambda lam: np.exp(-np.outer(lam, times)), 60)
    signature = heat_kernel_signature(family[0], times)
    assert_allclose(filtered(family, coefficients) + left_out, signature, rtol=1e-8)


def test_band_pass_filters_make_the_wave_kernel_signature(family):
    energies, width = np.array([1.5, 2.5, 3.0]), 0.4
    lam = family.eigenvalues[0]

    def band(values):
        response = np.exp(-((energies - np.log(np.maximum(values, 1e-300))[:, None]) ** 2) / (2 * width**2))
        return response / np.exp(-((energies - np.log(lam[1:])[:, None]) ** 2) / (2 * width**2)).sum(axis=0)

    coefficients, left_out = hand_set(family, band, 60)
    signature = wave_kernel_signature(family[0], energies, width=width)
    assert_allclose(filtered(family, coefficients) + left_out, signature, rtol=1e-6, atol=1e-9)


def test_filters_are_shared_by_all_channels():
    layer, x = ASF(5, 7).double(), random(3, 4, 5)
    assert_allclose(layer(x)[:, 2].detach(), (x[:, 2] @ layer.weight.T).detach(), atol=1e-12)


def test_stacking_keeps_channels_together():
    x = torch.arange(24.0).reshape(2, 3, 4)
    assert SC()(x).tolist() == [list(range(12)), list(range(12, 24))]


def test_softmax_gives_probabilities_even_of_large_numbers():
    probabilities = Softmax()(torch.tensor([[1000.0, 1000.0, -1000.0]]))
    assert_allclose(probabilities, [[0.5, 0.5, 0.0]])


@pytest.mark.parametrize("layer", [ASF(4, 3), torch.nn.Sequential(SC(), FC(8, 3)), ReLU(), SC(), Softmax()])
def test_gradients_of_layers_match_finite_differences(layer):
    x = random(3, 2, 4).requires_grad_()
    assert torch.autograd.gradcheck(layer.double(), (x,))


def test_gradients_of_losses_match_finite_differences():
    positive, negative = random(6).abs().requires_grad_(), (random(5, seed=1).abs() * 20).requires_grad_()
    assert torch.autograd.gradcheck(siamese_loss, (positive, negative))
    logits, truth = random(4, 6).requires_grad_(), torch.tensor([0, 5, 2, 2])
    assert torch.autograd.gradcheck(lambda x: multinomial_loss(x, truth), (logits,))
    excluded = torch.zeros(4, 4, dtype=torch.bool)
    one, two = random(4, 3).requires_grad_(), random(4, 3, seed=2).requires_grad_()
    assert torch.autograd.gradcheck(lambda a, b: soft_nearest_loss(squared_distances(a, b), excluded), (one, two))


def test_gradients_of_a_whole_network_match_finite_differences():
    network = Network(Architecture("small", "ASF3 ReLU ASF3 ReLU SC FC4 ReLU FC2", channels=2, splines=4)).double()
    x = random(3, 2, 4)
    for parameter in network.parameters():  # away from the corners of ReLU, where biases of 0 put dead points
        parameter.data += 0.3 * random(*parameter.shape, seed=4)
    names, values = zip(*network.named_parameters(), strict=True)

    def loss(*parameters):
        return torch.func.functional_call(network, dict(zip(names, parameters, strict=True)), (x,)).square().sum()

    assert torch.autograd.gradcheck(loss, tuple(value.detach().requires_grad_() for value in values))


def test_siamese_loss_is_equation_21():
    """γ = 0.25, μ = 2: positives at distances 1 and 3, negatives at 0.5 and 5, of which only the near one costs."""
    loss = siamese_loss(torch.tensor([1.0, 9.0]), torch.tensor([0.25, 25.0]), margin=2.0, balance=0.25)
    assert_allclose(loss, 0.75 * 5.0 + 0.25 * (1.5**2) / 2)


def test_a_collapsed_negative_pair_gives_no_nan():
    distances = torch.zeros(3, requires_grad=True)
    siamese_loss(torch.zeros(1), distances).backward()
    assert torch.isfinite(distances.grad).all()


def test_multinomial_loss_is_equation_22():
    probabilities = torch.tensor([[0.7, 0.2, 0.1], [0.1, 0.1, 0.8]])
    loss = multinomial_loss(torch.log(probabilities) + 3.0, torch.tensor([0, 1]))
    assert_allclose(loss, -(np.log(0.7) + np.log(0.1)) / 2, rtol=1e-6)


def test_soft_nearest_loss_leaves_out_what_is_excluded():
    distances = torch.tensor([[0.0, 1.0, 9.0], [4.0, 0.0, 9.0], [9.0, 9.0, 0.0]])
    excluded = torch.tensor([[False, True, False], [True, False, False], [False, False, False]])
    row = np.log(1 + np.exp(-9.0))
    assert_allclose(soft_nearest_loss(distances, excluded), (2 * row + np.log(1 + 2 * np.exp(-9.0))) / 3, rtol=1e-3)


@pytest.mark.parametrize("name", SPECIFICATIONS)
def test_networks_have_the_papers_layers(name):
    network = build_network(name, angles=4, splines=20, reference_size=30)
    channels = 9 if name.startswith("m") else 4
    kinds = [type(layer).__name__ for layer in network.layers]
    words = SPECIFICATIONS[name].split()
    assert kinds == [word.rstrip("0123456789").removesuffix("reference") for word in words]
    outputs = network(torch.zeros(2, channels, 20))
    assert outputs.shape == (2, 30 if name == "mADD4" else 16)
    widths = [layer.weight.shape[0] for layer in network.layers if hasattr(layer, "weight")]
    named = [int(word.strip("ASFC")) for word in words if word.strip("ASFC").isdigit()]
    assert widths[: len(named)] == named


def test_a_seed_gives_the_same_network_and_leaves_torch_alone():
    before = torch.random.get_rng_state()
    one, two, other = (build_network("ADD2", angles=2, splines=8, seed=seed) for seed in (3, 3, 4))
    assert torch.equal(before, torch.random.get_rng_state())
    assert torch.equal(one.layers[0].weight, two.layers[0].weight)
    assert not torch.equal(one.layers[0].weight, other.layers[0].weight)


def test_permuted_points_give_permuted_descriptors():
    network = build_network("mADD3", angles=2, splines=8).double()
    x, order = random(10, 5, 8), torch.randperm(10, generator=torch.Generator().manual_seed(0))
    assert_allclose(network(x)[order].detach(), network(x[order]).detach(), atol=1e-12)


def test_softmax_networks_know_their_logits():
    network = build_network("mADD4", angles=1, splines=4, reference_size=5)
    x = torch.ones(2, 3, 4)
    assert network.is_classifier
    assert_allclose(torch.softmax(network.logits(x), 1).detach(), network(x).detach(), rtol=1e-5)


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"name": "ADD9"}, "name must be one of ADD1"),
        ({"name": "ADD3", "angles": 0}, "angles must be from 1"),
        ({"name": "ADD3", "splines": 0}, "splines must be from 1"),
        ({"name": "ADD3", "alphas": ()}, "alphas must hold at least one"),
        ({"name": "ADD3", "alphas": (-1.0,)}, "alphas must be finite and at least 0, but it is -1"),
        ({"name": "ADD3", "alphas": "fifty"}, "alphas must hold real numbers, but it holds a str"),
        ({"name": "ADD3", "seed": "x"}, "seed must be a whole number"),
        ({"name": "ADD3", "layers": "SC FC0"}, "outputs must be from 1"),
        ({"name": "ADD3", "layers": 5}, "layers must be a str"),
        ({"name": ["ADD3"]}, "name must be one of ADD1"),
    ],
)
def test_networks_that_cannot_be_are_explained(arguments, complaint):
    with pytest.raises(ParameterError, match=complaint):
        build_network(**arguments)


@pytest.mark.parametrize(
    ("layers", "complaint"),
    [
        ("SC ASF4 FC2", "ASF comes before SC"),
        ("FC2", "ASF comes before SC"),
        ("SC ReLU", "has none"),
        ("SC Conv3 FC2", "one is 'Conv3'"),
    ],
)
def test_layers_in_an_impossible_order_are_explained(layers, complaint):
    with pytest.raises(ParameterError, match=complaint):
        Network(Architecture("mine", layers, channels=2, splines=3))


def test_inputs_that_are_no_tensor_of_the_weights_kind_are_explained():
    network = build_network("ADD1", angles=4, splines=8)
    with pytest.raises(ParameterError, match="inputs must be a Tensor, but it is a ndarray"):
        network(np.zeros((2, 4, 8)))
    with pytest.raises(
        ParameterError, match=r"inputs must be torch\.float32 like the weights, but they are torch\.float64"
    ):
        network(torch.zeros(2, 4, 8, dtype=torch.float64))


def test_inputs_of_another_recipe_are_explained():
    with pytest.raises(ParameterError, match=r"must have shape \(B, 4, 8\).*\(2, 4, 9\)"):
        build_network("ADD1", angles=4, splines=8)(torch.zeros(2, 4, 9))
