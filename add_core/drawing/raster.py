"""A z-buffer in NumPy: which triangle is seen at which pixel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._check import FloatArray, IntArray

_CANDIDATES = 250_000
"""Pixels of bounding boxes that are looked at together: few enough to stay in the processor's cache."""


@dataclass(frozen=True, eq=False)
class Seen:
    """The pixels that something is seen at, f of them.

    pixels : (f,) row · width + column, row 0 at the top. faces : (f,). weights : (f, 3), barycentric, sum 1.
    depth : (height · width,), how near the eye; −inf where nothing is.
    """

    pixels: IntArray
    faces: IntArray
    weights: FloatArray
    depth: FloatArray


def rasterise(places: FloatArray, faces: IntArray, width: int, height: int, *, back_faces: bool = False) -> Seen:
    """What is seen at the centre of each pixel.

    places : (p, 3), column and row in pixels (row 0 at the top, centres at half numbers) and nearness to the eye.
    faces : (m, 3), counter-clockwise as seen from outside. back_faces : show these too; else they are skipped.
    """
    triangles = _Triangles.of(places[faces], width, height, back_faces=back_faces)
    depth = np.full(width * height, -np.inf)
    owner = np.full(width * height, -1, dtype=np.int64)
    for part in triangles.portions():
        triangles.draw(part, width, depth, owner)
    pixels = np.flatnonzero(owner >= 0)
    shown = owner[pixels]
    second, third = triangles.weights(shown, pixels % width, pixels // width)
    return Seen(pixels, triangles.numbers[shown], np.stack([1.0 - second - third, second, third], axis=1), depth)


@dataclass(frozen=True, eq=False)
class _Triangles:
    """Those t triangles that may be seen. All that is linear over a triangle is a·column + b·row + c.

    numbers : (t,). low, size : (t, 2), first pixel and extent of the bounding box. second, third, near : (3, t), the
    coefficients of two barycentric coordinates and of the nearness at pixel centres.
    """

    numbers: IntArray
    low: IntArray
    size: IntArray
    second: FloatArray
    third: FloatArray
    near: FloatArray

    @classmethod
    def of(cls, corners: FloatArray, width: int, height: int, *, back_faces: bool) -> _Triangles:
        one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
        low = np.maximum(np.ceil(corners[:, :, :2].min(axis=1) - 0.5), 0)
        high = np.minimum(np.floor(corners[:, :, :2].max(axis=1) - 0.5), (width - 1, height - 1))
        # Rows run downwards, so what is counter-clockwise on the shape has negative area here.
        drawn = np.flatnonzero((area != 0 if back_faces else area < 0) & (high >= low).all(axis=1))
        one, two, area, start = one[drawn], two[drawn], area[drawn], corners[drawn, 0]
        second = _plane(two[:, 1] / area, -two[:, 0] / area, start)
        third = _plane(-one[:, 1] / area, one[:, 0] / area, start)
        near = second * one[:, 2] + third * two[:, 2]
        near[2] += start[:, 2]
        low = low[drawn].astype(np.int64)
        return cls(drawn, low, high[drawn].astype(np.int64) - low + 1, second, third, near)

    def portions(self) -> list[IntArray]:
        """Runs of triangles with few enough candidate pixels together; at least one triangle each."""
        runs = np.cumsum(self.size.prod(axis=1)) // _CANDIDATES
        return np.split(np.arange(len(self.numbers)), np.flatnonzero(np.diff(runs)) + 1)

    def draw(self, part: IntArray, width: int, depth: FloatArray, owner: IntArray) -> None:
        """Put triangles `part` into the buffers `depth` and `owner` (height · width,) where they are nearest."""
        count = self.size[part].prod(axis=1)
        triangle = np.repeat(part, count)
        within = np.arange(len(triangle)) - np.repeat(np.cumsum(count) - count, count)
        down, right = np.divmod(within, np.repeat(self.size[part, 0], count))
        column, row = right + self.low[triangle, 0], down + self.low[triangle, 1]
        second, third = self.weights(triangle, column, row)
        inside = np.flatnonzero((second >= -1e-9) & (third >= -1e-9) & (second + third <= 1 + 1e-9))
        triangle, column, row = triangle[inside], column[inside], row[inside]
        near, pixel = _linear(self.near, triangle, column, row), row * width + column
        better = np.flatnonzero(near > depth[pixel])
        order = better[np.argsort(near[better], kind="stable")]
        # Of several values for one place, the last is kept: the nearest.
        depth[pixel[order]] = near[order]
        owner[pixel[order]] = triangle[order]

    def weights(self, triangle: IntArray, column: IntArray, row: IntArray) -> tuple[FloatArray, FloatArray]:
        """The second and third barycentric coordinate (f,) at pixel centres."""
        return _linear(self.second, triangle, column, row), _linear(self.third, triangle, column, row)


def _plane(across: FloatArray, down: FloatArray, start: FloatArray) -> FloatArray:
    """Coefficients (3, t), at pixel centres, of what has these slopes and is 0 at `start` (t, 3)."""
    return np.stack([across, down, (0.5 - start[:, 0]) * across + (0.5 - start[:, 1]) * down])


def _linear(coefficients: FloatArray, triangle: IntArray, column: IntArray, row: IntArray) -> FloatArray:
    across, down, constant = coefficients
    return np.asarray(across[triangle] * column + down[triangle] * row + constant[triangle])
