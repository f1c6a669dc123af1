"""`add-core train` and `add-core describe` with what it made."""

import json
import signal
import subprocess
import sys

import numpy as np
import pytest
import torch

from add_core.cli import main
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import ellipsoid
from add_core.io import load_fields, save_shape

SMALL = ["--angles", "2", "--count", "30", "--splines", "8", "--steps", "6", "--pairs", "16", "--architecture", "mADD2"]


def run(capsys, *arguments):
    with pytest.raises(SystemExit) as stop:
        main([str(argument) for argument in arguments])
    said = capsys.readouterr()
    return stop.value.code, said.out, said.err


@pytest.fixture(autouse=True)
def _one_thread():
    torch.set_num_threads(1)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bodies")
    mesh = ellipsoid(1.0, 0.7, 0.5, subdivisions=2)
    for number in range(5):
        lumps = 1 + 0.2 * np.sin(2 * mesh.vertices[:, 0] + 0.1 * number) + 0.1 * np.cos(4 * mesh.vertices[:, 1])
        save_shape(TriangleMesh(mesh.vertices * lumps[:, None], mesh.faces), folder / f"body{number}.ply")
    return folder


def test_a_folder_of_shapes_makes_a_model_that_describes_a_shape(capsys, folder, tmp_path):
    status, out, err = run(capsys, "train", "--data", folder, "-o", tmp_path / "run", "--json", *SMALL)
    events = [json.loads(line) for line in out.splitlines()]
    assert (status, err) == (0, "")
    assert [event["step"] for event in events if event["event"] == "step"] == [1, 2, 3, 4, 5, 6]
    assert [event["right_side"] for event in events if event["event"] == "validation"] == [None]
    model, described = events[-1]["model"], tmp_path / "described.ply"
    status, out, _ = run(capsys, "describe", model, folder / "body0.ply", "-o", described)
    assert (status, "numbers" in out) == (0, True)
    assert load_fields(described)["learned"].shape == (162, 16)


def test_a_correspondence_network_describes_a_shape_by_its_reference(capsys, folder, tmp_path):
    small = ["--angles", "2", "--count", "30", "--splines", "8", "--steps", "2", "--pairs", "16"]
    status, _, _ = run(capsys, "train", "--architecture", "mADD4", "--data", folder, "-o", tmp_path / "run", *small)
    described = tmp_path / "described.ply"
    assert (status, run(capsys, "describe", tmp_path / "run", folder / "body0.ply", "-o", described)[0]) == (0, 0)
    fields = load_fields(described)
    assert fields["reference_vertex"].shape == fields["probability"].shape == (162,)
    assert fields["reference_vertex"].max() < 162
    assert fields["learned"].shape == (162, 3)


def test_a_training_is_evaluated_by_its_folder(capsys, folder, tmp_path, monkeypatch):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    run(capsys, "train", "--data", folder, "-o", tmp_path / "run", *SMALL)
    asked = ("--pairs", 1, "--queries", 60, "--variant", "cloud", "--protocol", "cmc", "--json")
    status, out, _ = run(capsys, "evaluate", tmp_path / "run", *asked)
    (scores,) = [value for name, value in json.loads(out.splitlines()[-1]).items() if name != "event"]
    assert status == 0
    assert 0.0 <= scores["CMC@10 asymmetric"] <= 1.0


def test_training_again_finds_the_work_done(capsys, folder, tmp_path):
    arguments = ["train", "--data", folder, "-o", tmp_path / "run", *SMALL]
    assert run(capsys, *arguments)[0] == 0
    before = (tmp_path / "run" / "model.safetensors").read_bytes()
    status, out, _ = run(capsys, *arguments, "--json")
    assert status == 0
    assert not [line for line in out.splitlines() if json.loads(line)["event"] == "step"]
    assert (tmp_path / "run" / "model.safetensors").read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["train", "--data", "unicorns", "-o", "run"], "there is no folder 'unicorns'"),
        (["train", "--data", "humans", "-o", "run", "--steps", "0"], "steps must be from 1"),
        (["train", "--data", "humans", "-o", "run", "--angles", "0"], "angles must be from 1"),
        (
            ["describe", "unicorns-madd3", "humans:0", "-o", "x.ply"],
            "the folder of a training or a shipped model",
        ),
        (["describe", "a", "b", "c", "-o", "x.ply"], "there are 3 names"),
    ],
)
def test_mistakes_cost_one_line(capsys, tmp_path, monkeypatch, arguments, complaint):
    monkeypatch.chdir(tmp_path)
    status, out, err = run(capsys, *arguments)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert complaint in err
    assert not list(tmp_path.iterdir())


def test_a_training_that_is_told_to_end_keeps_its_last_step(folder, tmp_path):
    """SIGTERM is how a window pauses a training; the same command then goes on."""
    few = ["--angles", "2", "--count", "30", "--splines", "8", "--pairs", "16", "--architecture", "mADD2"]
    command = ["train", "--data", str(folder), "-o", str(tmp_path / "run"), "--json", "--steps", "100000", *few]
    with subprocess.Popen(
        [sys.executable, "-m", "add_core.cli", *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        while json.loads(line := process.stdout.readline())["event"] != "step":
            pass
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=60)
    last = json.loads([line, *out.splitlines()][-1])["step"]
    assert process.returncode == 130
    assert f"Stopped on request after step {last} of 100000" in err
    kept = torch.load(tmp_path / "run" / "checkpoint.pt", weights_only=True)
    assert kept["step"] == last


def test_without_torch_one_line_says_what_to_install(capsys, folder, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    for name in [name for name in sys.modules if name.startswith("add_core.learning")]:
        monkeypatch.delitem(sys.modules, name)
    status, _, err = run(capsys, "train", "--data", folder, "-o", tmp_path / "run", *SMALL)
    assert (status, err.count("\n")) == (2, 1)
    assert "needs torch, which is not installed. Run: pip install torch safetensors" in err
