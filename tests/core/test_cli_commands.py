"""The commands kernel, spectra, describe and cache, as a person types them."""

import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.cli import main
from add_core.geometry.shapes import ellipsoid
from add_core.io import load_fields, load_shape, save_shape
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import HeatFlow, compute_spectrum
from add_core.spectra.cache import remove_abandoned


@pytest.fixture
def egg(tmp_path, monkeypatch):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    path = tmp_path / "egg.off"
    save_shape(ellipsoid(subdivisions=2), path)
    return path


def run(*words, status=0):
    with pytest.raises(SystemExit) as ended:
        main([str(word) for word in words])
    assert ended.value.code == status


def results(capsys):
    return [json.loads(line) for line in capsys.readouterr().out.splitlines()]


def test_kernel_writes_the_heat_onto_the_shape_as_it_was(egg, tmp_path, capsys):
    written = tmp_path / "heat.vtp"
    run(
        "kernel", egg, "--source", 5, "--alpha", 9, "--theta", 30, "--time", 0.2, "--own-units", "-o", written, "--json"
    )
    flow = HeatFlow(AnisotropicLaplacian(load_shape(egg), alpha=9.0))
    expected = flow.kernel(5, theta=np.radians(30), time=0.2)
    assert_allclose(load_fields(written)["heat_kernel"], expected, rtol=1e-12)
    assert_allclose(load_shape(written).vertices, load_shape(egg).vertices)
    (answer,) = results(capsys)
    assert answer["event"] == "result"
    assert_allclose(answer["heat_left_at_the_vertex"], expected[5])


def test_lengths_count_in_geodesic_diameters_unless_told_otherwise(egg, tmp_path, capsys):
    """Ten times the size, the same answer; in the file's own unit another one."""
    large = tmp_path / "large.off"
    save_shape(type(load_shape(egg))(10 * load_shape(egg).vertices, load_shape(egg).faces), large)
    run("kernel", egg, "--source", 5, "--json")
    run("kernel", large, "--source", 5, "--json")
    run("kernel", large, "--source", 5, "--own-units", "--json")
    small, scaled, own = results(capsys)
    assert_allclose(small["heat_left_at_the_vertex"], scaled["heat_left_at_the_vertex"], rtol=1e-6)
    assert own["unit_of_length"] == "the file's unit"
    assert own["heat_left_at_the_vertex"] < 0.1 * scaled["heat_left_at_the_vertex"]


def test_spectra_are_written_reported_and_kept(egg, tmp_path, capsys):
    written = tmp_path / "spectra.npz"
    options = ("--alphas", "0,20", "--angles", 2, "--count", 8, "--workers", 1, "--json")
    run("spectra", egg, *options, "-o", written)
    captured = capsys.readouterr()
    (answer,) = [json.loads(line) for line in captured.out.splitlines()]
    steps = [json.loads(line) for line in captured.err.splitlines()]
    assert [step["done"] for step in steps if step["event"] == "progress"] == [0, 1, 2, 3]
    assert answer["operators"] == 3
    with np.load(written) as arrays:
        assert arrays["eigenfunctions"].shape == (3, 162, 8)
        first = arrays["eigenvalues"]
    run("spectra", egg, *options, "-o", written)
    with np.load(written) as arrays:
        assert np.array_equal(arrays["eigenvalues"], first)
    capsys.readouterr()
    run("cache", "list", "--json")
    assert "egg, 3 operators, K = 8" in results(capsys)[0]["label"]
    run("cache", "clear")
    capsys.readouterr()
    run("cache", "list", "--json")
    assert results(capsys) == []


@pytest.mark.parametrize(
    ("descriptor", "numbers"),
    [("hks", 4), ("si-hks", 4), ("wks", 4), ("wft", 4), ("ahks", 8), ("geometry-vectors", 8)],
)
def test_every_descriptor_comes_out_finite_for_every_vertex(egg, tmp_path, descriptor, numbers):
    written = tmp_path / "described.npz"
    run("describe", egg, "--descriptor", descriptor, "--numbers", 4, "--angles", 2, "--count", 20, "-o", written)
    values = load_fields(written)[descriptor.replace("-", "_")]
    assert values.shape == (162, numbers)
    assert np.isfinite(values).all()
    assert np.ptp(values, axis=0).max() > 0


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("kernel", "humans:0", "--source", 99999), "source must be from 0 to 6889, but it is 99999."),
        (("kernel", "missing.ply", "--source", 0), "missing.ply: there is no such file."),
        (
            ("kernel", "humans:100", "--source", 0),
            "humans holds shapes humans/0 to humans/99, but humans:100 was asked for.",
        ),
        (("kernel", "humans:0", "--source", 0, "--alpha", -1), "alpha must be finite and at least 0, but it is -1.0."),
        (("spectra", "humans:0", "--alphas", "0,x"), "'0,x' is not a list of numbers such as 0,25,50."),
        (("spectra", "humans:0", "-o", "out.txt"), "out.txt must end in one of .npz."),
        (("spectra", "humans:0", "--count", 7000), "count must be from 1 to 6890, but it is 7000."),
        (("describe", "humans:0", "-o", "out.obj"), "out.obj must end in one of .ply, .vtp, .vtk, .npz."),
        (("describe", "humans:0"), "Missing option '-o' / '--output'."),
    ],
)
def test_a_mistake_is_one_line_and_status_two(words, complaint, capsys):
    run(*words, status=2)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("add-core: ")
    assert complaint in captured.err
    assert captured.err.count("\n") == 1


def test_describe_gives_descriptors_as_they_are_compared(egg, tmp_path):
    """Logarithms, each column standardised over the surface; of ahks the departures of both angles share the weight of
    their mean.
    """
    mass = load_shape(egg).vertex_areas
    weights = mass / mass.sum()
    for descriptor, width, spreads in (("wks", 16, {1.0}), ("ahks", 16 * 3, {1.0, 0.7071})):
        written = tmp_path / f"{descriptor}.npz"
        run("describe", egg, "--descriptor", descriptor, "--compared", "--count", 30, "--angles", 2, "-o", written)
        values = load_fields(written)[descriptor]
        assert values.shape == (162, width)
        assert_allclose(weights @ values, 0.0, atol=1e-9)
        assert set(np.round(np.sqrt(weights @ values**2), 4).tolist()) == spreads


def test_spectra_of_one_angle(egg, tmp_path, capsys):
    written = tmp_path / "one.npz"
    run("spectra", egg, "--alphas", 9, "--theta", 30, "--count", 8, "--own-units", "-o", written)
    expected = compute_spectrum(AnisotropicLaplacian(load_shape(egg), alpha=9.0), theta=np.radians(30), count=8)
    with np.load(written) as found:
        assert_allclose(found["eigenvalues"][0], expected.eigenvalues, rtol=1e-9, atol=1e-9)
        assert found["eigenfunctions"].shape == (1, 162, 8)
    run("spectra", egg, "--theta", 30, status=2)
    assert "--alphas names 3" in capsys.readouterr().err


def test_a_command_that_is_told_to_end_leaves_nothing_behind(tmp_path):
    """SIGTERM is how a window cancels a job."""
    command = ["spectra", "humans:0", "--no-cache", "--json", "--workers", "2"]
    with subprocess.Popen(
        [sys.executable, "-m", "add_core.cli", *command],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "TMPDIR": str(tmp_path)},
    ) as process:
        line = process.stderr.readline()
        assert list(tmp_path.iterdir()), line
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
    assert process.returncode == 130
    assert not list(tmp_path.iterdir())


def test_what_killed_commands_left_goes_after_a_day(tmp_path):
    old, new, other = (tmp_path / name for name in ("mine-1", "mine-2", "other"))
    for folder in (old, new, other):
        folder.mkdir()
    for folder in (old, other):
        os.utime(folder, (0, 0))
    remove_abandoned(tmp_path, "mine-")
    assert sorted(tmp_path.iterdir()) == [new, other]
