"""Figures 9 and 10: quality of the correspondence, and the colours of a reference carried to other shapes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from .._check import FloatArray
from ..contest.pairs import FOREST, MAPS, REFINED
from ..correspondence import nearest_matches, transfer_colors, zoomout
from ..drawing import position_colours
from ..evaluation import Scores, match_errors
from ..evaluation.baselines import isotropic
from ..evaluation.samples import Sample, truth_between
from ..io import humans
from . import matching
from .drawn import Drawn
from .methods import method, obtainable
from .page import INK, QUIET, panel
from .quality_curves import curve_table, draw_key, draw_protocol
from .studio import Studio

WIDE, HIGH, INCHES = 0.47, 0.93, 2.35
CURVES = 4.85
"""Inches for the curves on the left."""


def draw_meshes(studio: Studio) -> Drawn:
    """Figure 9."""
    return _draw(studio, "mesh")


def draw_clouds(studio: Studio) -> Drawn:
    """Figure 10."""
    return _draw(studio, "cloud")


def _draw(studio: Studio, variant: str) -> Drawn:
    cast = studio.cast
    asked = [MAPS, *_forest(studio, variant), f"ahks{REFINED}"]
    trained = [name + end for name in (*cast.learned, *cast.naming) for end in ("", REFINED)]
    names, missing = obtainable([*asked, *trained])
    carrier = names[-1]
    studio.expect(matching.steps(studio, cast.collection, names) + len(cast.targets))
    scores = matching.scores(studio, cast.collection, names, variant=variant)
    shown = WIDE * (1 + len(cast.targets))
    figure = Figure(figsize=(CURVES + INCHES * shown + 0.1, 3.5))
    axes = panel(figure, (0.75, 0.62, 2.3, 2.35))
    draw_protocol(axes, scores, "princeton")
    axes.set_title("Princeton protocol", loc="left")
    draw_key(figure, (3.15, 0.62, 1.5, 2.35), scores)
    errors = _carry(studio, figure, variant, carrier)
    rows = [(cast.collection.title, scores)]
    return Drawn(figure, _caption(studio, variant, carrier, scores, errors), missing, {"csv": curve_table(rows)})


def _forest(studio: Studio, variant: str) -> list[str]:
    """The forest is trained on the shipped people as meshes: it knows no others."""
    return [FOREST] if studio.cast.collection is humans() and variant == "mesh" else []


def _carry(studio: Studio, figure: Figure, variant: str, carrier: str) -> list[float]:
    """Draw the reference and the targets in its colours; mean errors ÷ √area of the smooth map, asymmetric."""
    cast = studio.cast
    width = WIDE * (1 + len(cast.targets))
    stage = studio.stage(
        figure, (CURVES, 0.3, INCHES * width, INCHES * HIGH), studio.camera(20, 5), width=width, height=HIGH
    )
    reference = studio.sample(cast.reference, variant)
    colours = position_colours(reference.shape.vertices)
    stage.stand(studio.unit(reference), (0.5 * WIDE, 0.02), colours=colours)
    stage.axes.text(0.5 * WIDE, 0.0, "reference", ha="center", va="top", color=INK)
    errors = []
    for column, index in enumerate(cast.targets, start=1):
        target = studio.sample(index, variant)
        carried, error = _carried(studio, reference, target, carrier, colours)
        x = (column + 0.5) * WIDE
        stage.stand(studio.unit(target), (x, 0.02), colours=carried)
        stage.axes.text(x, 0.0, f"error {error:.3f}", ha="center", va="top", fontsize=8, color=QUIET)
        errors.append(error)
        studio.done()
    return errors


def _carried(
    studio: Studio, reference: Sample, target: Sample, carrier: str, colours: FloatArray
) -> tuple[FloatArray, float]:
    """Colours (n2, 3) through the functional map that ZoomOut makes of the raw matches, and their mean error."""
    name = carrier.removesuffix(REFINED)
    describe, spectra = studio.describer.describe, studio.describer.spectra
    raw = nearest_matches(describe(name, target), describe(name, reference))
    found = zoomout(isotropic(spectra(reference)), isotropic(spectra(target)), raw)
    carried = transfer_colors(reference.shape, found, colors=colours)
    error = match_errors(carried.match_21, truth_between(target, reference), shape=reference.shape)
    return carried.smooth, float(error.mean())


def _caption(studio: Studio, variant: str, carrier: str, scores: Sequence[Scores], errors: Sequence[float]) -> str:
    what = {"mesh": "meshes", "cloud": f"point clouds of {studio.quality.cloud_points:,} points"}[variant]
    reached = "; ".join(
        f"{method(score.method).title} {score.numbers['mean error symmetric']:.3f} → "
        f"{score.numbers['mean error asymmetric']:.3f}"
        for score in scores
        if "mean error symmetric" in score.numbers
    )
    names = studio.cast.collection.names
    listed = ", ".join(names[index] for index in studio.cast.targets)
    used = method(carrier.removesuffix(REFINED)).title
    return (
        f"Correspondence on {what}. Left: share of matches within a geodesic radius, mean over {scores[0].pairs} "
        "pairs of test shapes; solid: a mirror image counts as right; dashed: it does not. Mean error ÷ √area, "
        f"symmetric → asymmetric: {reached}. Right: colours of {names[studio.cast.reference]} carried to {listed} by "
        f"nearest neighbours in {used} and the functional map that ZoomOut refines from them, as the paper does for "
        f"its pictures; mean error {np.mean(errors):.3f} √area, asymmetric."
    )
