"""Pictures of shapes: bare, coloured by a field, or with a colour for each vertex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._check import FloatArray, descriptor_array, positive, read_only
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh
from .camera import Camera
from .colours import SKIN, kernel_map
from .facets import Facets
from .lighting import shade
from .raster import Seen, rasterise

OVERSAMPLING = 3
"""Samples along each side of a pixel."""
MOST_PIXELS = 40_000_000
MARGIN = 2  # pixels around the shape


@dataclass(frozen=True, eq=False)
class Picture:
    """A shape on nothing.

    rgba : (height, width, 4) uint8, row 0 at the top, transparent beside the shape. extent : left, right, bottom and
        top of the picture in the camera's axes and the shape's unit, as matplotlib's `imshow` takes it.
    """

    rgba: NDArray[np.uint8]
    extent: tuple[float, float, float, float]


def draw_shape(
    shape: TriangleMesh | PointCloud,
    camera: Camera,
    *,
    resolution: float,
    colours: ArrayLike | None = None,
    positions: ArrayLike | None = None,
    colour_map: FloatArray | None = None,
    sky: FloatArray | None = None,
    oversampling: int = OVERSAMPLING,
) -> Picture:
    """A picture of a mesh, smoothly shaded, or of a cloud, as discs.

    resolution : pixels per unit of length. colours : (n, 3) sRGB, 0 to 1, one for each vertex. positions : (n,), 0 to
        1, places on `colour_map` (k, 3), by default `kernel_map()`; values between vertices are interpolated before
        they become colours. Neither: bare skin. sky : (n,) from `sky_share`; None sees all of it.
    The side turned away of an open mesh is drawn too, lit as if it were the front.
    Raises ParameterError for arrays that do not fit the shape, or a picture of more than 40 million samples.
    """
    facets = Facets.of(shape)
    per_vertex, table = _paint(shape, colours, positions, colour_map)
    places = camera.seen(facets.places)
    scale = positive("resolution", resolution) * oversampling
    low, high = places[:, :2].min(axis=0), places[:, :2].max(axis=0)
    columns, rows = (np.ceil((high - low) * scale / oversampling).astype(int) + 2 * MARGIN).tolist()
    if columns * rows * oversampling**2 > MOST_PIXELS:
        raise ParameterError(f"resolution {resolution:g} makes a picture of {columns} × {rows}. Choose a lower one.")
    left, top = low[0] - MARGIN * oversampling / scale, low[1] + (rows - MARGIN) * oversampling / scale
    places[np.unique(facets.faces[len(facets.faces) - facets.hiding :]), 2] -= facets.depth_bias
    pixels = np.stack([(places[:, 0] - left) * scale, (top - places[:, 1]) * scale, places[:, 2]], axis=1)
    width, height = columns * oversampling, rows * oversampling
    closed = isinstance(shape, PointCloud) or _is_closed(shape)
    seen = rasterise(pixels, facets.faces, width, height, back_faces=not closed)
    lit = _lit(facets, seen, camera, per_vertex, table, sky)
    rgba = _reduced(lit, seen.pixels, width, height, oversampling, seen.faces < len(facets.faces) - facets.hiding)
    return Picture(rgba, (left, left + columns * oversampling / scale, top - rows * oversampling / scale, top))


def _paint(
    shape: TriangleMesh | PointCloud,
    colours: ArrayLike | None,
    positions: ArrayLike | None,
    colour_map: FloatArray | None,
) -> tuple[FloatArray, FloatArray | None]:
    """Numbers for each vertex, (n, 3) colours or (n, 1) places on the map that comes with them."""
    if colours is not None and positions is not None:
        raise ParameterError("a shape takes colours or positions on a colour map, but both were given.")
    count = shape.vertex_count
    if colours is None and positions is None:
        return np.tile(SKIN, (count, 1)), None
    flat = np.asarray(colours if positions is None else np.ravel(np.asarray(positions))[:, None])
    values = descriptor_array("positions" if colours is None else "colours", flat, width=1 if colours is None else 3)
    if len(values) != count:
        raise ParameterError(f"colours must be given for {count} vertices, but there are {len(values)}.")
    table = None if colours is not None else kernel_map() if colour_map is None else colour_map
    return np.clip(values, 0.0, 1.0), table


def _lit(
    facets: Facets,
    seen: Seen,
    camera: Camera,
    per_vertex: FloatArray,
    table: FloatArray | None,
    sky: FloatArray | None,
) -> FloatArray:
    """The colour (f, 3) of every sample."""
    corners = facets.faces[seen.faces]
    owners = facets.owner[corners]
    normals = np.einsum("fj,fjk->fk", seen.weights, facets.normals[corners]) @ camera.axes.T
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    normals *= np.where(normals[:, 2:] < -0.2, -1.0, 1.0)
    values = np.einsum("fj,fjk->fk", seen.weights, per_vertex[owners])
    if table is not None:
        at = np.clip(values[:, 0], 0.0, 1.0) * (len(table) - 1)
        below = np.minimum(at.astype(np.int64), len(table) - 2)
        values = table[below] + (at - below)[:, None] * (table[below + 1] - table[below])
    light = np.ones(len(corners)) if sky is None else np.einsum("fj,fj->f", seen.weights, sky[owners])
    return shade(values, normals, light)


def _reduced(
    lit: FloatArray, pixels: NDArray[np.int64], width: int, height: int, factor: int, drawn: NDArray[np.bool_]
) -> NDArray[np.uint8]:
    """Mean over the samples of each pixel; what is not drawn is transparent."""
    columns = width // factor
    pixel = (pixels // width // factor) * columns + (pixels % width) // factor
    count = columns * (height // factor)
    cover = np.bincount(pixel, drawn.astype(np.float64), count)
    rgb = [np.bincount(pixel, lit[:, k] * drawn, count) / np.maximum(cover, 1e-9) for k in range(3)]
    rgba = np.stack([*rgb, cover / factor**2], axis=1)
    rounded = np.round(255 * rgba).astype(np.uint8).reshape(height // factor, columns, 4)
    return read_only(rounded)


def _is_closed(mesh: TriangleMesh) -> bool:
    """Whether every edge has two sides, so that the back of a face is never seen."""
    edges = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    counts = np.unique(edges, axis=0, return_counts=True)[1]
    return bool((counts == 2).all())
