"""The figures of the paper as a person asks for them, on shapes small enough to take seconds."""

import html
import json
from contextlib import nullcontext

import numpy as np
import pytest

from add_core.cli import main
from add_core.figures import FIGURES, QUALITIES, Quality, reproduce, reproduction
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
        subjects=tuple(f"egg {index}" for index in range(6)),
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


@pytest.fixture(autouse=True)
def _tiny(monkeypatch, cast, tmp_path):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setitem(QUALITIES, "draft", TINY)
    monkeypatch.setattr(reproduction, "people", lambda: cast)


def run(*words, status=0):
    with pytest.raises(SystemExit) as ended:
        main(["figures", *map(str, words)])
    assert ended.value.code == status


def test_one_command_draws_every_figure_and_a_page_around_them(tmp_path, capsys):
    folder = tmp_path / "figures"
    run("-o", folder, "--quality", "draft")
    page = (folder / "index.html").read_text(encoding="utf-8")
    for figure in FIGURES:
        picture = folder / f"{figure.stem}.png"
        assert picture.read_bytes().startswith(b"\x89PNG")
        assert f'src="{picture.name}"' in page
        assert html.escape(figure.difference) in page
    assert "not drawn" not in page
    assert not list(folder.glob(".*")), "unfinished files are left behind"
    assert capsys.readouterr().out.count("\n") >= len(FIGURES) + 1


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
