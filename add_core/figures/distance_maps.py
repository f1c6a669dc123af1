"""Figure 6: how far every point of several shapes is from one point of the first, in the space of a descriptor."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from .._check import FloatArray
from ..drawing.colour_maps import distance_map
from ..evaluation.samples import Sample, truth_between
from .drawn import Drawn
from .methods import method, obtainable
from .page import INK, QUIET, blank, colour_bar
from .stage import Stage
from .studio import Studio

DESCRIPTORS = ("hks", "wks", "ahks")
WIDE, HIGH = 0.47, 0.93
INCHES = 2.2
"""A diameter on paper."""
LEFT, TOP = 0.9, 0.55


def draw(studio: Studio) -> Drawn:
    """One row a descriptor, one column a shape; the first column holds the reference point."""
    cast = studio.cast
    rows, missing = obtainable([*DESCRIPTORS, *cast.learned])
    samples = [studio.sample(index, variant) for index, variant in cast.audience]
    studio.expect(len(rows) * len(samples))
    width, height = WIDE * len(samples), HIGH * len(rows)
    figure = Figure(figsize=(LEFT + INCHES * width + 0.1, TOP + INCHES * height + 0.6))
    stage = studio.stage(
        figure, (LEFT, 0.55, INCHES * width, INCHES * height), studio.camera(30, 6), width=width, height=height
    )
    errors = []
    for row, name in enumerate(rows):
        reference = studio.describer.describe(name, samples[0])[cast.reference_point]
        for column, sample in enumerate(samples):
            distance = np.linalg.norm(studio.describer.describe(name, sample) - reference, axis=1)
            at = ((column + 0.5) * WIDE, (len(rows) - 1 - row) * HIGH + 0.02)
            errors.append(_show(studio, stage, samples[0], sample, distance, at))
            studio.done()
    widths = [studio.describer.describe(name, samples[0]).shape[1] for name in rows]
    _write(studio, figure, rows, widths, [sample.name for sample in samples])
    return Drawn(figure, _caption(studio, rows, np.reshape(errors, (len(rows), len(samples)))), missing)


def _show(
    studio: Studio, stage: Stage, reference: Sample, sample: Sample, distance: FloatArray, at: tuple[float, float]
) -> float:
    """Paint one shape and return how far, in diameters, its coldest point is from the true one."""
    shape = studio.unit(sample)
    position = np.clip(distance / max(float(np.median(distance)), 1e-12), 0.0, 1.0)
    standing = stage.stand(shape, at, positions=position, colour_map=distance_map())
    truth = truth_between(reference, sample)
    point = studio.cast.reference_point
    place = truth.weights[point] @ shape.vertices[truth.corners[point]]
    x, y = standing.seen(place)
    is_reference = sample is reference
    if is_reference:
        stage.axes.plot(x, y, "o", ms=5.5, mfc="white", mec=INK, mew=0.8, zorder=6)
    else:
        for colour, width in ((INK, 2.6), ("white", 1.3)):
            stage.axes.plot(x, y, "o", ms=7.5, mfc="none", mec=colour, mew=width, zorder=6)
    return float(np.linalg.norm(shape.vertices[distance.argmin()] - place))


def _write(studio: Studio, figure: Figure, rows: list[str], widths: list[int], names: list[str]) -> None:
    side = blank(figure, (0.0, 0.55, LEFT, INCHES * HIGH * len(rows)))
    side.set(xlim=(0, 1), ylim=(0, len(rows)))
    for row, name in enumerate(rows):
        middle = len(rows) - row - 0.5
        side.text(0.88, middle, method(name).title, ha="right", va="bottom", fontsize=11)
        side.text(0.88, middle, f"{widths[row]} numbers", ha="right", va="top", fontsize=7.5, color=QUIET)
    top = blank(figure, (LEFT, 0.55 + INCHES * HIGH * len(rows), INCHES * WIDE * len(names), TOP))
    top.set(xlim=(0, len(names)), ylim=(0, 1))
    for column, ((_, variant), name) in enumerate(zip(studio.cast.audience, names, strict=True)):
        subject, _, pose = name.partition(", ")
        kind = {"mesh": pose, "remeshed": "other triangles", "cloud": "points"}[variant]
        top.text(column + 0.5, 0.55, subject, ha="center", va="bottom", fontsize=9, color=INK)
        top.text(column + 0.5, 0.47, kind, ha="center", va="top", fontsize=8, color=QUIET)
    width = figure.get_size_inches()[0]
    box = (0.5 * width - 1.6, 0.28, 3.2, 0.09)
    colour_bar(figure, box, distance_map(), title="", ends=("same descriptor", "median distance and beyond"))


def _caption(studio: Studio, rows: list[str], errors: FloatArray) -> str:
    shown = ", ".join(f"{method(name).title} {np.mean(row[1:]):.2f}" for name, row in zip(rows, errors, strict=True))
    return (
        "Distance in descriptor space between the white point on the left shoulder of the first shape and all points "
        "of every shape, saturated at each shape's median; cold is near. Rings: where that point truly is. A good "
        "descriptor has one cold spot there, and none on the right shoulder. Mean distance from the coldest point to "
        f"the ring over the other shapes, in diameters (straight line): {shown}."
    )
