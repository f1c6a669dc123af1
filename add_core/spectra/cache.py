"""Spectra on disk: computed once, read back bit for bit.

Every family of spectra is one folder of plain .npy arrays with a manifest of checksums, named by a hash of everything
that went into it. Folders appear by one rename, so a process that dies while writing leaves no half entry; what is
read is verified, and a damaged entry is dropped and computed again. The least recently used entries make room when
the limit is reached.

The folder is the platform's cache folder, or $ADD_CACHE_DIR; the limit is 8 GB, or $ADD_CACHE_GB.
"""

from __future__ import annotations

import json
import logging
import os
import shutil
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path
from typing import Any

import numpy as np
import platformdirs

_log = logging.getLogger(__name__)

FORMAT = 1
"""Of the files and of the numbers: raised whenever either changes, so that entries of another version are never read.
"""

_MANIFEST = "entry.json"
_SCRATCH = ".writing-"
STALE = 24 * 3600.0
"""Seconds after which what is still being written has been given up."""
_BLOCK = 1 << 22

Arrays = dict[str, np.ndarray[Any, Any]]


@dataclass(frozen=True)
class CacheEntry:
    """One family on disk. size : bytes. used : seconds since 1970. label : what it holds, for people."""

    key: str
    label: str
    size: int
    used: float


@dataclass(frozen=True)
class SpectraCache:
    """A folder of entries. limit : bytes, kept by dropping the least recently used."""

    folder: Path
    limit: int

    @classmethod
    def default(cls) -> SpectraCache:
        """The user's own cache, where the environment says."""
        chosen = os.environ.get("ADD_CACHE_DIR")
        root = Path(chosen) if chosen else platformdirs.user_cache_path("anisotropic-diffusion-descriptors", False)
        try:
            limit = float(os.environ.get("ADD_CACHE_GB", ""))
        except ValueError:
            limit = 8.0
        return cls(root.expanduser() / "spectra", int(limit * 1e9))

    def entries(self) -> list[CacheEntry]:
        """Everything kept, most recently used first."""
        found = []
        for path in self._paths():
            with suppress(OSError, ValueError):
                manifest = json.loads((path / _MANIFEST).read_text(encoding="utf-8"))
                size = sum(file.stat().st_size for file in path.iterdir())
                found.append(CacheEntry(path.name, str(manifest["label"]), size, (path / _MANIFEST).stat().st_mtime))
        return sorted(found, key=lambda entry: -entry.used)

    def clear(self) -> int:
        """Drop everything; returns how many bytes that freed."""
        freed = sum(entry.size for entry in self.entries())
        for path in self._paths():
            self._drop(path)
        remove_abandoned(self.folder, _SCRATCH, 0.0)
        return freed

    def load(self, key: str) -> Arrays | None:
        """The arrays of an entry, each of its shape as kept, memory-mapped and read-only, or None if there is none.

        Every byte is checked first. A damaged entry is dropped with a warning.
        """
        path = self.folder / key
        try:
            manifest = _sealed(json.loads((path / _MANIFEST).read_text(encoding="utf-8")), key)
            arrays = {}
            for name, digest in manifest["files"].items():
                if _digest(path / f"{name}.npy") != digest:
                    raise ValueError(f"{name}.npy does not match its checksum")
                arrays[name] = np.asarray(np.load(path / f"{name}.npy", mmap_mode="r", allow_pickle=False))
        except FileNotFoundError:
            if not (path / _MANIFEST).parent.is_dir():
                return None
            self._damaged(path, "a file is missing")
            return None
        except (ValueError, KeyError, TypeError, AttributeError, EOFError) as error:
            self._damaged(path, str(error))
            return None
        except OSError as error:
            _log.warning("Cached spectra in %s cannot be read (%s); computing them instead.", path, error)
            return None
        with suppress(OSError):
            os.utime(path / _MANIFEST)
        return arrays

    @contextmanager
    def scratch(self, size: int) -> Iterator[Path]:
        """A folder beside the entries to write `size` bytes into; it is gone afterwards unless `commit` took it.

        Raises OSError if the disk or the limit has no room for that, or the folder cannot be written.
        """
        if size > self.limit:
            raise OSError(f"{size / 1e9:.3g} GB exceed the limit of {self.limit / 1e9:.3g} GB (set ADD_CACHE_GB)")
        self.folder.mkdir(parents=True, exist_ok=True)
        remove_abandoned(self.folder, _SCRATCH)
        self._make_room(size)
        folder = Path(tempfile.mkdtemp(prefix=_SCRATCH, dir=self.folder))
        try:
            free = shutil.disk_usage(folder).free
            if free < 1.02 * size:
                raise OSError(f"only {free / 1e9:.3g} GB of {size / 1e9:.3g} GB are free in {self.folder}")
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def commit(self, folder: Path, key: str, arrays: Mapping[str, np.ndarray[Any, Any]], label: str) -> Arrays:
        """Let a scratch folder become the entry `key`, `arrays` beside the .npy files that it already holds.

        arrays : of any shapes, such as eigenvalues (C, K). Returns what `load` would. Raises OSError if the disk fails.
        """
        for name, array in arrays.items():
            np.save(folder / f"{name}.npy", array, allow_pickle=False)
        files = {}
        for file in sorted(folder.glob("*.npy")):
            files[file.stem] = _digest(file)
            _flush(file)
        manifest = {"format": FORMAT, "key": key, "label": label, "created": time.time(), "files": files}
        manifest["seal"] = _seal(manifest)
        (folder / _MANIFEST).write_text(json.dumps(manifest, indent=1), encoding="utf-8")
        _flush(folder / _MANIFEST)
        try:
            os.replace(folder, self.folder / key)
        except OSError:
            # Another process was first (its numbers are the same), or a damaged entry is in the way.
            if self.load(key) is None:
                self._drop(self.folder / key)
                os.replace(folder, self.folder / key)
        _flush(self.folder)
        kept = self.folder / key
        return {name: np.asarray(np.load(kept / f"{name}.npy", mmap_mode="r", allow_pickle=False)) for name in files}

    def _paths(self) -> list[Path]:
        try:
            return [path for path in self.folder.iterdir() if path.is_dir() and not path.name.startswith(".")]
        except OSError:
            return []

    def _damaged(self, path: Path, reason: str) -> None:
        _log.warning("Cached spectra in %s are damaged (%s); computing them again.", path, reason)
        self._drop(path)

    def _drop(self, path: Path) -> None:
        """Remove an entry by renaming it first, so that no other process sees half of it."""
        with suppress(OSError):
            grave = tempfile.mkdtemp(prefix=_SCRATCH, dir=self.folder)
            with suppress(OSError):
                os.replace(path, Path(grave) / path.name)
            shutil.rmtree(grave, ignore_errors=True)

    def _make_room(self, size: int) -> None:
        used = 0
        for entry in self.entries():
            used += entry.size
            if used + size > self.limit:
                self._drop(self.folder / entry.key)


def remove_abandoned(folder: Path, prefix: str, age: float = STALE) -> None:
    """Remove folders that processes which died left behind, those that nothing was written to for `age` seconds."""
    with suppress(OSError):
        for path in folder.glob(f"{prefix}*"):
            with suppress(OSError):
                if time.time() - path.stat().st_mtime >= age:
                    shutil.rmtree(path, ignore_errors=True)


def _digest(path: Path) -> str:
    digest = blake2b(digest_size=16)
    with open(path, "rb") as file:
        while block := file.read(_BLOCK):
            digest.update(block)
    return digest.hexdigest()


def _seal(manifest: Mapping[str, Any]) -> str:
    text = json.dumps({name: value for name, value in manifest.items() if name != "seal"}, sort_keys=True)
    return blake2b(text.encode(), digest_size=16).hexdigest()


def _sealed(manifest: dict[str, Any], key: str) -> dict[str, Any]:
    if manifest.get("seal") != _seal(manifest) or manifest["format"] != FORMAT or manifest["key"] != key:
        raise ValueError(f"{_MANIFEST} does not match its checksum")
    return manifest


def _flush(path: Path) -> None:
    """Force a file or folder to the disk; without this a power cut could leave a name without its bytes."""
    if path.is_dir() and os.name == "nt":
        return
    handle = os.open(path, os.O_RDONLY if os.name != "nt" else os.O_RDWR)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
