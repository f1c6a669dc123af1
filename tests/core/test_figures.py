"""The figures of the paper as a person asks for them, on shapes small enough to take seconds."""

import html
import json
from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest

from add_core.cli import main
from add_core.contest import describing
from add_core.evaluation import Scores, save_report
from add_core.evaluation.scores import Curve
from add_core.figures import FIGURES, QUALITIES, Quality, compared, methods, network_curves, reproduce, reproduction
from add_core.figures.cast import Cast, people
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import ellipsoid
from add_core.io import Collection

TINY = Quality("draft", 30, 1, 6, eigenpairs=40, angles=2, cloud_points=150, pairs=1, queries=40)
EGG = ellipsoid(0.7, 0.5, 1.0, subdivisions=2)
MIRROR = np.array([np.abs(EGG.vertices - v * [-1, 1, 1]).sum(axis=1).argmin() for v in EGG.vertices])


def egg(index):
    """Eggs with a dent that tells front from back, bent a little differently each."""
    x, y, z = EGG.vertices.T
    bent = np.stack([x, y + 0.1 * (index + 1) * z**2 - 0.15 * (y > 0) * y, z], axis=1)
    return TriangleMesh(bent, EGG.faces, f"egg {index}")


@pytest.fixture(scope="module")
def cast():
    eggs = Collection(
        title="eggs",
        names=tuple(f"egg {index}" for index in range(6)),
        symmetry=MIRROR,
        training=(0, 1, 2, 3),
        up="+z",
        front="-y",
        make_shape=egg,
    )
    side = int(np.argmin(np.abs(EGG.vertices - [0.4, -0.35, 0.3]).sum(axis=1)))
    return Cast(
        collection=eggs,
        hero=0,
        second=1,
        source=side,
        points=((side, "side"), (5, "top"), (20, "back")),
        reference_point=side,
        audience=((0, "mesh"), (1, "mesh"), (2, "cloud")),
        reference=4,
        targets=(5,),
        contests=(eggs,),
    )


@pytest.fixture
def reports(tmp_path, monkeypatch):
    """A folder with a report on two networks and a rival, as `add-core evaluate` writes it."""
    curves = tuple(
        Curve(protocol, setting, np.array([1.0, 2.0]), np.array([0.5, 0.75]))
        for protocol in ("cmc", "roc", "princeton")
        for setting in ("symmetric", "asymmetric")
    )
    numbers = {"CMC@1 symmetric": 0.5, "CMC@1 asymmetric": 0.4, "P(right side)": 0.9}
    found = [Scores(name, 3, numbers, curves) for name in ("madd3", "osd", "add1")]
    save_report(found, tmp_path / "learned_mesh", title="networks")
    monkeypatch.setattr(compared, "_reports", lambda: [tmp_path / "learned_mesh"])


@pytest.fixture(autouse=True)
def _tiny(monkeypatch, cast, tmp_path):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setitem(QUALITIES, "draft", TINY)
    monkeypatch.setattr(reproduction, "people", lambda: cast)


def run(*words, status=0):
    with pytest.raises(SystemExit) as ended:
        main(["figures", *map(str, words)])
    assert ended.value.code == status


def test_one_command_draws_every_figure_and_a_page_around_them(tmp_path, capsys, reports):
    folder = tmp_path / "figures"
    run("-o", folder, "--quality", "draft")
    page = (folder / "index.html").read_text(encoding="utf-8")
    for figure in FIGURES:
        picture = folder / f"{figure.stem}.png"
        assert picture.read_bytes().startswith(b"\x89PNG")
        assert f'src="{picture.name}"' in page
        assert html.escape(figure.difference) in page
    assert "ot drawn" not in page
    assert page.count("<code>add-core ") == len(FIGURES)
    assert not list(folder.glob(".*")), "unfinished files are left behind"
    assert capsys.readouterr().out.count("\n") >= len(FIGURES) + 1


def test_curves_of_a_shipped_report_are_drawn_as_they_are(tmp_path, reports):
    """Figure 8 has the networks of the report in the paper's order; Figure 7 has the rivals that are only there."""
    reproduce(tmp_path, only=[7, 8], quality="draft")
    lines = [line.split(",") for line in (tmp_path / "figure_08.csv").read_text().splitlines()]
    assert list(dict.fromkeys(line[1] for line in lines[1:])) == ["add1", "madd3"]
    assert ["eggs", "madd3", "cmc", "symmetric", "2", "0.75"] in lines
    assert ",osd,roc," in (tmp_path / "figure_07.csv").read_text()


def test_what_cannot_be_drawn_here_is_said_and_the_rest_is_drawn(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(compared, "_reports", list)
    run("-o", tmp_path, "--quality", "draft", "--only", "5,8")
    said = capsys.readouterr().out
    assert "Figure  8  not drawn: trained networks" in said
    assert "--train MINUTES" in said
    assert (tmp_path / "figure_05.png").is_file()
    assert "Not drawn: trained networks" in (tmp_path / "index.html").read_text(encoding="utf-8")
    run("-o", tmp_path, "--quality", "draft", "--only", "8", "--json", status=1)
    (one,) = json.loads(capsys.readouterr().out)["figures"]
    assert (one["number"], one["drawn"]) == (8, False)


def test_networks_are_trained_on_request_once_for_the_same_time(tmp_path, monkeypatch):
    monkeypatch.setattr(compared, "ARCHITECTURES", ("ADD1",))
    monkeypatch.setattr(network_curves, "ARCHITECTURES", ("ADD1",))
    monkeypatch.setattr(compared, "SPLINES", 8)
    monkeypatch.setattr(compared, "VALIDATE_EVERY", 10)
    first, again, longer = (
        reproduce(tmp_path, only=[8], quality="draft", train=minutes)[0] for minutes in (1e-3, 1e-3, 2e-3)
    )
    assert (first.kept, again.kept, longer.kept) == (False, True, False)
    assert (tmp_path / "models" / "draft, 0.001 minutes" / "ADD1" / "model.safetensors").is_file()
    assert not (tmp_path / "models" / "draft, 0.001 minutes" / "ADD1" / "inputs").exists()
    assert "0.001 minutes" in first.entry.caption


@pytest.mark.parametrize(("package", "number"), [("torch", 6), ("sklearn", 9)])
def test_without_an_extra_a_figure_does_without_what_needs_it(tmp_path, monkeypatch, cast, package, number):
    """On the shipped names, so that both are asked for; what is left out is told with the remedy."""
    monkeypatch.setattr(describing, "find_spec", lambda name: None if name == package else object())
    monkeypatch.setattr(methods, "find_spec", lambda name: None if name == package else object())
    had, missing = methods.obtainable(["hks", "rf", "humans-madd3", "humans-madd3+zoomout"])
    gone = {"torch": "mADD3", "sklearn": "random forest"}[package]
    assert "hks" in had
    assert gone not in [methods.method(name).title for name in had]
    assert [line for line in missing if line.startswith(gone) and "pip install" in line]
    asking = replace(cast, learned=("humans-madd3",))
    if package == "torch":
        (drawn,) = reproduce(tmp_path, only=[number], quality="draft", cast=asking)
        assert drawn.entry.missing[0].startswith("mADD3: it needs torch")


def test_a_second_run_keeps_what_is_there_and_draws_what_was_lost(tmp_path, capsys):
    folder = tmp_path / "figures"
    run("-o", folder, "--quality", "draft", "--only", "2,3")
    first = (folder / "figure_02.png").stat().st_mtime_ns
    (folder / "figure_03.png").unlink()
    capsys.readouterr()
    run("-o", folder, "--quality", "draft", "--only", "2,3", "--json")
    answer = json.loads(capsys.readouterr().out)
    assert [(one["number"], one["kept"]) for one in answer["figures"]] == [(2, True), (3, False)]
    assert (folder / "figure_02.png").stat().st_mtime_ns == first
    run("-o", folder, "--quality", "draft", "--only", "2", "--again")
    assert (folder / "figure_02.png").stat().st_mtime_ns > first


def test_another_quality_or_format_is_another_figure(tmp_path):
    kept = [
        reproduce(tmp_path, only=[3], quality=quality, image=image)[0].kept
        for quality, image in [("draft", "svg"), ("draft", "svg"), ("draft", "pdf"), (QUALITIES["draft"], "pdf")]
    ]
    assert kept == [False, True, False, True]


def test_a_run_that_was_stopped_goes_on(tmp_path):
    class Stop(Exception):
        pass

    def stop_at_three(figure):
        if figure.number == 3:
            raise Stop
        return nullcontext(lambda done, total: None)

    with pytest.raises(Stop):
        reproduce(tmp_path, only=[2, 3], quality="draft", watch=stop_at_three)
    assert [one.kept for one in reproduce(tmp_path, only=[2, 3], quality="draft")] == [True, False]


def test_progress_ends_complete_and_is_json_on_stderr(tmp_path, capsys):
    run("-o", tmp_path, "--quality", "draft", "--only", "1", "--json")
    steps = [json.loads(line) for line in capsys.readouterr().err.splitlines()]
    assert {step["label"] for step in steps} == {"Figure 1"}
    assert steps[0]["done"] == 0
    assert steps[-1]["done"] == steps[-1]["total"]


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--only", "12"), f"only must name figures from 1 to {FIGURES[-1].number}, but it names 12."),
        (("--only", "three"), "'three' is not a list of figure numbers such as 3,6."),
        (("--quality", "best"), "'best' is not one of"),
        (("--format", "gif"), "'gif' is not one of"),
        (("--train", "0"), "train must be finite and greater than 0, but it is 0.0."),
    ],
)
def test_a_mistake_is_one_line_and_status_two(tmp_path, capsys, words, complaint):
    run("-o", tmp_path / "figures", *words, status=2)
    captured = capsys.readouterr()
    assert complaint in captured.err
    assert captured.err.count("\n") == 1
    assert not (tmp_path / "figures").exists()


def test_a_folder_that_cannot_be_made_is_named(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    run("-o", tmp_path / "file" / "figures", "--only", "3", status=2)
    assert "cannot be made a folder" in capsys.readouterr().err


def test_the_shipped_cast_stands_on_test_shapes_and_on_their_skin():
    """Nothing was trained on whoever appears, and every vertex exists."""
    cast = people()
    test = set(cast.collection.split("test").tolist())
    shown = {cast.hero, cast.second, cast.reference, *cast.targets, *(index for index, _ in cast.audience)}
    assert shown <= test
    vertices = cast.collection[cast.hero].vertex_count
    assert all(0 <= vertex < vertices for vertex in (cast.source, cast.reference_point, *dict(cast.points)))
