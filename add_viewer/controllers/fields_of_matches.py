"""Fields that a correspondence makes: what lands on the targets, and how far off it lands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from add_core.drawing.position_colours import position_colours

from ..models.diffusion import Diffusion
from ..models.fields import FieldChoice, ShapeField, ValueScale
from ..models.shapes import OpenShape
from .field_plans import Place, Plan, Same, Sources
from .operators import OperatorStore

FloatArray = NDArray[np.float64]

MOST_ERROR = 0.15
"""Geodesic error, in diameters, at which colours saturate: a hand's length on a person."""


def transfer_plan(place: Place, sources: Sources) -> Plan:
    """The source's place colours, or its heat, as the correspondence carries them to this shape."""
    source = place.state.active
    assert source is not None
    if place.choice.name == "heat":
        return _heat_plan(place, source, sources)
    match = _match(place, source, sources)
    if match is None:
        return Plan(message=sources.matching.message(place.shape.key))

    def work() -> ShapeField:
        colors = position_colours(source.shape.vertices)[match]
        return ShapeField(
            shape=place.shape.key,
            choice=place.choice,
            colors=colors,
            caption=f"Colours of {source.name}" if place.shape.key != source.key else "The source of the colours",
        )

    return Plan((place.choice, Same(match) if place.shape.key != source.key else 0, Same(source.shape)), work)


def _heat_plan(place: Place, source: OpenShape, sources: Sources) -> Plan:
    vertices = tuple(pick.vertex for pick in place.state.active_picks)
    if not vertices:
        return Plan(message=f"Click {source.name}: its heat is carried to the others")
    match = _match(place, source, sources)
    if match is None:
        return Plan(message=sources.matching.message(place.shape.key))
    diffusion = place.state.diffusion

    def work() -> ShapeField:
        heat = _heat(source, vertices, diffusion, sources.operators)
        return ShapeField(
            shape=place.shape.key,
            choice=place.choice,
            values=heat[match],
            title="Carried heat kernel",
            notes=("unit 1/⌀²", "linear scale"),
            caption=f"Heat of {source.name}" if place.shape.key != source.key else "The source of the heat",
            tones="kernel",
            scale=ValueScale.of_kernel(heat, "linear"),
            symbol="h",
            unit="/⌀²",
        )

    changing = Same(match) if place.shape.key != source.key else 0
    return Plan((place.choice, changing, Same(source.shape), vertices, diffusion), work)


def _heat(source: OpenShape, vertices: tuple[int, ...], diffusion: Diffusion, operators: OperatorStore) -> FloatArray:
    """(n,) of all picks together, 1/⌀²."""
    flow = operators.flow(source, diffusion.conductivity, diffusion.alpha, "kernel")
    scale = operators.laplacian(source, diffusion.conductivity, diffusion.alpha).weyl_eigenvalue(1)
    kernels = [flow.kernel(vertex, theta=diffusion.theta, time=diffusion.reach / scale) for vertex in vertices]
    total: FloatArray = np.sum(kernels, axis=0)
    return total


def error_plan(place: Place, sources: Sources) -> Plan:
    """Geodesic distance between the match of every point and its true place on the source."""
    source, shape = place.state.active, place.shape
    assert source is not None
    if shape.key == source.key:
        return Plan((place.choice, Same(shape.shape)), lambda: _source_of_errors(place))
    matching = place.state.matching
    if matching.method == "true":
        return Plan(message="The true correspondence has no error. Choose another matching.")
    found = sources.matching.found(shape.key)
    if found is None:
        return Plan(message=sources.matching.message(shape.key))
    error = found.error(refined=matching.refined)
    if error is None:
        return Plan(message=f"The true correspondence of {shape.name} and {source.name} is not known")
    root = sources.matching.root_area()

    def work() -> ShapeField:
        return _error_field(place, error * root)

    return Plan((place.choice, Same(error)), work)


def _error_field(place: Place, values: FloatArray) -> ShapeField:
    exact = float((values[np.isfinite(values)] == 0).mean()) if np.isfinite(values).any() else 0.0
    return ShapeField(
        shape=place.shape.key,
        choice=place.choice,
        values=values,
        title="Geodesic error",
        notes=("unit ⌀", "from the true place"),
        caption=f"Mean {np.nanmean(values):.3f} ⌀, {100 * exact:.0f} % exact",
        tones="sequential",
        scale=ValueScale(0.0, MOST_ERROR, open_high=True),
        symbol="error",
        unit="⌀",
    )


def _source_of_errors(place: Place) -> ShapeField:
    choice: FieldChoice = replace(place.choice, kind="skin")
    return ShapeField(shape=place.shape.key, choice=choice, caption="The source")


def _match(place: Place, source: OpenShape, sources: Sources) -> NDArray[np.int64] | None:
    if place.shape.key == source.key:
        return np.arange(source.vertex_count)
    return sources.results.maps.get((source.key, place.shape.key))
