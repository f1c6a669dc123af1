"""Light as in the app: a soft key from above the left shoulder, a weak fill, and the sky."""

from __future__ import annotations

import numpy as np

from .._check import FloatArray


def _unit(*components: float) -> FloatArray:
    return np.asarray(np.array(components) / np.linalg.norm(components))


KEY, FILL = _unit(-0.42, 0.55, 0.72), _unit(0.75, -0.05, 0.66)
"""Directions to the lights in the picture's right, up and towards the eye."""
_GLOSS = _unit(*(KEY + np.array([0.0, 0.0, 1.0])))  # halfway between the key and the eye
_WRAP = 0.28  # light reaches this far round the terminator, as on skin


def shade(colours: FloatArray, normals: FloatArray, sky: FloatArray) -> FloatArray:
    """Lit colours (f, 3) of places with `colours` (f, 3) and unit `normals` (f, 3) in the camera's axes.

    sky : (f,), 0 to 1, how much of the sky each place sees, see `sky_share`. Nothing gets darker than a fifth, so that
    a colour can still be read in a fold, and a light skin facing the light stays just below white.
    """
    key = np.maximum(normals @ KEY + _WRAP, 0.0) / (1.0 + _WRAP)
    fill = np.maximum(normals @ FILL, 0.0)
    above = 0.5 + 0.5 * normals[:, 1]
    open_sky = 0.22 + 0.78 * sky
    light = (0.34 + 0.22 * above) * open_sky + (0.56 * key + 0.12 * fill) * (0.45 + 0.55 * sky)
    # Skin that turns away from the eye gets a little darker: the outline stays on a white page.
    light *= 0.82 + 0.18 * np.clip(normals[:, 2] * 2.2, 0.0, 1.0)
    gloss = 0.05 * np.maximum(normals @ _GLOSS, 0.0) ** 18 * sky
    return np.asarray(np.clip(colours * np.maximum(light, 0.2)[:, None] + gloss[:, None], 0.0, 1.0))
