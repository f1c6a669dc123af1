"""How readily heat runs along and across each frame's axis: the paper's two models, or a tensor field of your own."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, numbers
from ..errors import GeometryError, ParameterError
from ..geometry import PrincipalFrames

Conductivity = Literal["curvature", "constant"]
CONDUCTIVITIES: tuple[Conductivity, ...] = ("curvature", "constant")


@dataclass(frozen=True, eq=False)
class Diffusivity:
    """D = along · t tᵀ + across · s sᵀ at each row of `frames`, with t its max_direction and s = n × t.

    along, across : (m,), > 0. Rows without a frame (faces without area) are not used.
    """

    frames: PrincipalFrames
    along: FloatArray
    across: FloatArray

    @classmethod
    def of_model(cls, frames: PrincipalFrames, alpha: float, conductivity: Conductivity) -> Diffusivity:
        """Eq. (9), "curvature": ψ(κ_m) along u_M and ψ(κ_M) along u_m; eq. (10), "constant": 1 and 1/(1 + α).

        On the fans of a cloud where their frames are known.
        """
        frames = frames if frames.on_fans is None else frames.on_fans
        if conductivity == "constant":
            return cls(frames, np.ones(len(frames.normals)), np.full(len(frames.normals), 1 / (1 + alpha)))
        along = 1 / (1 + alpha * np.abs(frames.min_curvature))
        return cls(frames, along, 1 / (1 + alpha * np.abs(frames.max_curvature)))

    @classmethod
    def of_directions(
        cls, frames: PrincipalFrames, directions: ArrayLike, *, along: ArrayLike, across: ArrayLike
    ) -> Diffusivity:
        """`along` and `across` (m,) or one number, > 0, about the tangential axes of `directions` (m, 3)."""
        given = _rows("directions", directions, frames, (3,))
        axes = given - np.einsum("mi,mi->m", given, frames.normals)[:, None] * frames.normals
        length = np.linalg.norm(axes, axis=1)
        lost = (length <= 1e-9 * np.linalg.norm(given, axis=1)) & frames.normals.any(axis=1)
        if lost.any():
            raise GeometryError(
                f"directions must have a tangential part, but {lost.sum()} of {len(lost)} have none "
                f"(first: {lost.argmax()})."
            )
        axes = np.divide(axes, length[:, None], out=np.zeros_like(axes), where=length[:, None] > 0)
        turned = _turned(frames, axes)
        return cls(turned, _positive_rows("along", along, turned), _positive_rows("across", across, turned))

    @classmethod
    def of_tensors(cls, frames: PrincipalFrames, tensors: ArrayLike) -> Diffusivity:
        """The tangential part of symmetric `tensors` (m, 3, 3), positive definite in each tangent plane."""
        given = _rows("tensors", tensors, frames, (3, 3))
        scale = np.abs(given).max(initial=0.0)
        if not np.allclose(given, given.transpose(0, 2, 1), rtol=0, atol=1e-9 * scale):
            raise ParameterError("tensors must be symmetric, but some are not.")
        x, y = frames.max_direction, frames.min_direction
        xx, xy, yy = (np.einsum("mi,mij,mj->m", a, given, b) for a, b in ((x, x), (x, y), (y, y)))
        mean, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
        angle = 0.5 * np.arctan2(xy, (xx - yy) / 2)
        axes = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y
        bad = ~(mean - radius > 0) & frames.normals.any(axis=1)
        if bad.any():
            raise ParameterError(
                f"tensors must be positive definite in the tangent plane, but {bad.sum()} of {len(bad)} are not "
                f"(first: {bad.argmax()})."
            )
        return cls(_turned(frames, axes), mean + radius, mean - radius)


def _turned(frames: PrincipalFrames, axes: FloatArray) -> PrincipalFrames:
    across = np.cross(frames.normals, axes)
    return replace(frames, max_direction=axes, min_direction=across, on_fans=None)


def _rows(name: str, value: ArrayLike, frames: PrincipalFrames, shape: tuple[int, ...]) -> FloatArray:
    array = numbers(name, value, error=GeometryError)
    expected = (len(frames.normals), *shape)
    if array.shape != expected:
        raise GeometryError(f"{name} must have shape {expected}, one row for each frame, but it has {array.shape}.")
    if not np.isfinite(array).all():
        raise GeometryError(f"{name} must be finite, but some values are not.")
    return array


def _positive_rows(name: str, value: ArrayLike, frames: PrincipalFrames) -> FloatArray:
    given = numbers(name, value)
    array = _rows(name, np.full(len(frames.normals), given.item()) if given.size == 1 else given, frames, ())
    if not (array > 0).all():
        raise ParameterError(f"{name} must be greater than 0, but number {int((~(array > 0)).argmax())} is not.")
    return array
