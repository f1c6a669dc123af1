"""Pairs of points to learn from: they are what they claim, and so are the wrong ones."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from learning_inputs import made_up, numbered
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ParameterError
from add_core.learning import InputRecipe, TrainingSettings
from add_core.learning.architectures import Architecture, build
from add_core.learning.objective import Objective, mirror_channels, negative_pairs
from add_core.learning.pairs import Batch, PairSampler


def test_pairs_are_the_same_place_on_both_shapes_whatever_its_number():
    one, two = numbered(np.random.default_rng(0).permutation(40)), numbered(np.arange(5, 45))
    batch = PairSampler([one, two], pairs=32, seed=1).batch(7)
    assert_array_equal(batch.one, batch.two)
    assert_array_equal(batch.one[:, 0, 0], batch.places)
    assert batch.places.min() >= 5
    assert batch.places.max() < 40


def test_mirror_images_are_named_and_neighbours_drawn_together():
    symmetry = np.arange(40) ^ 1
    sampler = PairSampler([numbered(np.arange(40)), numbered(np.arange(40))], pairs=32, seed=0, symmetry=symmetry)
    batch = sampler.batch(0)
    assert_array_equal(batch.mirror, symmetry[batch.places])
    clusters = batch.places[:30].reshape(6, 5)  # places lie along a line, in their order
    assert np.abs(clusters - clusters[:, :1]).max() <= 16
    assert len(np.unique(clusters[:, 0])) > 2


def test_neighbours_are_shared_places_even_where_few_are_shared():
    one, two = numbered(np.arange(400)), numbered(np.where(np.arange(400) % 20, -1, np.arange(400)))
    batch = PairSampler([one, two], pairs=40, seed=0).batch(0)
    assert (batch.places % 20 == 0).all()
    assert len(np.unique(batch.places)) > 12


def test_a_reflected_shape_swaps_places_and_channels():
    values = np.arange(24.0).reshape(4, 3, 2)
    shape = made_up(values, [0, 1, 2, -1]).reflected(np.array([1, 0, 2]), np.array([0, 2, 1]))
    assert shape.places.tolist() == [1, 0, 2, -1]
    assert_array_equal(shape.inputs(np.array([2, 0])), values[[2, 0]][:, [0, 2, 1]])


def test_vertices_without_a_counterpart_are_never_drawn():
    places = np.where(np.arange(30) % 3, -1, np.arange(30))
    batch = PairSampler([numbered(places), numbered(np.arange(30))], pairs=64, seed=0).batch(0)
    assert (batch.places % 3 == 0).all()


def test_a_step_is_the_same_batch_whatever_came_before():
    shapes = [numbered(np.arange(30))] * 3
    first, second = (PairSampler(shapes, pairs=16, seed=5) for _ in range(2))
    for step in range(4):
        first.batch(step)
    assert_array_equal(first.batch(9).places, second.batch(9).places)
    assert not np.array_equal(first.batch(9).places, first.batch(10).places)


def test_negatives_are_random_and_the_hardest_and_never_the_place_itself():
    places = torch.from_numpy(np.random.default_rng(0).integers(0, 12, 16))
    distances = torch.rand(16, 16, generator=torch.Generator().manual_seed(0))
    row, column = negative_pairs(places, distances, hard=True)
    assert (places[row] != places[column]).all()
    assert_array_equal(column[-16:], distances.masked_fill(places[:, None] == places, 9).argmin(1))
    assert len(negative_pairs(places, distances, hard=False)[0]) == len(row) - 16


def test_a_point_in_the_mirror_is_wrong_unless_it_is_its_own_image():
    """Two channels that mirrors exchange, and a network that reads one of them: only places 0 and 1 have another."""
    network = build(Architecture("first", "SC FC1", channels=2, splines=1, bias=False))
    with torch.no_grad():
        next(network.parameters()).copy_(torch.tensor([[1.0, 0.0]]))
    values = np.array([[0.0, 0.5], [3.0, 2.0], [5.0, 5.0]], np.float32)[:, :, None]
    batch = Batch(values, values, places=np.arange(3), mirror=np.array([1, 0, 2]))
    settings = TrainingSettings(noise=0.0)
    there, back = (Objective(settings, order).loss(network, batch, 0).item() for order in (np.array([1, 0]), None))
    firsts, images = values[:, 0, 0], values[:, 1, 0]
    squares = (firsts[:, None] - firsts) ** 2
    wrong = (firsts[:, None] - images) ** 2
    wrong[[0, 1, 2], [1, 0, 2]] = np.inf  # the image of 1 is 0, and 2 lies on the plane
    forth = np.log(np.exp(-squares).sum(1) + np.exp(-wrong).sum(1)).mean()
    plain = np.log(np.exp(-squares).sum(1)).mean()
    assert_allclose([there, back], [0.5 * (forth + plain), plain], rtol=1e-5)


@pytest.mark.parametrize(
    ("recipe", "sees_sides"),
    [
        (InputRecipe(angles=4), True),
        (InputRecipe(angles=4, isotropic=True), False),
        (InputRecipe(alphas=(0.0,), angles=4), False),
        (InputRecipe(alphas=(50.0,), angles=2), False),  # 0 and 90 degrees are their own mirror images
    ],
)
def test_only_inputs_with_sides_are_looked_at_in_a_mirror(recipe, sees_sides):
    """Where the mirror changes nothing, a point would be told from itself."""
    found = mirror_channels(recipe, np.arange(4))
    assert (found is not None) == sees_sides
    assert mirror_channels(recipe, None) is None


@pytest.mark.parametrize("repeated", [True, False])
def test_channels_that_are_one_and_the_same_have_one_noise(repeated):
    """A network that takes the difference of two such channels sees nothing of either."""
    network = build(Architecture("difference", "SC FC1", channels=2, splines=3, bias=False))
    with torch.no_grad():
        next(network.parameters()).copy_(torch.tensor([[1.0, 1.0, 1.0, -1.0, -1.0, -1.0]]))
    values = np.repeat(np.random.default_rng(0).normal(size=(6, 1, 3)), 2, axis=1).astype(np.float32)
    batch = Batch(values, values, places=np.arange(6), mirror=np.full(6, -1))
    loss = Objective(TrainingSettings(noise=1.0), repeated=repeated).loss(network, batch, 0).item()
    blind = np.log(6.0)  # all six look alike
    assert (abs(loss - blind) < 1e-5) == repeated


def test_a_vertex_without_an_exact_counterpart_is_paired_with_the_nearest_on_the_body():
    line = np.column_stack([np.arange(60.0), np.zeros(60), np.zeros(60)])
    even, odd = numbered(np.arange(0, 60, 2)), numbered(np.arange(1, 60, 2))
    batch = PairSampler([even, odd], pairs=40, seed=0, positions=line).batch(3)
    assert_array_equal(np.abs(batch.one[:, 0, 0] - batch.two[:, 0, 0]), 1.0)
    assert_array_equal(batch.two[:, 0, 0], batch.places)
    clusters = batch.one[:, 0, 0].reshape(8, 5)
    assert np.abs(clusters - clusters[:, :1]).max() <= 32
    assert len(np.unique(clusters[:, 0])) > 2


def test_exact_counterparts_stay_exact_and_wrong_points_are_near_them():
    line = np.column_stack([np.arange(3000.0), np.zeros(3000), np.zeros(3000)])
    batch = PairSampler([numbered(np.arange(3000))] * 2, pairs=40, seed=0, positions=line).batch(1)
    assert_array_equal(batch.one, batch.two)
    assert batch.wrong.shape == (20, 1, 1)
    assert_array_equal(batch.wrong[:, 0, 0], batch.wrong_places)
    gaps = np.abs(batch.wrong_places[:, None] - batch.places[None, :]).min(axis=1)
    assert gaps.max() <= 8
    assert len(np.unique(batch.wrong_places)) > 5


def test_places_that_the_body_does_not_have_are_not_drawn():
    line = np.column_stack([np.arange(30.0), np.zeros(30), np.zeros(30)])
    batch = PairSampler([numbered(np.arange(60))] * 2, pairs=64, seed=0, positions=line).batch(0)
    assert batch.places.max() < 30
    assert batch.wrong_places.max() < 30
    with pytest.raises(ParameterError, match="positions must have a row for some place of 'made up'"):
        PairSampler([numbered(np.arange(40, 60))] * 2, pairs=8, seed=0, positions=line)


@pytest.mark.parametrize("loss", ["soft-nearest", "siamese"])
def test_points_around_the_true_one_raise_the_loss_where_they_are_confused_with_it(loss):
    network = torch.nn.Identity()
    network.logits = lambda inputs: inputs[:, 0]
    settings = TrainingSettings(loss=loss, noise=0.0)
    points = np.arange(4, dtype=np.float32)[:, None, None] * 30
    apart = Batch(points, points, np.arange(4), np.full(4, -1))

    def with_wrong(at, place):
        wrong = np.full((1, 1, 1), at, dtype=np.float32)
        return float(Objective(settings).loss(network, replace(apart, wrong=wrong, wrong_places=np.array([place])), 0))

    mirrored = Objective(settings, np.arange(1))
    wrong = {"wrong": np.full((1, 1, 1), 30.1, dtype=np.float32), "wrong_places": np.array([9])}
    sided = replace(apart, mirror=np.arange(4)[::-1].copy())
    assert float(mirrored.loss(network, replace(sided, **wrong), 0)) > float(mirrored.loss(network, sided, 0))
    without = float(Objective(settings).loss(network, apart, 0))
    assert with_wrong(30.1, 9) > without + 0.05
    assert with_wrong(30.1, 1) == pytest.approx(without, abs=1e-6)
    assert with_wrong(1e3, 9) == pytest.approx(without, abs=0.6 if loss == "siamese" else 1e-6)
