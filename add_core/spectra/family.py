"""Spectra of the whole family of anisotropic Laplacians of a shape: every anisotropy, every angle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from hashlib import blake2b
from typing import Literal, get_args

import numpy as np

from .._check import FloatArray, at_least_zero, count_in, instance_of, one_of, read_only
from ..eigensolver.job import SpectralJob
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh
from ..operators import AnisotropicLaplacian, Conductivity
from .cache import SpectraCache
from .computation import Progress, default_workers, run_job
from .spectrum import Spectrum

Precision = Literal["float64", "float32"]

METHOD, METHOD_ON_CLOUDS = 1, 7
"""Raised whenever geometry, operators or solver change a number by more than the accuracy that is promised, so that
cached spectra of an earlier method are not read.
"""


@dataclass(frozen=True, eq=False)
class SpectralFamily:
    """Eigenpairs W φ = λ S φ of C operators of one shape, α by α and angle by angle.

    alphas, thetas : (C,), degree of anisotropy and angle (radians) of each operator.
    eigenvalues : (C, K), 1/length², ascending. eigenfunctions : (C, n, K), 1/length, φᵀSφ = I; float64, or float32 on
        request; perhaps mapped from the cache's file rather than in memory. 0 at vertices without area.
    mass : (n,), length². name, conductivity : of the shape and of the model.
    fallbacks : for operators that block Lanczos could not solve, which method did ('' for all others).

    `family[c]` is the spectrum of one operator, `len(family)` is C.
    """

    alphas: FloatArray
    thetas: FloatArray
    eigenvalues: FloatArray
    eigenfunctions: FloatArray
    mass: FloatArray
    name: str = ""
    conductivity: Conductivity = "curvature"
    fallbacks: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.alphas)

    def __getitem__(self, channel: int) -> Spectrum:
        return Spectrum(self.eigenvalues[channel], self.eigenfunctions[channel], self.mass)

    def __iter__(self) -> Iterator[Spectrum]:
        return (self[channel] for channel in range(len(self)))


def compute_spectra(
    shape: TriangleMesh | PointCloud,
    *,
    alphas: Sequence[float] = (0.0, 25.0, 50.0),
    angles: int = 16,
    count: int = 300,
    conductivity: Conductivity = "curvature",
    progress: Progress | None = None,
    workers: int | None = None,
    cache: bool = True,
    dtype: Precision = "float64",
) -> SpectralFamily:
    """The `count` smallest eigenpairs for every α and the angles θ_l = π l / L, l = 0 … L − 1.

    alphas : degrees of anisotropy ≥ 0; 0 is isotropic, the same for every angle, and appears once, with θ = 0.
    angles : L ≥ 1. count : K, from 1 to the number of vertices that have area (`shape.has_mass`).
    conductivity : "curvature", eq. (9), or "constant", eq. (10); see `AnisotropicLaplacian`.
    progress : called as progress(done, total) in the calling thread, at the start and after every operator. Returning
        False (or raising) stops the work at once and raises Cancelled (or passes the exception on); nothing is kept
        then.
    workers : single-threaded processes that share the work; None takes one for each core, up to four, and none for
        small work; 1 stays in this process. Results do not depend on it, bit for bit.
    cache : look the family up on disk first and keep it there; see `add_core.spectra.cache`.
    dtype : "float32" stores eigenfunctions at half the size; they are computed in float64 all the same.

    Eigenfunctions have a fixed sign: positive at the first vertex where they exceed half of their largest magnitude.
    The first eigenpairs are λ = 0 and the constants of the connected components. Every pair satisfies ‖Wφ − λSφ‖ ≤
    1e-6 λ in the norm of S⁻¹, and none is missed.

    Raises ParameterError for a parameter out of range, GeometryError for a shape without area, ConvergenceError if
    even SciPy fails.
    """
    instance_of("shape", shape, TriangleMesh, PointCloud)
    channels = _channels(alphas, count_in("angles", angles, 1, 10_000))
    conductivity = one_of("conductivity", conductivity, get_args(Conductivity))  # type: ignore[assignment]
    dtype = one_of("dtype", dtype, get_args(Precision))  # type: ignore[assignment]
    count = count_in("count", count, 1, shape.vertex_count)
    if workers is None:
        workers = default_workers(len(channels), shape.vertex_count, count)
    workers = count_in("workers", workers, 1, 1024)
    store = SpectraCache.default() if cache else None
    key = _key(shape, channels, count, conductivity, dtype)
    arrays = None if store is None else store.load(key)
    if arrays is None:
        arrays = run_job(
            lambda: _job(shape, channels, count, conductivity, dtype),
            workers=min(workers, len(channels)),
            progress=progress,
            store=store,
            key=key,
            label=f"{shape.name or 'shape'}, {len(channels)} operators, K = {count}, {conductivity}, {dtype}",
        )
    elif progress is not None:
        progress(len(channels), len(channels))
    return SpectralFamily(
        alphas=read_only(channels[:, 0].copy()),
        thetas=read_only(channels[:, 1].copy()),
        eigenvalues=read_only(np.array(arrays["eigenvalues"])),
        eigenfunctions=read_only(arrays["eigenfunctions"]),
        mass=read_only(np.array(arrays["mass"])),
        name=shape.name,
        conductivity=conductivity,
        fallbacks=tuple(map(str, arrays["fallbacks"])),
    )


def _channels(alphas: Sequence[float], angles: int) -> FloatArray:
    """(C, 2): α and θ of every operator; α = 0 once, whatever the number of angles."""
    degrees = [at_least_zero("alphas", alpha) for alpha in np.atleast_1d(np.asarray(alphas, dtype=object))]
    if not degrees:
        raise ParameterError("alphas must hold at least one number, but it is empty.")
    thetas = np.pi * np.arange(angles) / angles
    return np.concatenate([[(alpha, theta) for theta in (thetas if alpha > 0 else [0.0])] for alpha in degrees])


def _job(
    shape: TriangleMesh | PointCloud, channels: FloatArray, count: int, conductivity: Conductivity, dtype: Precision
) -> SpectralJob:
    laplacian = AnisotropicLaplacian(shape, alpha=channels[0, 0], conductivity=conductivity)
    count_in("count", count, 1, int(np.count_nonzero(laplacian.mass > 0)))
    values = np.empty((len(channels), len(laplacian.pattern.indices)))
    scales = np.empty(len(channels))
    for channel, (alpha, theta) in enumerate(channels):
        if alpha != laplacian.alpha:
            laplacian = laplacian.with_alpha(alpha)
        values[channel], scales[channel] = laplacian.stiffness_values(theta), laplacian.weyl_eigenvalue(count)
    pattern = laplacian.pattern
    return SpectralJob(
        pattern.indptr, pattern.indices, laplacian.mass, values, scales, np.array(count), np.array(dtype == "float32")
    )


def method_of(shape: TriangleMesh | PointCloud) -> int:
    """The version of all that leads from such a shape to numbers: what was kept of an earlier one is computed anew."""
    return METHOD if isinstance(shape, TriangleMesh) else METHOD_ON_CLOUDS


def _key(
    shape: TriangleMesh | PointCloud, channels: FloatArray, count: int, conductivity: Conductivity, dtype: Precision
) -> str:
    """A hash of all that the numbers depend on: the shape's arrays, the parameters, and the version of the method."""
    digest = blake2b(
        f"{method_of(shape)}|{type(shape).__name__}|{count}|{conductivity}|{dtype}".encode(), digest_size=20
    )
    second = shape.faces if isinstance(shape, TriangleMesh) else shape.normals
    for array in (shape.vertices, second, channels):
        if array is None:
            digest.update(b"none")
        else:
            digest.update(f"{array.dtype}{array.shape}".encode())
            digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()
