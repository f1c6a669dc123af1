"""Colours of places: what belongs together on two shapes is seen at a glance, on both sides of a body."""

from __future__ import annotations

import numpy as np

from .._check import FloatArray
from .colours import lch

STEEPNESS = 7.0
"""Of the change from dark to light: legs, a tenth of the width from the middle, get two thirds of it."""


def position_colours(vertices: FloatArray) -> FloatArray:
    """(n, 3) sRGB of vertices (n, 3): hue along the longest axis, lightness along the second, chroma along the third.

    The hue runs through 300 degrees, so that the ends differ; a body's two sides differ in lightness, most steeply
    near the middle, where legs stand side by side; its front and back in chroma. Axes are those of the bounding box.
    """
    low, extent = vertices.min(axis=0), np.ptp(vertices, axis=0)
    place = (vertices - low) / np.where(extent > 0, extent, 1.0)
    longest, second, third = (place[:, axis] for axis in np.argsort(-extent, kind="stable"))
    side = np.tanh(STEEPNESS * (second - np.median(second)))
    return lch(0.64 + 0.19 * side, 0.09 + 0.07 * third, 300.0 - 300.0 * longest)
