"""The whole family: which operators it holds, that nothing but time depends on workers, and how it is stopped."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import add_core
from add_core.eigensolver import solver
from add_core.errors import Cancelled, GeometryError, ParameterError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import ellipsoid, sphere, torus
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import computation, compute_spectra, compute_spectrum, processes

SHAPE = ellipsoid(1.0, 0.8, 0.5, subdivisions=3)
ROOT = Path(add_core.__file__).parents[1]


@pytest.fixture(autouse=True)
def _own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))


def small_family(**options):
    options = {"alphas": (0.0, 20.0), "angles": 3, "count": 20, "cache": False} | options
    return compute_spectra(SHAPE, **options)


def test_alpha_zero_has_one_operator_and_every_other_alpha_one_per_angle():
    family = compute_spectra(SHAPE, alphas=(0.0, 25.0, 50.0), angles=4, count=5, cache=False)
    assert_array_equal(family.alphas, [0] + [25] * 4 + [50] * 4)
    assert_allclose(family.thetas, [0, *np.tile(np.pi * np.arange(4) / 4, 2)])
    assert len(family) == 9
    assert family.eigenvalues.shape == (9, 5)
    assert family.eigenfunctions.shape == (9, SHAPE.vertex_count, 5)
    assert family.mass.shape == (SHAPE.vertex_count,)
    assert family.fallbacks == ("",) * 9
    assert (family.name, family.conductivity) == (SHAPE.name, "curvature")


@pytest.mark.parametrize("conductivity", ["curvature", "constant"])
def test_each_channel_is_the_spectrum_of_its_operator(conductivity):
    family = small_family(conductivity=conductivity)
    for channel, spectrum in enumerate(family):
        laplacian = AnisotropicLaplacian(SHAPE, alpha=family.alphas[channel], conductivity=conductivity)
        single = compute_spectrum(laplacian, theta=family.thetas[channel], count=20)
        assert_array_equal(spectrum.eigenvalues, single.eigenvalues)
        assert_array_equal(spectrum.eigenfunctions, single.eigenfunctions)


def test_workers_change_no_bit():
    one, two, three = (small_family(workers=workers) for workers in (1, 2, 3))
    for other in (two, three):
        assert_array_equal(one.eigenvalues, other.eigenvalues)
        assert_array_equal(one.eigenfunctions, other.eigenfunctions)


def test_results_are_read_only_and_float32_on_request():
    full, half = small_family(), small_family(dtype="float32")
    assert half.eigenfunctions.dtype == np.float32
    assert half.eigenvalues.dtype == np.float64
    assert_array_equal(half.eigenfunctions, full.eigenfunctions.astype(np.float32))
    for array in (full.alphas, full.thetas, full.eigenvalues, full.eigenfunctions, full.mass):
        assert not array.flags.writeable


def test_mirror_images_have_mirrored_angles():
    """An orientation-reversing symmetry turns θ into π − θ and keeps every eigenvalue."""
    family = compute_spectra(torus(around=32, through=16), alphas=(30.0,), angles=6, count=30, cache=False)
    for k in range(1, 6):
        assert_allclose(family.eigenvalues[k], family.eigenvalues[6 - k], rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("workers", [1, 2])
def test_progress_counts_operators_in_the_calling_thread(workers):
    seen = []
    small_family(workers=workers, progress=lambda done, total: seen.append((done, total, threading.get_ident())))
    assert [done for done, _, _ in seen] == list(range(5))
    assert {(total, thread) for _, total, thread in seen} == {(4, threading.get_ident())}


@pytest.mark.parametrize("workers", [1, 2])
def test_a_progress_that_returns_false_stops_the_work(workers, tmp_path):
    with pytest.raises(Cancelled, match="Stopped on request after 1 of 4 operators"):
        small_family(workers=workers, cache=True, progress=lambda done, total: done < 1)
    assert not any((tmp_path / "cache" / "spectra").iterdir()), "a stopped family leaves nothing behind"


@pytest.mark.parametrize("error", [KeyError("mine"), OSError("mine"), processes.WorkersUnavailable("mine")])
def test_what_progress_raises_reaches_the_caller(error):
    """Even an OSError, which would otherwise look like a full disk and start the work again."""

    def progress(done, total):
        raise error

    with pytest.raises(type(error)) as caught:
        small_family(workers=2, progress=progress)
    assert caught.value is error


def test_without_worker_processes_the_work_is_done_here(monkeypatch, caplog):
    expected = small_family()
    monkeypatch.setattr(sys, "executable", "/does/not/exist")
    family = small_family(workers=2)
    assert_array_equal(family.eigenfunctions, expected.eigenfunctions)
    assert "Solving in this process instead" in caplog.text


def test_a_frozen_app_does_not_start_itself_again(monkeypatch, caplog):
    expected = small_family()
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    family = small_family(workers=2)
    assert_array_equal(family.eigenfunctions, expected.eigenfunctions)
    assert "no Python interpreter of its own" in caplog.text


def test_a_worker_that_says_much_does_not_block(monkeypatch):
    """A pipe that nobody reads would hold 64 kB, and then the worker for ever."""
    loud = "import sys; sys.stderr.write('x' * 1_000_000); " + processes._START
    monkeypatch.setattr(processes, "_START", loud)
    assert_array_equal(small_family(workers=2).eigenfunctions, small_family().eigenfunctions)


def test_a_worker_that_dies_costs_time_only(monkeypatch, caplog):
    expected = small_family()
    monkeypatch.setattr(processes, "_START", "raise SystemExit('struck by lightning')")
    family = small_family(workers=2)
    assert_array_equal(family.eigenfunctions, expected.eigenfunctions)
    assert "Solving in this process instead: a worker process ended by itself (struck by lightning)" in caplog.text


def forked_worker() -> int:
    """The number of the process that the worker process of this one has forked, as soon as it has."""
    patience = time.monotonic() + 60
    while time.monotonic() < patience:
        for child in _children(os.getpid()):
            for forked in _children(child):
                return forked
        time.sleep(0.02)
    raise AssertionError("no worker was forked")


def _children(process: int) -> list[int]:
    with contextlib.suppress(OSError):  # it has ended
        tasks = Path(f"/proc/{process}/task").glob("*/children")
        return [int(child) for task in tasks for child in task.read_text().split()]
    return []


@pytest.mark.skipif(sys.platform != "linux", reason="workers are forked on Linux only")
def test_a_forked_worker_that_is_killed_costs_time_only(caplog):
    def progress(done, total):
        if done == 1:
            os.kill(forked_worker(), signal.SIGKILL)

    family = small_family(workers=2, progress=progress)
    assert_array_equal(family.eigenfunctions, small_family().eigenfunctions)
    assert "Solving in this process instead: a worker process ended by itself" in caplog.text


@pytest.mark.skipif(sys.platform != "linux", reason="workers are forked on Linux only")
@pytest.mark.parametrize("stop", [False, True])
def test_no_worker_outlives_the_work(stop):
    forked = []

    def progress(done, total):
        if done == 1:
            forked.append(forked_worker())
        return done == 0 or not stop

    with pytest.raises(Cancelled) if stop else contextlib.nullcontext():
        small_family(workers=2, progress=progress)
    assert not Path(f"/proc/{forked[0]}").exists()  # and its CPU time counts among that of whoever asked for the work


def test_a_temporary_folder_that_is_full_costs_a_warning(monkeypatch, caplog):
    expected = small_family()
    monkeypatch.setattr(computation.SpectralJob, "create_output", _no_space)
    family = small_family(workers=2)
    assert_array_equal(family.eigenfunctions, expected.eigenfunctions)
    assert "kept in memory only" in caplog.text


def _no_space(*_):
    raise OSError(28, "No space left on device")


def test_a_fallback_is_named_in_the_family(monkeypatch, caplog):
    def refuse(*_, **__):
        raise np.linalg.LinAlgError("refused")

    monkeypatch.setattr(solver, "shift_invert_lanczos", refuse)
    family = small_family(workers=1)
    assert family.fallbacks == ("dense eigensolver",) * 4
    assert "was solved by the dense eigensolver" in caplog.text


def test_a_script_without_a_main_guard_runs_once(tmp_path):
    """`multiprocessing` would import the script again in every worker; ours never sees it."""
    script = tmp_path / "script.py"
    script.write_text(
        "print('started')\n"
        "from add_core.geometry.shapes import sphere\n"
        "from add_core.spectra import compute_spectra\n"
        "family = compute_spectra(sphere(3), alphas=(9.0,), angles=2, count=10, workers=2, cache=False)\n"
        "print(family.eigenvalues.shape)\n"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, env=environment, check=True)
    assert done.stdout == "started\n(2, 10)\n"
    assert done.stderr == ""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="needs Linux")
def test_a_worker_does_not_count_the_memory_of_whoever_started_it():
    """`ru_maxrss` of a process starts at its parent's peak: a caller with large arrays made every worker look large."""
    ballast = np.ones(60_000_000)
    said = "from add_core.eigensolver.worker import _peak_megabytes; print(_peak_megabytes())"
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", said], capture_output=True, text=True, env=environment, check=True)
    assert 10 < float(done.stdout) < ballast.nbytes / 2**20


def test_it_runs_in_a_thread():
    found = []
    thread = threading.Thread(target=lambda: found.append(small_family(workers=2)))
    thread.start()
    thread.join()
    assert_array_equal(found[0].eigenfunctions, small_family().eigenfunctions)


def test_the_cache_returns_the_same_bits():
    first, second, without = small_family(cache=True), small_family(cache=True), small_family()
    for family in (second, without):
        assert_array_equal(first.eigenvalues, family.eigenvalues)
        assert_array_equal(first.eigenfunctions, family.eigenfunctions)
        assert_array_equal(first.mass, family.mass)


def test_the_cache_tells_every_parameter_apart():
    """A key that missed one would return another family's numbers on the second run."""
    requests = [
        {},
        {"alphas": (0.0, 21.0)},
        {"angles": 4},
        {"count": 21},
        {"conductivity": "constant"},
        {"dtype": "float32"},
    ]
    for _ in range(2):
        for request in requests:
            family, expected = small_family(cache=True, **request), small_family(**request)
            assert family.eigenfunctions.dtype == expected.eigenfunctions.dtype
            assert_array_equal(family.eigenfunctions, expected.eigenfunctions)
    moved = TriangleMesh(SHAPE.vertices * 1.001, SHAPE.faces)
    other = compute_spectra(moved, alphas=(0.0, 20.0), angles=3, count=20)
    assert not np.array_equal(other.eigenvalues, small_family(cache=True).eigenvalues)


def test_a_cached_family_reports_progress_once():
    small_family(cache=True)
    seen = []
    small_family(cache=True, progress=lambda *counts: seen.append(counts))
    assert seen == [(4, 4)]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"alphas": ()}, "alphas must hold at least one number, but it is empty"),
        ({"alphas": (-1.0,)}, "alphas must be finite and at least 0, but it is -1"),
        ({"angles": 0}, "angles must be from 1 to 10000, but it is 0"),
        ({"count": 0}, "count must be from 1 to 642, but it is 0"),
        ({"count": 643}, "count must be from 1 to 642, but it is 643"),
        ({"workers": 0}, "workers must be from 1 to 1024, but it is 0"),
        ({"dtype": "float16"}, "dtype must be one of 'float64', 'float32', but it is 'float16'"),
        ({"conductivity": "metal"}, "conductivity must be one of"),
    ],
)
def test_a_bad_parameter_is_named(options, message):
    with pytest.raises(ParameterError, match=message.replace("(", r"\(")):
        small_family(**options)


def test_count_beyond_the_vertices_with_area_is_refused():
    ball = sphere(2)
    loose = TriangleMesh(np.vstack([ball.vertices, [[5, 5, 5]]]), ball.faces)
    with pytest.raises(ParameterError, match="count must be from 1 to 162, but it is 163"):
        compute_spectra(loose, alphas=(0.0,), count=163, cache=False)


def test_what_is_no_shape_is_refused():
    with pytest.raises(ParameterError, match="shape must be a TriangleMesh or a PointCloud, but it is a str"):
        compute_spectra("bunny.ply")
    flat = TriangleMesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    with pytest.raises(GeometryError):
        compute_spectra(flat, count=1, cache=False)
