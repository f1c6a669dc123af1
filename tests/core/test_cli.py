"""The command line: results on stdout, one line for a mistake on stderr, and a status that scripts can trust."""

import json
import subprocess
import sys

import pytest

from add_core import __version__
from add_core.cli import application, main
from add_core.geometry import PointCloud
from add_core.geometry.shapes import rectangle, sphere
from add_core.io import save_shape


def run(capsys, *arguments):
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    said = capsys.readouterr()
    return stop.value.code, said.out, said.err


def test_info_shows_counts_boundary_and_defects(capsys, tmp_path):
    sheet = rectangle(2.0, 3.0, n=4)
    save_shape(sheet, tmp_path / "sheet.off")
    status, out, err = run(capsys, "info", str(tmp_path / "sheet.off"))
    assert (status, err) == (0, "")
    assert out.splitlines()[0] == str(tmp_path / "sheet.off")
    for words in (f" {sheet.vertex_count} ", "1 loop, ", "6 (unit of length)²", "no defects"):
        assert words in out


def test_info_names_defects_with_their_remedy(capsys, tmp_path):
    ball = sphere(1)
    (tmp_path / "ball.off").write_text(
        f"OFF\n{ball.vertex_count + 1} {len(ball.faces)} 0\n"
        + "".join(f"{x} {y} {z}\n" for x, y, z in [*ball.vertices.tolist(), (5, 5, 5)])
        + "".join(f"3 {i} {j} {k}\n" for i, j, k in ball.faces.tolist())
    )
    _, out, _ = run(capsys, "info", str(tmp_path / "ball.off"))
    assert f"unreferenced vertices: 1 (first: vertex {ball.vertex_count}). No face uses them" in out


def test_info_as_json_is_one_object_a_line(capsys, tmp_path):
    save_shape(PointCloud([[0, 0, 0], [1, 1, 1]]), tmp_path / "two.xyz")
    status, out, _ = run(capsys, "info", "--json", "humans:3", str(tmp_path / "two.xyz"))
    person, points = (json.loads(line) for line in out.splitlines())
    assert status == 0
    assert (person["vertices"], person["name"]) == (6890, "person 1, walk")
    assert (points["kind"], points["faces"], points["upper"]) == ("point cloud", None, [1.0, 1.0, 1.0])


def test_a_bad_file_does_not_hide_the_good_ones(capsys):
    status, out, err = run(capsys, "info", "missing.off", "dogs:0", "humans:100", "--json")
    assert status == 2
    assert [json.loads(line)["file"] for line in out.splitlines()] == ["dogs:0"]
    assert err.splitlines() == [
        "add-core: missing.off: there is no such file.",
        "add-core: humans holds shapes humans/0 to humans/99, but humans:100 was asked for.",
    ]


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["nonsense"], "add-core: No such command 'nonsense'. Try add-core --help.\n"),
        (["info"], "add-core: Missing argument 'SHAPE...'. Try add-core info --help.\n"),
        (["info", "--colour"], "add-core: No such option '--colour'. Try add-core info --help.\n"),
    ],
)
def test_a_wrong_command_line_is_one_line(capsys, arguments, complaint):
    assert run(capsys, *arguments) == (2, "", complaint)


def test_version_and_help(capsys):
    assert run(capsys, "--version") == (0, f"add-core {__version__}\n", "")
    for arguments in (["--help"], ["info", "--help"]):
        status, out, err = run(capsys, *arguments)
        assert (status, err) == (0, "")
        assert "Usage: add-core" in out
    status, _, err = run(capsys)
    assert status == 2
    assert "Usage: add-core" in err


@pytest.mark.parametrize(
    ("error", "status", "newline", "said"),
    [(KeyboardInterrupt(), 130, "\n", "interrupted."), (MemoryError(), 1, "", "there is not enough memory for this.")],
)
def test_interruption_and_exhaustion_end_quietly(capsys, monkeypatch, error, status, newline, said):
    def fail(name):
        raise error

    monkeypatch.setattr("add_core.cli.info.open_shape", fail)
    assert run(capsys, "info", "humans:0") == (status, "", f"{newline}add-core: {said}\n")


def test_every_command_is_found_and_documented(capsys):
    for name in application.COMMANDS:
        status, out, _ = run(capsys, name, "--help")
        assert status == 0
        assert f"Usage: add-core {name}" in out


def test_the_program_runs_as_a_module_and_survives_a_closed_pipe():
    command = f"{sys.executable} -m add_core.cli info --json humans:0 humans:1 | head -c 10"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=True)
    assert done.stdout == '{"file": "'
    assert done.stderr == ""
