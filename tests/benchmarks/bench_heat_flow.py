"""Live heat kernels: from a change of θ, α, source or time to the new kernel, against what a user would otherwise pick.

The other ways: an expansion in 300 eigenfunctions of eigsh, anew for every α and θ, and implicit Euler steps.
"""

from __future__ import annotations

from collections.abc import Callable
from statistics import median
from time import perf_counter

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh, splu
from threadpoolctl import threadpool_limits

from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import split_in_four
from add_core.io import humans, poses
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import HeatFlow

SOURCE, SPREAD, COUNT = 1000, 5.0, 300


def milliseconds(action: Callable[[int], object], repeats: int) -> float:
    """Median time of `action(k)`, k = 1 … repeats, after one call that does not count."""
    action(0)
    times = []
    for k in range(1, repeats + 1):
        start = perf_counter()
        action(k)
        times.append(1e3 * (perf_counter() - start))
    return median(times)


def live(mesh: TriangleMesh, repeats: int) -> dict[str, float]:
    """Milliseconds from each kind of change to the new kernel."""
    laplacian = AnisotropicLaplacian(mesh, alpha=50.0)
    time = SPREAD / laplacian.weyl_eigenvalue(COUNT)
    flow = HeatFlow(laplacian)
    return {
        "θ": milliseconds(lambda k: flow.kernel(SOURCE, theta=0.01 * k, time=time), repeats),
        "α": milliseconds(
            lambda k: HeatFlow(laplacian.with_alpha(50.0 + k)).kernel(SOURCE, theta=0.3, time=time), repeats
        ),
        "source": milliseconds(lambda k: flow.kernel(SOURCE + k, theta=0.3, time=time), repeats),
        "t": milliseconds(lambda k: flow.kernel(SOURCE, theta=0.3, time=time * (1 + 1e-4 * k)), repeats),
    }


def euler(laplacian: AnisotropicLaplacian, time: float, steps: int = 16) -> Callable[[int], np.ndarray]:
    """A kernel by implicit Euler steps, as most would write it."""
    mass = diags_array(laplacian.mass)

    def kernel(k: int) -> np.ndarray:
        solve = splu((mass + time / steps * laplacian.stiffness(0.01 * k)).tocsc(), permc_spec="MMD_AT_PLUS_A").solve
        heat = np.zeros(len(laplacian.mass))
        heat[SOURCE] = 1 / laplacian.mass[SOURCE]
        for _ in range(steps):
            heat = solve(laplacian.mass * heat)
        return heat

    return kernel


def expansion(laplacian: AnisotropicLaplacian, time: float) -> Callable[[int], np.ndarray]:
    """A kernel from 300 eigenfunctions of eigsh."""
    mass = diags_array(laplacian.mass).tocsc()

    def kernel(k: int) -> np.ndarray:
        values, vectors = eigsh(laplacian.stiffness(0.01 * k).tocsc(), k=COUNT, M=mass, sigma=-1e-8)
        return vectors @ (np.exp(-time * values) * vectors[SOURCE])

    return kernel


def main() -> None:
    person = humans()[0]
    large = split_in_four(poses()[0])
    print(f"{'vertices':>9} {'θ ms':>8} {'α ms':>8} {'source ms':>10} {'t ms':>8}")
    for mesh, repeats in ((person, 31), (poses()[0], 15), (large, 7)):
        row = live(mesh, repeats)
        print(
            f"{mesh.vertex_count:9d} {row['θ']:8.1f} {row['α']:8.1f} {row['source']:10.1f} {row['t']:8.2f}", flush=True
        )
    laplacian = AnisotropicLaplacian(person, alpha=50.0)
    time = SPREAD / laplacian.weyl_eigenvalue(COUNT)
    flow = HeatFlow(laplacian)
    exact = HeatFlow(laplacian, tolerance=1e-10).kernel(SOURCE, theta=0.0, time=time)
    ours = milliseconds(lambda k: flow.kernel(SOURCE, theta=0.01 * k, time=time), 15)
    print(f"\nAgainst others at {person.vertex_count} vertices, t·λ₃₀₀ = {SPREAD:g}, a change of θ:")
    print(f"{'method':>28} {'ms':>9} {'ratio':>7} {'error':>9}")
    others = {
        "16 implicit Euler steps": (euler(laplacian, time), 5),
        "300 eigenfunctions, eigsh": (expansion(laplacian, time), 1),
    }
    rows = {"HeatFlow": (ours, flow.kernel(SOURCE, theta=0.0, time=time))}
    rows |= {name: (milliseconds(make, repeats), make(0)) for name, (make, repeats) in others.items()}
    for name, (taken, kernel) in rows.items():
        error = np.sqrt(laplacian.mass @ (kernel - exact) ** 2) / np.sqrt(laplacian.mass @ exact**2)
        print(f"{name:>28} {taken:9.1f} {taken / ours:7.1f} {error:9.1e}")


if __name__ == "__main__":
    with threadpool_limits(1):
        main()
