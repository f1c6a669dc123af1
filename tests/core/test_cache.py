"""Spectra on disk: whatever happens to the disk, the numbers are right."""

import json
import logging
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import add_core
from add_core.geometry.shapes import ellipsoid
from add_core.spectra import SpectraCache, cache, compute_spectra

SHAPE = ellipsoid(1.0, 0.8, 0.5, subdivisions=2)
ARRAYS = {"eigenvalues": np.arange(6.0), "eigenfunctions": np.arange(24.0).reshape(2, 3, 4)}
ROOT = Path(add_core.__file__).parents[1]


@pytest.fixture
def store(tmp_path, monkeypatch) -> SpectraCache:
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    return SpectraCache.default()


def keep(store: SpectraCache, key: str, arrays=ARRAYS, label="a label") -> dict[str, np.ndarray]:
    with store.scratch(1000) as folder:
        return store.commit(folder, key, arrays, label)


def family(**options):
    return compute_spectra(SHAPE, alphas=(0.0, 10.0), angles=2, count=12, **options)


@pytest.fixture(scope="module")
def expected():
    return family(cache=False)


def same(one, other) -> None:
    assert_array_equal(one.eigenvalues, other.eigenvalues)
    assert_array_equal(one.eigenfunctions, other.eigenfunctions)


def only_entry(store: SpectraCache) -> Path:
    (entry,) = store.entries()
    return store.folder / entry.key


def test_what_was_kept_is_read_back(store):
    for arrays in (keep(store, "key"), store.load("key")):
        assert arrays.keys() == ARRAYS.keys()
        for name, array in ARRAYS.items():
            assert_array_equal(arrays[name], array)
            assert not arrays[name].flags.writeable
    assert store.load("another key") is None


def test_entries_are_listed_by_last_use_and_cleared(store):
    for number, key in enumerate("abc"):
        keep(store, key, label=f"family {key}")
        os.utime(store.folder / key / "entry.json", (1000 + number, 1000 + number))
    store.load("a")
    assert [entry.key for entry in store.entries()] == ["a", "c", "b"]
    assert store.entries()[0].label == "family a"
    sizes = [entry.size for entry in store.entries()]
    assert min(sizes) > sum(array.nbytes for array in ARRAYS.values())
    assert store.clear() == sum(sizes)
    assert store.entries() == []
    assert list(store.folder.iterdir()) == []


def test_the_least_recently_used_make_room(store):
    for number, key in enumerate("abcd"):
        keep(store, key)
        os.utime(store.folder / key / "entry.json", (1000 + number, 1000 + number))
    store.load("a")
    size = store.entries()[0].size
    small = SpectraCache(store.folder, limit=int(3.5 * size))
    with small.scratch(size) as folder:
        small.commit(folder, "e", ARRAYS, "")
    assert {entry.key for entry in small.entries()} == {"a", "d", "e"}


def test_what_exceeds_the_limit_is_refused(store):
    with pytest.raises(OSError, match=r"2 GB exceed the limit of 1 GB \(set ADD_CACHE_GB\)"):
        SpectraCache(store.folder, limit=10**9).scratch(2 * 10**9).__enter__()


def test_the_environment_chooses_folder_and_limit(monkeypatch, tmp_path):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path))
    monkeypatch.setenv("ADD_CACHE_GB", "0.5")
    assert SpectraCache.default() == SpectraCache(tmp_path / "spectra", 500_000_000)


@pytest.mark.parametrize("name", ["eigenfunctions.npy", "eigenvalues.npy", "mass.npy", "entry.json"])
def test_a_flipped_bit_anywhere_is_noticed_and_mended(store, expected, caplog, name):
    family()
    path = only_entry(store) / name
    raw = bytearray(path.read_bytes())
    for position in (0, len(raw) // 2, len(raw) - 3):
        flipped = raw.copy()
        flipped[position] ^= 4
        path.write_bytes(flipped)
        caplog.clear()
        same(family(), expected)
        assert "are damaged" in caplog.text
        caplog.clear()
        same(family(), expected)
        assert caplog.text == "", "the entry was rebuilt"


@pytest.mark.parametrize("name", ["eigenfunctions.npy", "entry.json"])
@pytest.mark.parametrize("size", [0, 1, 50])
def test_a_truncated_file_is_noticed_and_mended(store, expected, caplog, name, size):
    family()
    os.truncate(only_entry(store) / name, size)
    same(family(), expected)
    assert "are damaged" in caplog.text
    assert len(store.entries()) == 1


def test_a_missing_file_is_noticed_and_mended(store, expected, caplog):
    family()
    (only_entry(store) / "eigenvalues.npy").unlink()
    same(family(), expected)
    assert "are damaged (a file is missing)" in caplog.text


def test_an_entry_that_belongs_elsewhere_is_not_read(store, caplog):
    keep(store, "key")
    (store.folder / "key").rename(store.folder / "other")
    assert store.load("other") is None
    assert "are damaged" in caplog.text


def test_another_format_is_not_read(store, monkeypatch):
    keep(store, "key")
    monkeypatch.setattr(cache, "FORMAT", cache.FORMAT + 1)
    assert store.load("key") is None


def test_nothing_in_an_entry_can_run_code(store, caplog):
    """A pickled array in place of a plain one is refused even if its checksum was forged to match."""
    keep(store, "key")
    path = store.folder / "key"
    np.save(path / "eigenvalues.npy", np.array([{"code": "runs"}], dtype=object), allow_pickle=True)
    manifest = json.loads((path / "entry.json").read_text())
    manifest["files"]["eigenvalues"] = cache._digest(path / "eigenvalues.npy")
    manifest["seal"] = cache._seal(manifest)
    (path / "entry.json").write_text(json.dumps(manifest))
    assert store.load("key") is None


KILLED = """
import os, signal, sys
from add_core.spectra import cache, compute_spectra
from add_core.eigensolver.job import SpectralJob
from add_core.geometry.shapes import ellipsoid

moment, steps = sys.argv[1], 0
def killing(original, at):
    def call(*args, **kwargs):
        global steps
        steps += 1
        if steps == at:
            os.kill(os.getpid(), signal.SIGKILL)
        return original(*args, **kwargs)
    return call

if moment == "eigenfunctions":
    SpectralJob.write_output = killing(SpectralJob.write_output, 2)
elif moment == "checksums":
    cache._digest = killing(cache._digest, 2)
elif moment == "manifest":
    cache._seal = killing(cache._seal, 1)
elif moment == "rename":
    cache.os.replace = killing(os.replace, 1)
compute_spectra(ellipsoid(1.0, 0.8, 0.5, subdivisions=2), alphas=(0.0, 10.0), angles=2, count=12)
"""


@pytest.mark.skipif(os.name == "nt", reason="needs SIGKILL")
@pytest.mark.parametrize("moment", ["eigenfunctions", "checksums", "manifest", "rename"])
def test_a_process_killed_while_writing_leaves_no_half_entry(store, expected, caplog, moment):
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    killed = subprocess.run([sys.executable, "-c", KILLED, moment], env=environment, capture_output=True, check=False)
    assert killed.returncode == -9, killed.stderr
    assert store.entries() == []
    assert len(list(store.folder.iterdir())) == 1, "its scratch folder"
    same(family(), expected)
    assert "damaged" not in caplog.text
    old = time.time() - 100_000
    for leftover in store.folder.glob(".*"):
        os.utime(leftover, (old, old))
    keep(store, "next")
    assert sorted(path.name for path in store.folder.iterdir()) == sorted(entry.key for entry in store.entries())


def test_two_processes_at_once_agree(store, expected):
    code = (
        "from add_core.spectra import compute_spectra; from add_core.geometry.shapes import ellipsoid\n"
        "shape = ellipsoid(1.0, 0.8, 0.5, subdivisions=2)\n"
        "f = compute_spectra(shape, alphas=(0.0, 10.0), angles=2, count=12)\n"
        "print(f.eigenvalues.sum().hex(), f.eigenfunctions.sum().hex())\n"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    running = [
        subprocess.Popen([sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE, text=True)
        for _ in range(3)
    ]
    said = {process.communicate()[0] for process in running}
    assert said == {f"{expected.eigenvalues.sum().hex()} {expected.eigenfunctions.sum().hex()}\n"}
    assert len(store.entries()) == 1


def test_the_second_writer_of_an_entry_reads_the_first_ones(store):
    keep(store, "key")
    arrays = keep(store, "key")
    assert_array_equal(arrays["eigenvalues"], ARRAYS["eigenvalues"])
    assert len(store.entries()) == 1
    assert len(list(store.folder.iterdir())) == 1


def test_an_entry_dropped_while_in_use_stays_usable(store):
    """Another process may clear the cache; what is mapped stays mapped (on Windows the file stays instead)."""
    arrays = keep(store, "key")
    store.clear()
    assert_array_equal(arrays["eigenfunctions"], ARRAYS["eigenfunctions"])


def _raise(number: int):
    def call(*_, **__):
        raise OSError(number, os.strerror(number))

    return call


@pytest.mark.parametrize(
    ("owner", "name", "number"),
    [
        (cache.tempfile, "mkdtemp", 30),  # read-only file system
        (cache.np, "save", 28),  # full disk
        (cache.os, "fsync", 5),  # broken disk
        (cache.os, "replace", 13),  # no permission
    ],
    ids=["read-only", "full", "broken", "forbidden"],
)
def test_a_disk_that_fails_costs_a_warning(store, expected, caplog, monkeypatch, owner, name, number):
    with monkeypatch.context() as patch:
        patch.setattr(owner, name, _raise(number))
        same(family(workers=1), expected)
    assert [record.levelno for record in caplog.records] == [logging.WARNING]
    assert os.strerror(number) in caplog.text
    assert store.entries() == []


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="mounts a small file system")
def test_a_full_disk_costs_a_warning(expected, caplog, monkeypatch, tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(disk)]
    if os.geteuid() != 0 or subprocess.run(mount, check=False, capture_output=True).returncode != 0:
        pytest.skip("needs the right to mount")
    try:
        monkeypatch.setenv("ADD_CACHE_DIR", str(disk))
        same(family(), expected)
        assert "Spectra cannot be cached" in caplog.text
        assert "are free in" in caplog.text
    finally:
        subprocess.run(["umount", str(disk)], check=True)


@pytest.mark.skipif(os.name == "nt", reason="needs folders without write permission")
def test_a_read_only_folder_still_serves_what_it_holds(store, expected, caplog, monkeypatch):
    family()
    store.folder.chmod(0o500)
    try:
        same(family(), expected)
        assert caplog.text == ""
        with monkeypatch.context() as patch:  # the superuser may write anywhere, so forbid it here
            patch.setattr(cache.tempfile, "mkdtemp", _raise(13))
            other = compute_spectra(SHAPE, alphas=(3.0,), angles=1, count=5)
        assert other.eigenvalues.shape == (1, 5)
        assert "Spectra cannot be cached" in caplog.text
    finally:
        store.folder.chmod(0o700)


def test_a_cache_folder_that_is_a_file_costs_a_warning(expected, caplog, monkeypatch, tmp_path):
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "file"))
    same(family(), expected)
    assert "Spectra cannot be cached" in caplog.text
