"""Colours of places: what belongs together on two shapes is seen at a glance, on both sides of a body."""

from __future__ import annotations

import numpy as np

from .._check import FloatArray
from .colours import lch


def position_colours(vertices: FloatArray) -> FloatArray:
    """(n, 3) sRGB of vertices (n, 3): hue along the longest axis, lightness along the second, chroma along the third.

    The hue runs through 300 degrees, so that the ends differ; a body's two sides differ in lightness, its front and
    back in chroma. Axes are those of the bounding box.
    """
    low, extent = vertices.min(axis=0), np.ptp(vertices, axis=0)
    place = (vertices - low) / np.where(extent > 0, extent, 1.0)
    longest, second, third = (place[:, axis] for axis in np.argsort(-extent, kind="stable"))
    return lch(0.48 + 0.36 * second, 0.10 + 0.06 * third, 300.0 - 300.0 * longest)
