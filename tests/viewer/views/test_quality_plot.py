"""Curves of several targets are told apart, and each is named beside a swatch of its colour."""

import numpy as np

from add_core.drawing.colours import MARKERS, hex_colour
from add_viewer.models.insights import Insights, MatchQuality, QualityCurve
from add_viewer.models.session import Session


def test_each_target_has_a_colour_of_its_own_and_a_swatch_at_its_name(make_torus, qtbot, screen):
    from matplotlib.colors import to_hex

    from add_viewer.views.quality_plot import QualityPlot

    session, insights = Session(), Insights()
    for name in ("one", "other"):
        session.add_shape(make_torus(name))
    plot = QualityPlot(session, insights)
    qtbot.addWidget(plot)
    plot.show()
    x = np.linspace(0.0, 0.3, 4)
    curves = {(False, symmetric): QualityCurve(x, x, 0.1, 0.2) for symmetric in (False, True)}
    insights.set_qualities(tuple(MatchQuality(name, curves=curves) for name in ("one", "other")))
    (axes,) = plot.figure.axes
    colours = [to_hex(line.get_color()) for line in axes.lines]
    wanted = [hex_colour(MARKERS[number]) for number in (0, 0, 1, 1)]
    assert colours == wanted
    assert [to_hex(patch.get_facecolor()) for patch in axes.patches] == wanted[::2]
    plot.figure.draw_without_rendering()
    renderer = plot.canvas.get_renderer()
    for patch, text in zip(axes.patches, axes.texts, strict=True):
        swatch, words = patch.get_window_extent(renderer), text.get_window_extent(renderer)
        assert swatch.x1 < words.x0
        assert words.y0 < 0.5 * (swatch.y0 + swatch.y1) < words.y1
