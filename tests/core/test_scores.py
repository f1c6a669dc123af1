"""Reports: pairs averaged, tables written, samples with a truth that can be checked by looking at positions."""

import csv
import json

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ParameterError
from add_core.evaluation import Scores, averaged, descriptor_scores, match_scores, princeton, save_report, table
from add_core.evaluation.baselines import BASELINES, describe_with, functional_map_matches, refined_matches
from add_core.evaluation.figures import panels
from add_core.evaluation.report_reading import load_report
from add_core.evaluation.samples import VARIANTS, Sample, at_vertices, sample, truth_between
from add_core.evaluation.scores import Curve, query_rows
from add_core.geometry import TriangleMesh
from add_core.geometry.closest import closest_points
from add_core.geometry.shapes import ellipsoid, rectangle, sphere
from add_core.io import humans
from add_core.spectra import compute_spectra


@pytest.fixture(scope="module")
def pair():
    """An egg with a mirror image in x, and the same egg again."""
    mesh = ellipsoid(1.0, 0.8, 0.6, subdivisions=2)
    mirror = np.array([np.abs(mesh.vertices - vertex * [-1, 1, 1]).sum(axis=1).argmin() for vertex in mesh.vertices])
    one = Sample("egg", mesh, mesh, at_vertices(np.arange(mesh.vertex_count)), mirror)
    return one, one


def test_scores_are_those_of_the_protocols(pair):
    one, two = pair
    descriptors = np.abs(one.shape.vertices)
    scores = descriptor_scores("blind", one, two, (descriptors, descriptors))
    n = one.shape.vertex_count
    alone = princeton(descriptors, descriptors, np.arange(n), shape=one.shape)
    assert_array_equal(scores.curve("princeton", "asymmetric").y, alone.y)
    assert scores.numbers["mean error asymmetric"] == alone.mean_error
    assert scores.numbers["P(right side)"] == 0.5
    assert scores.numbers["CMC@1 symmetric"] > scores.numbers["CMC@1 asymmetric"]
    perfect = match_scores("truth", one, two, np.arange(n))
    assert perfect.numbers == {"mean error symmetric": 0.0, "mean error asymmetric": 0.0}


def test_a_part_of_the_points_can_be_asked_for(pair):
    one, two = pair
    assert_array_equal(query_rows(10, 4), [0, 3, 6, 9])
    assert_array_equal(query_rows(3, 10), [0, 1, 2])
    values = one.shape.vertices
    few = descriptor_scores("few", one, two, (values, values), protocols=("cmc",), queries=20)
    assert few.numbers["CMC@1 asymmetric"] == 1.0
    assert {curve.protocol for curve in few.curves} == {"cmc"}
    with pytest.raises(ParameterError, match="few was not evaluated by roc, symmetric"):
        few.curve("roc", "symmetric")


def test_averages_are_weighted_by_pairs(pair):
    one, two = pair
    random = np.random.default_rng(0)
    n = one.shape.vertex_count
    some = [match_scores("guess", one, two, random.integers(0, n, n)) for _ in range(3)]
    both = averaged([averaged(some[:2]), some[2]])
    assert both.pairs == 3
    expected = np.mean([score.numbers["mean error symmetric"] for score in some])
    assert both.numbers["mean error symmetric"] == pytest.approx(expected, rel=1e-12)
    curves = [score.curve("princeton", "symmetric").y for score in some]
    assert_allclose(both.curve("princeton", "symmetric").y, np.mean(curves, axis=0), rtol=1e-12)
    with pytest.raises(ParameterError, match="scores must be those of one method"):
        averaged([])


def test_a_report_can_be_read_back(pair, tmp_path):
    one, two = pair
    values = one.shape.vertices
    scores = [
        descriptor_scores("places", one, two, (values, values)),
        match_scores("a <guess>", one, two, np.zeros(one.shape.vertex_count, dtype=int)),
    ]
    save_report(scores, tmp_path / "new" / "report", title="Eggs", command="make eggs", notes=["Boiled."])
    folder = tmp_path / "new" / "report"
    rows = list(csv.DictReader((folder / "scores.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["method"] for row in rows] == ["places", "a <guess>"]
    assert rows[0]["CMC@1 asymmetric"] == "1"
    assert rows[1]["CMC@1 asymmetric"] == ""
    facts = json.loads((folder / "scores.json").read_text(encoding="utf-8"))
    assert facts["methods"][0]["P(right side)"] == 1.0
    curves = list(csv.DictReader((folder / "curves.csv").read_text(encoding="utf-8").splitlines()))
    assert {row["protocol"] for row in curves} == {"cmc", "roc", "princeton"}
    page = (folder / "index.html").read_text(encoding="utf-8")
    assert "a &lt;guess&gt;" in page
    assert "Boiled." in page
    assert "data:image/svg+xml" in page
    assert (folder / "curves.svg").read_text(encoding="utf-8").startswith("<?xml")
    lines = table(scores).splitlines()
    assert len({len(line) for line in lines}) == 1
    assert lines[1].startswith("places")
    with pytest.raises(ParameterError, match="the report cannot be written to"):
        save_report(scores, folder / "scores.csv" / "below", title="Eggs")
    with pytest.raises(ParameterError, match="scores must hold at least one method"):
        save_report([], folder, title="Eggs")


def test_a_report_draws_the_protocols_that_were_evaluated(pair):
    matches = match_scores("guess", *pair, np.zeros(pair[0].shape.vertex_count, dtype=int))
    assert [axes.get_title() for axes in panels([matches]).axes] == ["Princeton"]
    places = descriptor_scores("places", *pair, (pair[0].shape.vertices,) * 2, protocols=("cmc", "roc"))
    drawn = panels([places, matches])
    assert [axes.get_title() for axes in drawn.axes] == ["CMC", "ROC", "Princeton"]
    assert [len(axes.lines) for axes in drawn.axes] == [2, 2, 2]


@pytest.mark.parametrize("variant", VARIANTS)
def test_truth_leads_to_the_same_place_on_the_other_body(variant):
    collection = humans()
    one, two = sample(collection, 80, variant), sample(collection, 93, variant)
    truth = truth_between(one, two)
    wanted = np.einsum("qj,qjk->qk", one.place.weights, two.original.vertices[one.place.corners])
    reached = np.einsum("qj,qjk->qk", truth.weights, two.shape.vertices[truth.corners])
    gap = np.linalg.norm(wanted - reached, axis=1)
    limit = {"mesh": 0.0, "remeshed": 0.002, "cloud": 0.004}[variant]  # metres, on average
    assert gap.mean() <= limit
    own = np.einsum("qj,qjk->qk", one.place.weights, one.original.vertices[one.place.corners])
    assert np.linalg.norm(own - one.shape.vertices, axis=1).mean() <= 0.002
    assert (one.symmetry[one.symmetry] == np.arange(one.shape.vertex_count)).mean() > 0.85


def test_only_test_people_ship_remeshed():
    with pytest.raises(ParameterError, match="person 1, neutral does not ship remeshed"):
        sample(humans(), 0, "remeshed")
    with pytest.raises(ParameterError, match="variant must be one of"):
        sample(humans(), 0, "voxels")


def test_the_closest_point_lies_on_the_surface_and_nowhere_nearer():
    sheet = rectangle(2.0, 2.0, n=6)
    points = np.random.default_rng(1).uniform([0.1, 0.1, -1], [1.9, 1.9, 1], (50, 3)) + sheet.vertices.min(axis=0)
    found = closest_points(sheet, points)
    assert_allclose(found.distances, np.abs(points[:, 2]), atol=1e-12)
    places = np.einsum("qj,qjk->qk", found.weights, sheet.vertices[sheet.faces[found.faces]])
    assert_allclose(places[:, :2], points[:, :2], atol=1e-12)


def test_normals_keep_to_one_side_of_a_thin_body():
    """Two sheets a hair's breadth apart, back to back: a point looking down belongs to the lower one."""
    sheet = rectangle(1.0, 1.0, n=4)
    lower = sheet.vertices - [0, 0, 0.01]
    both = TriangleMesh(np.vstack([sheet.vertices, lower]), np.vstack([sheet.faces, sheet.faces[:, ::-1] + 25]))
    assert both.vertex_count == 50
    middle = [[*sheet.vertices[:, :2].mean(axis=0) + 0.01, 0.0]]
    assert closest_points(both, middle).faces[0] < len(sheet.faces)
    assert closest_points(both, middle, np.array([[0, 0, -1.0]])).faces[0] >= len(sheet.faces)


@pytest.mark.parametrize("name", list(BASELINES))
def test_every_baseline_describes_every_point(name):
    family = compute_spectra(sphere(2), alphas=(0.0, 50.0), angles=4, count=30, cache=False)
    values = describe_with(name, family)
    assert values.shape[0] == 162
    assert values.shape[1] >= 16
    assert np.isfinite(values).all()


def test_functional_maps_and_their_refinement_find_a_shape_in_itself():
    bump = sphere(2).vertices * (1 + 0.3 * (sphere(2).vertices @ [0.5, 0.3, 0.2]) ** 3)[:, None] * [1, 1.2, 1.5]
    family = compute_spectra(TriangleMesh(bump, sphere(2).faces), alphas=(0.0,), angles=1, count=40, cache=False)
    matches = functional_map_matches(family, family)
    assert_array_equal(refined_matches(family, family, matches).match_21, np.arange(162))


def test_a_report_reads_back_as_it_was_written(tmp_path):
    curve = Curve("roc", "symmetric", np.array([0.0, 0.125, 1.0]), np.array([0.0, 0.5, 1.0]))
    written = [Scores("b, with a comma", 3, {"AUC symmetric": 0.9}, (curve,)), Scores("a", 2, {"CMC@1": 0.25}, ())]
    save_report(written, tmp_path, title="scores")
    read = load_report(tmp_path)
    assert [(s.method, s.pairs, s.numbers) for s in read] == [(s.method, s.pairs, s.numbers) for s in written]
    assert_allclose(read[0].curve("roc", "symmetric").x, curve.x)
    assert_allclose(read[0].curve("roc", "symmetric").y, curve.y)
    with pytest.raises(ParameterError, match="holds no report of add-core evaluate"):
        load_report(tmp_path / "elsewhere")
