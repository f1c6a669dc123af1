"""The three protocols against brute force, and against what perfect and constant descriptors must score."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ParameterError
from add_core.evaluation import SurfacePoints, cmc, match_errors, princeton, princeton_curve, right_side, roc
from add_core.evaluation import blocks as blocks_module
from add_core.geometry import geodesic_distances
from add_core.geometry.shapes import rectangle, sphere

QUERIES, TARGETS, WIDTH = 23, 31, 4


@pytest.fixture(params=["distinct", "full of ties", "wide"])
def case(request):
    """Random descriptors; on a grid of three values most distances are tied; wide ones go through matrix products."""
    random = np.random.default_rng(4)
    width = 90 if request.param == "wide" else WIDTH
    queries, targets = random.normal(size=(QUERIES, width)), random.normal(size=(TARGETS, width))
    if request.param == "full of ties":
        queries, targets = random.integers(0, 3, (QUERIES, width)), random.integers(0, 3, (TARGETS, width))
    truth = random.integers(0, TARGETS, QUERIES)
    symmetry = np.arange(TARGETS)
    symmetry[:28] = symmetry[:28].reshape(-1, 2)[:, ::-1].ravel()
    return queries, targets, truth, symmetry


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch):
    """Blocks of three queries, so that every test crosses their borders."""
    monkeypatch.setattr(blocks_module, "BLOCK", 3 * TARGETS)


def table(queries, targets):
    return ((queries[:, None, :] - targets[None, :, :]) ** 2).sum(axis=2)


def rounded(queries, targets):
    return np.round(table(queries, targets), 9)


@pytest.mark.parametrize("symmetric", [False, True])
def test_cmc_is_the_mean_over_random_orders_of_ties(case, symmetric):
    """Every point's chance to be hit within rank k, counted over all places that its ties could take."""
    queries, targets, truth, symmetry = case
    curve = cmc(queries, targets, truth, symmetry=symmetry if symmetric else None, ranks=TARGETS)
    distances = rounded(queries, targets)
    random = np.random.default_rng(0)
    orders = 400 if len(np.unique(distances)) < distances.size else 1
    hits = np.zeros(TARGETS)
    for _ in range(orders):
        shuffled = random.permutation(TARGETS)
        for row, true in zip(distances, truth, strict=True):
            ranked = shuffled[np.argsort(row[shuffled], kind="stable")]
            wanted = [true, symmetry[true]] if symmetric else [true]
            hits[np.isin(ranked, wanted).argmax() :] += 1
    assert_allclose(curve.y, hits / (orders * QUERIES), atol=0.02 if orders > 1 else 1e-15)
    assert_array_equal(curve.x, np.arange(1, TARGETS + 1))
    assert curve.headline == curve.y[0] == curve.at(1)


@pytest.mark.parametrize("symmetric", [False, True])
def test_roc_equals_counting_pairs(case, symmetric):
    queries, targets, truth, symmetry = case
    curve = roc(queries, targets, truth, symmetry=symmetry if symmetric else None)
    distances = rounded(queries, targets)
    row = np.arange(QUERIES)
    positive = distances[row, truth]
    if symmetric:
        positive = np.minimum(positive, distances[row, symmetry[truth]])
    is_negative = np.ones(distances.shape, dtype=bool)
    is_negative[row, truth] = False
    negative = distances[is_negative]
    wins = (positive[:, None] < negative).sum() + 0.5 * (positive[:, None] == negative).sum()
    assert curve.auc == pytest.approx(wins / (len(positive) * len(negative)), rel=1e-13)
    for threshold in np.unique(positive):
        on_curve = (negative <= threshold).mean(), (positive <= threshold).mean()
        assert np.min(np.abs(curve.x - on_curve[0]) + np.abs(curve.y - on_curve[1])) < 1e-15


@pytest.mark.parametrize("symmetric", [False, True])
def test_princeton_equals_counting_matches(case, symmetric):
    queries, targets, truth, symmetry = case
    random = np.random.default_rng(5)
    geodesics = random.uniform(0, 1, (TARGETS, TARGETS))
    geodesics = np.where(np.eye(TARGETS, dtype=bool), 0.0, geodesics + geodesics.T)
    curve = princeton(queries, targets, truth, symmetry=symmetry if symmetric else None, distances=geodesics, area=4.0)
    distances = rounded(queries, targets)
    expected = np.zeros(len(curve.x))
    for row, true in zip(distances, truth, strict=True):
        ties = np.flatnonzero(row == row.min())
        error = geodesics[true, ties] if not symmetric else geodesics[[true, symmetry[true]]][:, ties].min(axis=0)
        expected += (error[:, None] / 2.0 <= curve.x).mean(axis=0)
    assert_allclose(curve.y, expected / QUERIES, rtol=1e-13, atol=1e-15)
    assert_allclose(curve.x, np.linspace(0, 0.3, 101))


def test_a_perfect_descriptor_scores_one():
    mesh = sphere(2)
    truth = np.random.default_rng(0).permutation(mesh.vertex_count)
    queries, targets = mesh.vertices[truth], mesh.vertices
    assert_array_equal(cmc(queries, targets, truth).y, 1.0)
    assert roc(queries, targets, truth).auc == 1.0
    assert princeton(queries, targets, truth, shape=mesh).headline == 1.0
    assert princeton(queries, targets, truth, shape=mesh).mean_error == 0.0
    assert right_side(queries, targets, truth, symmetry=mirrored(mesh)).share == 1.0


@pytest.mark.parametrize("width", [1, 16, 200])
@pytest.mark.parametrize("value", [0.0, 0.1, -3e7, 1e-200])
def test_a_constant_descriptor_scores_chance(width, value):
    mesh = rectangle(1.0, 1.0, n=7)
    n = mesh.vertex_count
    flat = np.full((n, width), value)
    assert_allclose(cmc(flat, flat, np.arange(n)).y, np.arange(1, n + 1)[:100] / n, rtol=1e-14)
    assert roc(flat, flat, np.arange(n)).auc == 0.5
    geodesics = geodesic_distances(mesh, np.arange(n))
    curve = princeton(flat, flat, np.arange(n), distances=geodesics, area=1.0)
    assert_allclose(curve.y, [(geodesics <= radius).mean() for radius in curve.x], rtol=1e-12)
    assert right_side(flat, flat, np.arange(n), symmetry=np.roll(np.arange(n), n // 2)).share == 0.5


def test_symmetric_is_never_below_asymmetric(case):
    queries, targets, truth, symmetry = case
    shape = rectangle(1.0, 1.0, n=6)
    geodesics = np.pad(geodesic_distances(shape, np.arange(TARGETS))[:, :TARGETS], 0)
    one = cmc(queries, targets, truth)
    assert (cmc(queries, targets, truth, symmetry=symmetry).y >= one.y - 1e-15).all()
    asymmetric, symmetric = roc(queries, targets, truth), roc(queries, targets, truth, symmetry=symmetry)
    grid = np.linspace(0, 1, 50)
    assert symmetric.auc >= asymmetric.auc
    assert (np.interp(grid, symmetric.x, symmetric.y) >= np.interp(grid, asymmetric.x, asymmetric.y) - 1e-12).all()
    near = princeton(queries, targets, truth, distances=geodesics, area=1.0)
    assert (princeton(queries, targets, truth, distances=geodesics, area=1.0, symmetry=symmetry).y >= near.y).all()


def test_scores_do_not_depend_on_the_unit_of_a_descriptor(case):
    queries, targets, truth, _ = case
    for unit in (2.0**-600, 2.0**500):
        assert_array_equal(cmc(unit * queries, unit * targets, truth).y, cmc(queries, targets, truth).y)
        assert roc(unit * queries, unit * targets, truth).auc == roc(queries, targets, truth).auc


def test_points_without_truth_are_left_out(case):
    queries, targets, truth, symmetry = case
    known = np.arange(QUERIES) % 3 > 0
    partial = np.where(known, truth, -1)
    assert_array_equal(cmc(queries, targets, partial).y, cmc(queries[known], targets, truth[known]).y)
    assert roc(queries, targets, partial).auc == roc(queries[known], targets, truth[known]).auc
    field = right_side(queries, targets, partial, symmetry=symmetry).field
    assert np.isnan(field[~known]).all()


def test_truth_inside_a_face_is_measured_from_where_it_lies():
    """On a flat sheet the distance from a vertex to a point inside a face is a straight line."""
    sheet = rectangle(1.0, 1.0, n=5)
    weights = np.random.default_rng(1).dirichlet(np.ones(3), len(sheet.faces))
    truth = SurfacePoints(sheet.faces, weights)
    places = np.einsum("fj,fjk->fk", weights, sheet.vertices[sheet.faces])
    matches = np.random.default_rng(2).integers(0, sheet.vertex_count, len(sheet.faces))
    straight = np.linalg.norm(places - sheet.vertices[matches], axis=1)
    table_of_all = np.linalg.norm(sheet.vertices[:, None] - sheet.vertices[None], axis=2)
    assert_allclose(match_errors(matches, truth, distances=table_of_all, area=4.0), straight / 2, atol=1e-12)


def test_errors_make_the_same_curve_as_descriptors():
    mesh = sphere(2)
    random = np.random.default_rng(3)
    queries, targets = random.normal(size=(50, 3)), random.normal(size=(mesh.vertex_count, 3))
    truth = random.integers(0, mesh.vertex_count, 50)
    direct = princeton(queries, targets, truth, shape=mesh)
    nearest = table(queries, targets).argmin(axis=1)
    curve = princeton_curve(match_errors(nearest, truth, shape=mesh))
    assert_array_equal(curve.y, direct.y)
    assert curve.mean_error == pytest.approx(direct.mean_error, rel=1e-12)


def test_equally_near_matches_of_a_large_shape_are_drawn_fairly():
    """More ties than are looked at: the draw must still give chance, not the first vertex."""
    mesh = sphere(3)
    n = mesh.vertex_count
    flat = np.zeros((n, 2))
    curve = princeton(flat, flat, np.arange(n), shape=mesh)
    area_within = 0.5 * (1 - np.cos(np.minimum(curve.x * np.sqrt(4 * np.pi), np.pi)))
    assert_allclose(curve.y, area_within, atol=0.015)


def test_the_field_of_sides_is_a_half_where_nothing_tells_them_apart():
    targets = np.array([[0.0], [1.0], [0.5]])
    result = right_side([[0.1], [0.9], [0.5], [0.5]], targets, [0, 0, 0, 2], symmetry=[1, 0, 2])
    assert_array_equal(result.field, [1.0, 0.0, 0.5, np.nan])
    assert result.share == 0.5


def mirrored(mesh):
    """The vertex that mirrors each vertex of a sphere in x."""
    return table(mesh.vertices * [-1, 1, 1], mesh.vertices).argmin(axis=1)


BAD = [
    ({"queries": [[np.nan, 0.0]] * 3}, "queries must be finite, but 3 of 3 rows are not (first: 0)"),
    ({"targets": [[0.0], [1.0]]}, "targets must have 2 numbers a point like the others, but it has 1"),
    ({"truth": [0, 1, 2]}, "truth must be from -1 to 1, but it ranges from 0 to 2"),
    ({"truth": [0.0, 1.0, 1.0]}, "truth must hold integers, but it holds float64"),
    ({"truth": [0, 1]}, r"truth must have shape (3,), but it has (2,)"),
    ({"truth": [-1, -1, -1]}, "truth must be known for at least one point, but it is -1 for all of them"),
    ({"symmetry": [1, 0, 2]}, r"symmetry must have shape (2,), but it has (3,)"),
    ({"targets": [[0.0, 1.0]], "truth": [0, 0, 0]}, "targets must hold at least two points to tell apart"),
]


@pytest.mark.parametrize("protocol", [cmc, roc, princeton])
@pytest.mark.parametrize(("change", "message"), BAD)
def test_bad_arguments_are_named(protocol, change, message):
    arguments = {"queries": [[0.0, 1.0]] * 3, "targets": [[0.0, 1.0], [1.0, 0.0]], "truth": [0, 1, 0]} | change
    with pytest.raises(ParameterError, match=re.escape(message)):
        protocol(**arguments)


def test_princeton_says_what_it_measures_with():
    arguments = {"queries": np.eye(2), "targets": np.eye(2), "truth": [0, 1]}
    with pytest.raises(ParameterError, match="area must be given along with distances"):
        princeton(**arguments, distances=np.zeros((2, 2)))
    with pytest.raises(ParameterError, match="distances must be given, or the target as shape"):
        princeton(**arguments, area=1.0)
    with pytest.raises(ParameterError, match=r"distances must have shape \(2, 2\), but it has \(3, 3\)"):
        princeton(**arguments, area=1.0, distances=np.zeros((3, 3)))


def test_left_and_right_need_a_symmetry_and_errors_need_lengths():
    points = np.random.default_rng(0).normal(size=(5, 3))
    with pytest.raises(ParameterError, match=r"symmetry must be the \(n,\) mirror image of each target point"):
        right_side(points, points, np.arange(5), symmetry=None)
    for table in (np.full((5, 5), np.nan), -np.ones((5, 5))):
        with pytest.raises(ParameterError, match="distances must be lengths, inf between components, but some are"):
            princeton(points, points, np.arange(5), distances=table, area=1.0)
