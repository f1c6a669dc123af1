"""Fields that need no spectrum: curvatures, and what came with the file."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from add_core.geometry import TriangleMesh
from add_core.geometry.frames import PrincipalFrames

from ..models.fields import ShapeField, ValueScale
from .field_plans import Place, Plan, Same, Sources

FloatArray = NDArray[np.float64]

CURVATURES = {
    "max": ("Maximum curvature κ_M", "1/⌀", "κ_M"),
    "min": ("Minimum curvature κ_m", "1/⌀", "κ_m"),
    "mean": ("Mean curvature H", "1/⌀", "H"),
    "gaussian": ("Gaussian curvature K", "1/⌀²", "K"),
    "confidence": ("Trust in the directions", "", "confidence"),
}
"""Name → title, unit, symbol."""
_MOST = {"gaussian": 80.0}
_MOST_OF_OTHERS = 94.0
"""Percentile of |curvature| at which colours saturate: fingertips and creases would hide all the rest."""


def curvature_plan(place: Place, sources: Sources) -> Plan:
    """Principal, mean and Gaussian curvature, and how far the principal directions can be trusted."""
    shape, choice = place.shape, place.choice
    name = choice.name if choice.name in CURVATURES else "max"

    def work() -> ShapeField:
        frames = sources.operators.laplacian(shape, "curvature", 0.0).frames
        values = at_vertices(shape.shape, curvature(frames, name))
        title, unit, symbol = CURVATURES[name]
        top = float(np.percentile(np.abs(values), _MOST.get(name, _MOST_OF_OTHERS))) or 1.0
        plain = name == "confidence"
        scale = ValueScale(0.0, 1.0) if plain else ValueScale(-top, top, open_low=True, open_high=True)
        return ShapeField(
            shape=shape.key,
            choice=choice,
            values=values,
            title=title,
            notes=(f"unit {unit}" if unit else "0: none, 1: sure", "positive where convex" if not plain else ""),
            tones="sequential" if plain else "signed",
            scale=scale,
            symbol=symbol,
            unit=f"/{unit[2:]}" if unit else "",
        )

    return Plan((choice, Same(shape.shape)), work)


def curvature(frames: PrincipalFrames, name: str) -> FloatArray:
    """(m,) of every face, or point of a cloud."""
    most, least = frames.max_curvature, frames.min_curvature
    return {
        "max": most,
        "min": least,
        "mean": 0.5 * (most + least),
        "gaussian": most * least,
        "confidence": frames.confidence,
    }[name]


def at_vertices(shape: object, values: FloatArray) -> FloatArray:
    """(n,): means over the faces around each vertex, weighted by area; a cloud's values are its points' already."""
    if not isinstance(shape, TriangleMesh):
        return values
    weights, totals = np.zeros(shape.vertex_count), np.zeros(shape.vertex_count)
    for corner in shape.faces.T:
        np.add.at(weights, corner, shape.face_areas)
        np.add.at(totals, corner, shape.face_areas * values)
    means: FloatArray = totals / np.where(weights > 0, weights, 1.0)
    return means


def file_plan(place: Place, sources: Sources) -> Plan:
    """A quantity that the shape's own file holds; colours are shown as they are."""
    shape, name = place.shape, place.choice.name
    if name not in shape.fields:
        return Plan(message=f"The file of {shape.name} has no field named {name}")
    column = place.choice.index

    def work() -> ShapeField:
        return file_field(place, np.asarray(shape.fields[name], dtype=np.float64), column)

    return Plan((place.choice, Same(shape.fields[name]), column), work)


def file_field(place: Place, values: FloatArray, column: int) -> ShapeField:
    """Signed if there are values on both sides of 0."""
    name = place.choice.name
    if values.ndim == 2:
        column = min(column, values.shape[1] - 1)
        title, values = f"{name}, column {column + 1} of {values.shape[1]}", values[:, column]
    else:
        title = name
    known = values[np.isfinite(values)]
    signed = bool(known.size) and known.min() < 0 < known.max()
    return ShapeField(
        shape=place.shape.key,
        choice=place.choice,
        values=values,
        title=title,
        notes=("from the file", "linear scale"),
        tones="signed" if signed else "sequential",
        scale=ValueScale.signed(values) if signed else ValueScale.spanning(values),
        symbol=name,
    )
