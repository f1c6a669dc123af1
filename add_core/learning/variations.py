"""Training shapes that differ from those at hand as scans differ from templates: other bodies, skins and meshings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray
from ..errors import ParameterError
from ..geometry import TriangleMesh, subsample
from .augmentation import bend, blur, remesh, roughen
from .training_set import UNKNOWN, TrainingShape

BEND, WAVELENGTH = (0.001, 0.006), (0.12, 0.3)
"""Amplitude and shortest wave of the other body, of the bounding box's diagonal."""
ROUGHNESS = (0.01, 0.12)
"""Of the skin, of the mean edge length; drawn evenly on a logarithmic scale."""
COUNTS = (0.5, 1.1)
"""Vertices of a new meshing, of the old one's."""


def vary(item: TrainingShape, *, seed: int) -> TrainingShape:
    """Another body of the same places: bent, then in half of the cases meshed anew and in an eighth sampled as a
    cloud; then blurred or roughened or both. The places, shape (n,), go with the vertices that stay.

    A cloud given is returned as it is.
    """
    if not isinstance(item.shape, TriangleMesh):
        return item
    draw = np.random.default_rng(seed)
    mesh, places = item.shape, np.asarray(item.places)
    mesh = bend(mesh, amplitude=draw.uniform(*BEND), wavelength=draw.uniform(*WAVELENGTH), seed=seed)
    kind = draw.random()
    if kind < 0.5:
        twin = remesh(mesh, max(4, int(draw.uniform(*COUNTS) * mesh.vertex_count)), seed=seed)
        mesh, places = twin.mesh, np.where(twin.indices >= 0, places[twin.indices], UNKNOWN)
    if draw.random() < 0.3:
        mesh = blur(mesh, steps=int(draw.integers(1, 6)))
    if draw.random() < 0.8:
        amplitude = float(np.exp(draw.uniform(*np.log(ROUGHNESS))))
        mesh = roughen(mesh, amplitude=amplitude, smoothing=int(draw.integers(0, 4)), seed=seed)
    if kind > 0.875:
        sample = subsample(mesh, max(4, int(draw.uniform(0.5, 0.8) * mesh.vertex_count)))
        return TrainingShape(sample.cloud, places[sample.indices])
    return TrainingShape(mesh, places)


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
