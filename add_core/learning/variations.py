"""Training shapes that differ from those at hand as scans differ from templates: other bodies, skins and meshings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, IntArray
from ..errors import ParameterError
from ..geometry import TriangleMesh
from .augmentation import bend, blur, remesh, roughen, scatter
from .training_set import UNKNOWN, TrainingShape

BEND, WAVELENGTH = (0.001, 0.010), (0.12, 0.5)
"""Amplitude and shortest wave of the other body, of the bounding box's diagonal."""
SKIN, SCANNER = (0.05, 0.3), (0.01, 0.12)
"""Amplitudes of other muscles and of a scanner's noise, of the mean edge length; even on a logarithmic scale."""
COUNTS = (0.5, 1.1)
"""Vertices of a new meshing, of the old one's; a cloud has up to four fifths of these."""
UNEVENNESS = (0.0, 0.8)
REMESHED, CLOUD = 0.38, 0.22
"""Shares of the variations that get triangles of their own, and that are clouds of points."""


def vary(item: TrainingShape, *, seed: int, middles: IntArray | None = None) -> TrainingShape:
    """Another body of the same places as a scanner or another meshing would have it.

    It is bent, perhaps blurred, perhaps given other muscles; then it keeps its triangles, or is meshed anew, evenly or
    not, or becomes a cloud, with or without normals; and most get a scanner's noise. The places, shape (n,), go with
    the vertices that stay. middles : (e,), places of the middles of the mesh's edges, see `Middles`; unknown without.

    A cloud given is returned as it is.
    """
    if not isinstance(item.shape, TriangleMesh):
        return item
    draw = np.random.default_rng(seed)
    mesh = bend(item.shape, amplitude=draw.uniform(*BEND), wavelength=draw.uniform(*WAVELENGTH), seed=seed)
    if draw.random() < 0.3:
        mesh = blur(mesh, steps=int(draw.integers(1, 6)))
    if draw.random() < 0.5:
        mesh = roughen(mesh, amplitude=_even_logarithm(draw, SKIN), smoothing=int(draw.integers(5, 31)), seed=seed)
    places = np.asarray(item.places)
    known = np.concatenate([places, np.full(len(mesh.edges), UNKNOWN) if middles is None else middles])
    kind, share = draw.random(), draw.uniform(*COUNTS)
    unevenness = draw.uniform(*UNEVENNESS) if draw.random() < 0.5 else 0.0
    if kind < REMESHED:
        twin = remesh(mesh, max(4, int(share * mesh.vertex_count)), seed=seed, unevenness=unevenness)
        mesh, places = twin.mesh, known[twin.origin]
    if draw.random() < 0.7:
        mesh = roughen(mesh, amplitude=_even_logarithm(draw, SCANNER), smoothing=int(draw.integers(0, 4)), seed=seed)
    if kind > 1 - CLOUD:
        count = max(4, int(0.8 * share * mesh.vertex_count))
        with_normals = draw.random() < 2 / 3
        part = scatter(mesh, count, seed=seed, unevenness=unevenness, with_normals=with_normals)
        return TrainingShape(part.cloud, known[part.origin])
    return TrainingShape(mesh, places)


def _even_logarithm(draw: np.random.Generator, ends: tuple[float, float]) -> float:
    return float(np.exp(draw.uniform(*np.log(ends))))


def blend(meshes: Sequence[TriangleMesh], weights: ArrayLike) -> TriangleMesh:
    """A body between bodies in one pose, or beyond: Σ w_i vertices_i, each turned and moved onto the first.

    weights : shape (len(meshes),), made to sum to 1; negative ones exaggerate. Raises ParameterError if the meshes
    differ in their faces or weights do not fit.
    """
    shares = np.asarray(weights, dtype=np.float64)
    if shares.shape != (len(meshes),) or not np.isfinite(shares).all() or abs(shares.sum()) < 1e-9:
        raise ParameterError(f"weights must be {len(meshes)} finite numbers with a sum, but they are {weights!r}.")
    first = meshes[0]
    if not all(np.array_equal(mesh.faces, first.faces) for mesh in meshes):
        raise ParameterError("meshes must share their faces to be blended, but they differ.")
    moved = [_onto(mesh.vertices, first.vertices) for mesh in meshes]
    return TriangleMesh(np.tensordot(shares / shares.sum(), moved, axes=1), first.faces, name=first.name)


def _onto(vertices: FloatArray, target: FloatArray) -> FloatArray:
    """The rigid motion that brings `vertices` nearest to `target`, by Kabsch 1976."""
    here, there = vertices.mean(axis=0), target.mean(axis=0)
    u, _, v = np.linalg.svd((vertices - here).T @ (target - there))
    turn = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v))]) @ v
    moved: FloatArray = (vertices - here) @ turn + there
    return moved
