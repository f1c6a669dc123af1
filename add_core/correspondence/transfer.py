"""Colours and fields of one shape carried to another along a correspondence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import issparse

from .._check import FloatArray, IntArray, array_of, descriptor_array, index_array, instance_of, numbers, read_only
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh
from ..geometry.pair_distances import PairDistances
from .functional_map import FunctionalMap, SoftMatches, pulled_back


@dataclass(frozen=True, eq=False)
class TransferredColors:
    """Values of the source at the points of the target.

    raw : (n2, c), exactly those of the matched points. smooth : (n2, c), through the functional map, within the
        source's range; equal to `raw` where no map was given.
    match_21 : (n2,), the source vertex that each target point takes its value from; of soft matches the largest share.
    error : (n2,), geodesic distance from that vertex to the true one, in the source's unit; None without truth.
    """

    raw: FloatArray
    smooth: FloatArray
    match_21: IntArray
    error: FloatArray | None


def transfer_colors(
    source: TriangleMesh | PointCloud,
    correspondence: ArrayLike | SoftMatches | FunctionalMap,
    *,
    colors: ArrayLike | None = None,
    truth: ArrayLike | None = None,
    smooth_map: FunctionalMap | None = None,
) -> TransferredColors:
    """Carry colours from a source (shape 1) to a target (shape 2) along a correspondence (the paper's Figures 9 and
    10).

    correspondence : (n2,), the source vertex of each target point (`match_21`); soft, (n2, n1), rows of shares; or a
        FunctionalMap, which gives the smooth version too.
    colors : (n1,) or (n1, c) values at the source's vertices: RGB, a scalar field, texture coordinates. None takes
        `coordinate_colors(source)`.
    truth : (n2,), the true source vertex of each target point, −1 where unknown; then the error field is measured.
    smooth_map : the functional map for the smooth version where `correspondence` is none.
    Returns raw and smooth values, (n2, c). Raises ParameterError if arrays do not fit together or are not finite.
    """
    instance_of("source", source, TriangleMesh, PointCloud)
    values = coordinate_colors(source) if colors is None else numbers("colors", colors)
    values = descriptor_array("colors", values[:, None] if values.ndim == 1 else values)
    if len(values) != source.vertex_count:
        raise ParameterError(f"colors must have {source.vertex_count} rows like the source, but it has {len(values)}.")
    if isinstance(correspondence, FunctionalMap):
        smooth_map, matches = correspondence, correspondence.match_21
    else:
        if smooth_map is not None:
            instance_of("smooth_map", smooth_map, FunctionalMap)
        matches = _checked_matches(correspondence)
    count = matches.shape[0]
    raw = pulled_back(values, matches, count)
    hard = matches if np.ndim(matches) == 1 else np.asarray(matches.argmax(axis=1)).ravel()
    hard = index_array("correspondence", np.asarray(hard), source.vertex_count)
    smooth = raw
    if smooth_map is not None:
        smooth = np.clip(smooth_map.transfer(values), values.min(axis=0), values.max(axis=0))
        if len(smooth) != count:
            raise ParameterError(f"smooth_map must lead to the {count} target points, but it leads to {len(smooth)}.")
    error = None if truth is None else _errors(source, hard, truth)
    return TransferredColors(read_only(raw), read_only(np.array(smooth)), read_only(hard), error)


def _checked_matches(correspondence: ArrayLike | SoftMatches) -> Any:
    matches = correspondence if issparse(correspondence) else array_of("correspondence", correspondence)
    if matches.ndim not in (1, 2):
        raise ParameterError(f"correspondence must have shape (n2,) or (n2, n1), but it has {matches.shape}.")
    return matches


def coordinate_colors(shape: TriangleMesh | PointCloud) -> FloatArray:
    """(n, 3), 0 to 1: a vertex's position in the shape's bounding box as red, green and blue.

    The box is that of the principal axes, so the colours turn with the shape: the longest axis runs through green.
    Raises ParameterError for what is no shape.
    """
    instance_of("shape", shape, TriangleMesh, PointCloud)
    centred = shape.vertices - shape.vertices.mean(axis=0)
    axes = np.linalg.eigh(centred.T @ centred)[1][:, [1, 2, 0]]
    # An axis has no sign: point it to where the shape reaches farther, so that a turned copy gets the same colours.
    along = centred @ axes
    along *= np.where(along.max(axis=0) >= -along.min(axis=0), 1.0, -1.0)
    low, high = along.min(axis=0), along.max(axis=0)
    return np.asarray((along - low) / np.where(high > low, high - low, 1.0))


def _errors(source: TriangleMesh | PointCloud, matches: IntArray, truth: ArrayLike) -> FloatArray:
    true = index_array("truth", truth, source.vertex_count, count=len(matches), least=-1)
    error = np.full(len(matches), np.nan)
    known = np.flatnonzero(true >= 0)
    error[known] = PairDistances(source)(true[known], matches[known])
    return read_only(error)
