"""The family of spectra against SciPy's eigsh on the same operators, in the same run: time, memory and accuracy.

Times of `compute_spectra` include everything: frames, operators, ordering, start of processes, verification and
eigenfunctions on disk. eigsh gets its operator ready-made (shift −1e-8, LAPACK and BLAS with one thread).
"""

from __future__ import annotations

import argparse
import os
import resource
import threading
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh
from threadpoolctl import threadpool_limits

from add_core.geometry import PointCloud, TriangleMesh, subsample
from add_core.geometry.shapes import split_in_four
from add_core.io import humans, poses
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import SpectralFamily, compute_spectra

ALPHA, WORKERS = 50.0, 2
HEADER = (
    f"{'shape':<22}{'n':>7}{'K':>5}{'L':>4} {'eigsh s/op':>11}{'CPU':>7} {'ours s/op':>11}{'CPU':>7}"
    f" {'times faster':>13}{'less CPU':>9} {'MB/process':>11} {'residual':>9}{'orthonorm.':>11}{'Δλ/λ':>9}"
)


def serial(laplacian: AnisotropicLaplacian, theta: float, count: int) -> tuple[float, float, np.ndarray]:
    """Wall and CPU seconds of eigsh, and its eigenvalues."""
    stiffness, mass = laplacian.stiffness(theta).tocsc(), diags_array(laplacian.mass).tocsc()
    wall, cpu = perf_counter(), process_time()
    with threadpool_limits(1):
        values = eigsh(stiffness, k=count, M=mass, sigma=-1e-8, which="LM", return_eigenvectors=True)[0]
    return perf_counter() - wall, process_time() - cpu, np.sort(values)


def parallel(shape: TriangleMesh | PointCloud, angles: int, count: int) -> tuple[float, float, float, SpectralFamily]:
    """Wall and CPU seconds of the whole family, MB of its largest process at its peak, and the family."""
    wall, cpu = perf_counter(), _cpu()
    with PeakOfChildren() as watch:
        family = compute_spectra(shape, alphas=(ALPHA,), angles=angles, count=count, workers=WORKERS, cache=False)
    return perf_counter() - wall, _cpu() - cpu, watch.megabytes, family


class PeakOfChildren:
    """Watches the processes started by this one, on Linux. `getrusage` would not do: it counts this process's own peak
    among that of each process that it starts."""

    megabytes = float("nan")

    def __enter__(self) -> PeakOfChildren:
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._done.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._done.wait(0.05):
            for child in _descendants("self"):
                words = _words(Path("/proc", child, "status"))
                if "VmHWM:" in words:
                    self.megabytes = np.fmax(self.megabytes, int(words[words.index("VmHWM:") + 1]) / 1024)


def _descendants(process: str) -> set[str]:
    children = {word for file in Path("/proc", process, "task").glob("*/children") for word in _words(file)}
    return children.union(*map(_descendants, children))


def _words(file: Path) -> list[str]:
    try:
        return file.read_text().split()
    except OSError:  # it has ended
        return []


def _cpu() -> float:
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return process_time() + children.ru_utime + children.ru_stime


def accuracy(laplacian: AnisotropicLaplacian, family: SpectralFamily) -> tuple[float, float]:
    """Largest relative residual in the norm of S⁻¹ over every positive pair, and largest entry of |φᵀSφ − I|."""
    mass, residual, skew = laplacian.mass, 0.0, 0.0
    for theta, spectrum in zip(family.thetas, family, strict=True):
        phi, values = spectrum.eigenfunctions, spectrum.eigenvalues
        defect = laplacian.stiffness(theta) @ phi - mass[:, None] * phi * values
        norms = np.sqrt((defect**2 / mass[:, None]).sum(axis=0))
        positive = values > 0
        residual = max(residual, float((norms[positive] / values[positive]).max()))
        skew = max(skew, float(np.abs(phi.T @ (mass[:, None] * phi) - np.eye(len(values))).max()))
    return residual, skew


def row(shape: TriangleMesh | PointCloud, *, angles: int, count: int, repeats: int) -> str:
    laplacian = AnisotropicLaplacian(shape, alpha=ALPHA)
    times, memory, gap = [], 0.0, 0.0
    for repeat in range(repeats):
        channel = (5 * repeat) % angles
        wall, cpu, expected = serial(laplacian, np.pi * channel / angles, count)
        all_wall, all_cpu, megabytes, family = parallel(shape, angles, count)
        memory = np.fmax(memory, megabytes)
        times.append((wall, cpu, all_wall / angles, all_cpu / angles, wall * angles / all_wall, cpu * angles / all_cpu))
        gap = max(gap, float(np.abs(family.eigenvalues[channel] / expected - 1)[1:].max()))
    wall, cpu, our_wall, our_cpu, faster, less = (median(column) for column in zip(*times, strict=True))
    residual, skew = accuracy(laplacian, family)
    assert family.fallbacks == ("",) * angles
    return (
        f"{shape.name:<22}{shape.vertex_count:>7}{count:>5}{angles:>4} {wall:>11.2f}{cpu:>7.2f} {our_wall:>11.3f}"
        f"{our_cpu:>7.2f} {faster:>12.1f}×{less:>8.1f}× {memory:>11.0f} {residual:>9.0e}{skew:>11.0e}{gap:>9.0e}"
    )


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--repeats", type=int, default=3, help="of the first row (default: 3)")
    arguments.add_argument("--only-first", action="store_true", help="one person of 6,890 vertices, and nothing larger")
    options = arguments.parse_args()
    print(
        f"Spectra at α = {ALPHA:.0f}: {WORKERS} single-threaded processes on {os.cpu_count()} cores against one eigsh"
    )
    print(HEADER)
    person = humans()[0]
    print(row(person, angles=16, count=300, repeats=options.repeats), flush=True)
    if options.only_first:
        return
    pose = poses()[0]
    fine = split_in_four(person)
    larger = [pose, fine, split_in_four(pose)]
    for mesh in larger:
        print(row(mesh, angles=4, count=300, repeats=1), flush=True)
    cloud = subsample(person, 4000).cloud
    print(row(cloud, angles=2, count=900, repeats=1), flush=True)


if __name__ == "__main__":
    main()
