"""What it takes to solve many operators on one pattern, in memory or as a folder of arrays that worker processes
share.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.lib.format import open_memmap
from numpy.typing import NDArray

from .._check import FloatArray, IntArray

EIGENFUNCTIONS = "eigenfunctions.npy"


@dataclass(frozen=True, eq=False)
class SpectralJob:
    """C operators on one sparsity pattern.

    indptr, indices : the pattern, diagonal stored. mass : (n,). values : (C, nnz), the entries of each W.
    scales : (C,), estimates of the largest eigenvalue asked for. count : (), K. single : (), store float32 instead of
        float64.
    """

    indptr: IntArray
    indices: IntArray
    mass: FloatArray
    values: FloatArray
    scales: FloatArray
    count: NDArray[np.int64]
    single: NDArray[np.bool_]

    @property
    def dtype(self) -> np.dtype[np.floating]:
        return np.dtype(np.float32 if self.single else np.float64)

    @property
    def output_shape(self) -> tuple[int, int, int]:
        """(C, n, K)."""
        return len(self.values), len(self.mass), int(self.count)

    @property
    def output_bytes(self) -> int:
        return int(np.prod(self.output_shape)) * self.dtype.itemsize

    def save(self, folder: Path) -> None:
        for field in fields(self):
            np.save(folder / f"{field.name}.npy", getattr(self, field.name), allow_pickle=False)

    @classmethod
    def load(cls, folder: Path) -> SpectralJob:
        """The values stay on disk until an operator needs its own."""
        arrays = {
            field.name: np.load(
                folder / f"{field.name}.npy", mmap_mode="r" if field.name == "values" else None, allow_pickle=False
            )
            for field in fields(cls)
        }
        return cls(**arrays)

    def create_output(self, folder: Path) -> None:
        """An empty file for all eigenfunctions, (C, n, K)."""
        open_memmap(folder / EIGENFUNCTIONS, mode="w+", dtype=self.dtype, shape=self.output_shape).flush()

    def write_output(self, folder: Path, channel: int, functions: FloatArray) -> None:
        """Put the eigenfunctions (n, K) of one operator into the file; plain writes, so that a process maps nothing."""
        part = np.ascontiguousarray(functions, dtype=self.dtype)
        left = part.data.cast("B")
        with open(folder / EIGENFUNCTIONS, "r+b", buffering=0) as file:  # a buffer would write it page by page
            file.seek(-self.output_bytes + channel * part.nbytes, 2)
            while left:
                left = left[file.write(left) :]
