"""The commands match and evaluate, as a person types them."""

import json

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from add_core.cli import main
from add_core.contest import chosen_pairs
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import sphere
from add_core.io import humans, load_fields, save_shape


@pytest.fixture
def two(tmp_path, monkeypatch):
    """A lopsided ball, and the same one turned over in space with its vertices the other way round."""
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    ball = sphere(2)
    bumps = 1 + 0.5 * np.exp(-5 * ((ball.vertices - [0.7, 0.5, 0.4]) ** 2).sum(axis=1))
    places = ball.vertices * bumps[:, None] * [1.0, 1.3, 1.7]
    save_shape(TriangleMesh(places, ball.faces), tmp_path / "a.off")
    save_shape(TriangleMesh(places[::-1] * [-1, -1, 1], len(places) - 1 - ball.faces), tmp_path / "b.off")
    return tmp_path / "a.off", tmp_path / "b.off"


def run(*words, status=0):
    with pytest.raises(SystemExit) as ended:
        main([str(word) for word in words])
    assert ended.value.code == status


FAST = ("--count", 40, "--angles", 4, "--size", 40)


@pytest.mark.parametrize("descriptor", ["ahks", "wks", "fm"])
@pytest.mark.parametrize("refine", ["none", "zoomout", "zoomout-plain", "icp"])
def test_match_writes_the_vertex_of_the_first_for_each_of_the_second(two, tmp_path, descriptor, refine):
    written = tmp_path / "map.txt"
    run("match", *two, "--descriptor", descriptor, "--refine", refine, *FAST, "-o", written)
    matches = np.loadtxt(written, dtype=int)
    assert matches.shape == (162,)
    if refine.startswith("zoomout"):
        assert_array_equal(matches, np.arange(162)[::-1])
    else:
        assert (matches == np.arange(162)[::-1]).mean() > 0.9


def test_match_carries_colours_along(two, tmp_path, capsys):
    colored = tmp_path / "b.vtp"
    run("match", *two, *FAST, "-o", tmp_path / "map.txt", "--colors", colored, "--json")
    fields = load_fields(colored)
    assert fields["transferred"].shape == (162, 3)
    assert_array_equal(fields["match"], np.arange(162.0)[::-1])
    answer = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert answer["different_matches"] == 162


def test_mistakes_are_told_in_a_line(two, tmp_path, capsys):
    run("match", *two, *FAST, "-o", tmp_path / "no" / "map.txt", "--descriptor", "wks", status=2)
    assert "map.txt cannot be written" in capsys.readouterr().err
    run("evaluate", "--descriptors", " , ", status=2)
    assert "descriptors must name at least one" in capsys.readouterr().err
    run("evaluate", "--pairs", 0, status=2)
    assert "--pairs" in capsys.readouterr().err


def test_pairs_are_different_test_shapes_and_the_same_every_time():
    pairs = chosen_pairs(humans(), 12, 3)
    assert pairs == chosen_pairs(humans(), 12, 3)
    assert len(set(pairs)) == 12
    test = set(humans().split("test").tolist())
    assert all(i != j and {i, j} <= test for i, j in pairs)
    assert len(chosen_pairs(humans(), 1000, 0)) == 20 * 19


def test_evaluate_prints_a_table_and_writes_a_report(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    folder = tmp_path / "report"
    options = ("--pairs", 1, "--count", 10, "--angles", 1, "--queries", 60, "--variant", "cloud", "--alpha", 50)
    run("evaluate", "--descriptors", "hks,wks+zoomout", *options, "--protocol", "cmc", "-o", folder)
    printed = capsys.readouterr().out
    assert "hks" in printed
    assert "wks+zoomout" in printed
    assert {path.name for path in folder.iterdir()} == {
        "index.html", "curves.svg", "curves.csv", "scores.csv", "scores.json",
    }  # fmt: skip
    facts = json.loads((folder / "scores.json").read_text(encoding="utf-8"))
    assert 0.0 <= facts["methods"][0]["CMC@10 asymmetric"] <= 1.0
    assert "person" in facts["notes"][0]


def test_the_forest_knows_people_only(capsys):
    run("evaluate", "--data", "dogs", "--descriptors", "rf", status=2)
    assert "trained on the shipped people" in capsys.readouterr().err


def test_an_archive_holds_matches_and_errors_before_and_after_refinement(two, tmp_path, capsys):
    first, second = two
    truth, written = tmp_path / "truth.txt", tmp_path / "map.npz"
    claimed = np.arange(162)[::-1].copy()
    claimed[3], claimed[5] = 0, -1
    np.savetxt(truth, claimed, fmt="%d")
    options = ("--descriptor", "hks", "--truth", truth, "--json")
    run("match", first, second, *options, *FAST, "-o", written)
    with np.load(written) as archive:
        found = dict(archive)
    assert_array_equal(found["matches"], np.arange(162)[::-1])
    assert_array_equal(found["raw_matches"], np.arange(162)[::-1])
    for errors in (found["error"], found["raw_error"]):
        assert np.isnan(errors[5])
        assert errors[3] > 0.3
        assert_array_equal(np.delete(errors, [3, 5]), np.zeros(160))
    answer = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert answer["mean_raw_error"] == pytest.approx(np.nanmean(found["raw_error"]), abs=1e-4)
    truth.write_text("one\n", encoding="utf-8")
    run("match", first, second, *options, *FAST, "-o", written, status=2)
    assert "is not a list of vertex numbers" in capsys.readouterr().err
    truth.write_text("", encoding="utf-8")
    run("match", first, second, *options, *FAST, "-o", written, status=2)
    assert "truth must have shape (162,), but it has (0,)" in capsys.readouterr().err


def test_symmetry_writes_the_mirror_image_of_every_vertex(tmp_path, monkeypatch, capsys):
    """A ball with two unlike bumps has one mirror plane: the one through both of them."""
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    ball = sphere(3)
    places = ball.vertices * [1.0, 1.3, 1.7]
    for centre, height in (([0.0, 0.9, 1.1], 0.5), ([0.0, -0.5, 1.5], -0.2)):
        places = places * (1 + height * np.exp(-4 * ((places - centre) ** 2).sum(axis=1)))[:, None]
    save_shape(TriangleMesh(places, ball.faces), tmp_path / "a.off")
    run("symmetry", tmp_path / "a.off", "--angles", 4, "--count", 60, "-o", tmp_path / "eta.txt", "--json")
    answer = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert answer["found"] is True
    eta = np.loadtxt(tmp_path / "eta.txt", dtype=int)
    away = np.linalg.norm(places[eta] - places * [-1, 1, 1], axis=1)
    assert np.median(away) < 0.1
