"""Matches and functional maps on shapes whose correspondence is known exactly."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.sparse import csr_array
from scipy.spatial.distance import cdist

from add_core.correspondence import (
    FunctionalMap,
    Weights,
    guided_zoomout,
    icp,
    mutual_matches,
    nearest_matches,
    preserved_orientation,
    zoomout,
)
from add_core.correspondence import nearest as nearest_module
from add_core.correspondence.orientation import turning_operator
from add_core.correspondence.own_symmetry import own_symmetry
from add_core.descriptors import wave_kernel_energies, wave_kernel_signature
from add_core.errors import ParameterError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import ellipsoid, rectangle, sphere
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import compute_spectrum


def lopsided(subdivisions=3):
    """An ellipsoid with a bump and a dent: no symmetry, so that only one map is right."""
    ball = sphere(subdivisions).vertices
    bump = (
        1
        + 0.4 * np.exp(-6 * ((ball - [0.6, 0.6, 0.5]) ** 2).sum(axis=1))
        - 0.25 * np.exp(-8 * ((ball - [-0.3, 0.9, -0.3]) ** 2).sum(axis=1))
    )
    return TriangleMesh(ball * bump[:, None] * [1.0, 1.25, 1.6], sphere(subdivisions).faces)


def spectrum_of(mesh, count=60):
    return compute_spectrum(AnisotropicLaplacian(mesh, alpha=0.0), count=count)


@pytest.fixture(scope="module")
def isometry():
    """The same surface twice: turned in space, and its vertices in another order."""
    one = lopsided()
    order = np.random.default_rng(0).permutation(one.vertex_count)  # vertex i of the second was order[i] of the first
    place = np.argsort(order)
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    two = TriangleMesh(one.vertices[order] @ turn.T, place[one.faces])
    return one, two, order, spectrum_of(one), spectrum_of(two)


@pytest.mark.parametrize("width", [1, 3, 20])
@pytest.mark.parametrize("kind", ["distinct", "full of ties", "far from zero"])
def test_nearest_matches_are_those_of_brute_force(width, kind, monkeypatch):
    monkeypatch.setattr(nearest_module, "BLOCK", 250)
    random = np.random.default_rng(width)
    queries, targets = random.normal(size=(80, width)), random.normal(size=(70, width))
    if kind == "full of ties":
        queries, targets = random.integers(0, 2, (80, width)) + 0.5, random.integers(0, 3, (70, width))
    if kind == "far from zero":
        queries, targets = queries + 1e5, targets + 1e5
    assert_array_equal(nearest_matches(queries, targets), cdist(queries, targets, "sqeuclidean").argmin(axis=1))


def test_approximate_matches_of_smooth_descriptors_are_nearly_all_exact():
    """Descriptors of a surface fill few dimensions, however wide they are."""
    mesh = lopsided(4)
    spectrum = spectrum_of(mesh)
    energies = wave_kernel_energies(spectrum, 60)
    wave = np.log(wave_kernel_signature(spectrum, energies.energies, width=energies.width))
    noisy = wave + 1e-4 * np.random.default_rng(0).normal(size=wave.shape)
    exact, approximate = nearest_matches(noisy, wave), nearest_matches(noisy, wave, method="approximate")
    assert (exact == approximate).mean() > 0.98


def test_mutual_matches_agree_both_ways():
    random = np.random.default_rng(3)
    queries, targets = random.normal(size=(60, 12)), random.normal(size=(50, 12))
    pairs = mutual_matches(queries, targets)
    apart = cdist(queries, targets)
    assert_array_equal(apart[pairs.queries].argmin(axis=1), pairs.targets)
    assert_array_equal(apart[:, pairs.targets].argmin(axis=0), pairs.queries)
    assert len(pairs.queries) > 10


def test_the_map_of_an_isometry_is_a_matrix_of_signs(isometry):
    """Eigenfunctions go to eigenfunctions, up to sign."""
    _, _, order, one, two = isometry
    found = FunctionalMap.from_matches(one, two, order, count=40)
    assert_allclose(np.abs(found.map_12), np.eye(40), atol=1e-6)
    assert_array_equal(found.match_21, order)
    assert_array_equal(found.match_12, np.argsort(order))


def test_functions_go_forth_as_points_go_back(isometry):
    _, _, order, one, two = isometry
    found = FunctionalMap.from_matches(one, two, order, count=60)
    smooth = one.eigenfunctions[:, :10] @ np.arange(10.0)
    assert_allclose(found.transfer(smooth), smooth[order], atol=1e-6)
    assert_allclose(found.transfer(np.stack([smooth, 2 * smooth], axis=1))[:, 1], 2 * smooth[order], atol=1e-6)


def test_a_soft_correspondence_of_one_point_each_is_the_hard_one(isometry):
    mesh, _, order, one, two = isometry
    n = mesh.vertex_count
    soft = csr_array((np.ones(n), (np.arange(n), order)), shape=(n, n))
    hard = FunctionalMap.from_matches(one, two, order, count=(20, 30)).map_12
    assert hard.shape == (30, 20)
    assert_allclose(FunctionalMap.from_matches(one, two, soft, count=(20, 30)).map_12, hard, rtol=1e-12)
    assert_allclose(FunctionalMap.from_matches(one, two, soft.toarray(), count=(20, 30)).map_12, hard, rtol=1e-12)


@pytest.mark.parametrize("products", [0.0, 1.0])
@pytest.mark.parametrize("oriented", [False, True])
def test_descriptors_alone_recover_an_isometry_exactly(isometry, products, oriented):
    mesh_1, mesh_2, order, one, two = isometry
    energies = wave_kernel_energies(one, 40)
    waves = [wave_kernel_signature(s, energies.energies, width=energies.width) for s in (one, two)]
    found = FunctionalMap.from_descriptors(
        one, two, *waves, count=30, weights=Weights(products=products), meshes=(mesh_1, mesh_2) if oriented else None
    )
    assert_allclose(np.abs(found.map_12), np.eye(30), atol=2e-3)
    assert_array_equal(found.match_21, order)


def test_icp_and_zoomout_recover_an_isometry_exactly_from_disturbed_matches(isometry):
    """All matches are pushed aside by a quarter of the shape's width, and half of them replaced at random."""
    mesh, _, order, one, two = isometry
    random = np.random.default_rng(5)
    aside = cdist(mesh.vertices[order] + [0.3, 0.0, 0.2], mesh.vertices).argmin(axis=1)
    disturbed = np.where(random.random(len(order)) < 0.5, random.permutation(order), aside)
    start = FunctionalMap.from_matches(one, two, disturbed, count=20)
    assert (start.match_21 == order).mean() < 0.5
    assert_array_equal(icp(start, iterations=30).match_21, order)
    assert_array_equal(zoomout(one, two, disturbed, start=10, stop=60, samples=None).match_21, order)
    assert_array_equal(zoomout(one, two, disturbed, start=10, stop=60, samples=200).match_21, order)
    assert_array_equal(zoomout(one, two, start, stop=60).match_21, order)


def test_a_guide_leads_matches_of_the_wrong_side_back(isometry):
    """An ellipsoid, whose mirror image is as good an isometry: ZoomOut keeps the mirror image that it is given, and
    a faint hint of the right side, drowned in noise at each point, turns the whole map round."""
    ball = ellipsoid(1.0, 1.2, 1.5, subdivisions=3)
    spectrum, same = spectrum_of(ball), np.arange(ball.vertex_count)
    mirror = cdist(ball.vertices * [-1, 1, 1], ball.vertices).argmin(axis=1)
    random = np.random.default_rng(3)
    hints = [ball.vertices * [0.3, 1, 1] + 0.3 * random.normal(size=(642, 3)) for _ in range(2)]
    assert (zoomout(spectrum, spectrum, mirror, stop=50).match_21 == mirror).mean() > 0.95
    found = guided_zoomout(spectrum, spectrum, *hints, initial=mirror, stop=60)
    assert (found.match_21 == same).mean() > 0.95
    assert found.map_12.shape == (60, 60)
    assert_array_equal(guided_zoomout(spectrum, spectrum, *hints, initial=mirror, stop=60).map_12, found.map_12)


def test_descriptors_show_the_symmetry_of_their_own_shape():
    """Alike to the left and to the right, but neither above and below nor in front and behind."""
    ball = ellipsoid(1.0, 1.2, 1.5, subdivisions=3)
    spectrum = spectrum_of(ball)
    mirror = cdist(ball.vertices * [-1, 1, 1], ball.vertices).argmin(axis=1)
    alike = ball.vertices * [0.3, 1, 1] + 0.1 * np.random.default_rng(3).normal(size=(642, 3))
    found = own_symmetry(spectrum, alike, 40)
    assert_allclose(found @ found, np.eye(40), atol=1e-9)
    functions = spectrum.eigenfunctions[:, :40]
    assert (nearest_matches(functions, functions @ found.T) == mirror).mean() > 0.95


def test_a_map_that_grew_the_wrong_way_round_is_turned():
    """Most points look a little more like their mirror images, and few are marked: all matches start on the wrong side
    and a faint guide leaves them there, but the whole map agrees better turned round."""
    ball = ellipsoid(1.0, 1.2, 1.5, subdivisions=3)
    spectrum, x = spectrum_of(ball), ball.vertices[:, 0]
    mirror = cdist(ball.vertices * [-1, 1, 1], ball.vertices).argmin(axis=1)
    one, two = (np.column_stack([sign * 0.2 * x, ball.vertices[:, 1:], 1.5 * (x > 0.8)]) for sign in (1, -1))
    assert (nearest_matches(two, one) == mirror).mean() > 0.7
    found = guided_zoomout(spectrum, spectrum, one, two, weight=0.03, stop=60)
    assert (found.match_21 == np.arange(642)).mean() > 0.95


def test_a_guided_map_needs_no_other_start_than_its_descriptors(isometry):
    mesh, _, order, one, two = isometry
    places = mesh.vertices @ mesh.vertices.T[:, ::40]
    assert_array_equal(guided_zoomout(one, two, places, places[order]).match_21, order)
    assert guided_zoomout(one, two, places, places[order], stop=8).map_12.shape == (8, 8)


def test_icp_returns_orthonormal_columns(isometry):
    _, _, order, one, two = isometry
    start = FunctionalMap.from_matches(one, two, order, count=(20, 30))
    refined = icp(start, iterations=3).map_12
    assert_allclose(refined.T @ refined, np.eye(20), atol=1e-12)


def test_zoomout_leaves_an_exact_map_as_it_is(isometry):
    _, _, _, one, _ = isometry
    same = np.arange(len(one.mass))
    found = zoomout(one, one, same, stop=50)
    assert_allclose(found.map_12, np.eye(50), atol=1e-9)
    assert_array_equal(found.match_21, same)


def test_turning_is_exact_for_linear_functions():
    """f = x, g = y: n · (∇f × ∇g) = 1 on a sheet facing up, −1 with the roles exchanged."""
    sheet = rectangle(2.0, 3.0, n=4)
    x, y, _ = sheet.vertices.T
    assert (turning_operator(sheet, x) @ y).sum() == pytest.approx(6.0)
    assert (turning_operator(sheet, y) @ x).sum() == pytest.approx(-6.0)
    assert_allclose(turning_operator(sheet, x) @ y, sheet.vertex_areas, rtol=1e-12)
    assert_allclose(turning_operator(sheet, x) @ np.ones_like(x), 0.0, atol=1e-14)


def test_orientation_tells_a_map_from_its_mirror_image():
    """On an ellipsoid a mirror is as good an isometry as the identity, but lays every face down inside out."""
    ball = ellipsoid(1.0, 1.2, 1.5, subdivisions=3)
    same = np.arange(ball.vertex_count)
    mirror = cdist(ball.vertices * [-1, 1, 1], ball.vertices).argmin(axis=1)
    assert preserved_orientation(ball, ball, same) == 1.0
    assert preserved_orientation(ball, ball, mirror) < 0.02


@pytest.mark.parametrize("reverses", [False, True])
def test_the_orientation_term_chooses_between_a_shape_and_its_mirror_image(reverses):
    """A shape and its reflection with outward faces: the true map reverses orientation, and only so fits the term."""
    ball = lopsided()
    spectrum = spectrum_of(ball, 40)
    flipped = TriangleMesh(ball.vertices * [-1, 1, 1], ball.faces[:, ::-1])
    target = spectrum_of(flipped, 40)
    energies = wave_kernel_energies(spectrum, 30)
    waves = [wave_kernel_signature(s, energies.energies, width=energies.width) for s in (spectrum, target)]
    found = FunctionalMap.from_descriptors(
        spectrum, target, *waves, count=20, meshes=(ball, flipped), reverses=reverses, weights=Weights(orientation=10.0)
    )
    exact = FunctionalMap.from_matches(spectrum, target, np.arange(642), count=20)
    error = np.linalg.norm(found.map_12 - exact.map_12) / np.linalg.norm(exact.map_12)
    assert error < 0.05 if reverses else error > 0.2


BAD = [
    (lambda s, m: FunctionalMap(np.eye(61), s, s), "map_12 must be at most (60, 60) like the spectra"),
    (lambda s, m: FunctionalMap.from_matches(s, s, [0, 1]), "match_21 must have shape (642,), but it has (2,)"),
    (lambda s, m: FunctionalMap.from_matches(s, s, m, count=61), "count must be from 1 to 60, but it is 61"),
    (lambda s, m: FunctionalMap.from_matches(s, s, np.ones((642, 3))), "match_21 must have 642 numbers a point"),
    (
        lambda s, m: FunctionalMap.from_descriptors(s, s, np.ones((5, 2)), np.ones((5, 2))),
        "descriptors_1 must have 642",
    ),
    (lambda s, m: FunctionalMap.from_matches(s, s, m).transfer(np.ones(3)), "field_1 must have 642 rows, but it has 3"),
    (lambda s, m: zoomout(s, s, FunctionalMap.from_matches(s, s, m), stop=20), "stop must be at least 50"),
    (lambda s, m: zoomout(s, s, m, samples=0), "samples must be from 1 to 1000000000, but it is 0"),
    (lambda s, m: guided_zoomout(s, s, np.ones((5, 2)), np.ones((642, 2))), "descriptors_1 must have 642 rows"),
    (lambda s, m: guided_zoomout(s, s, np.ones((642, 2)), np.ones((642, 2)), weight=0), "weight must be"),
    (
        lambda s, m: nearest_matches([[0.0], [np.inf]], [[1.0]]),
        "queries must be finite, but 1 of 2 rows are not (first: 1)",
    ),
    (lambda s, m: nearest_matches([[0.0]], [[1.0]], method="fast"), "method must be one of 'exact', 'approximate'"),
]


@pytest.mark.parametrize(("call", "message"), BAD)
def test_bad_arguments_are_named(isometry, call, message):
    spectrum = isometry[3]
    with pytest.raises(ParameterError, match=re.escape(message)):
        call(spectrum, np.arange(len(spectrum.mass)))
