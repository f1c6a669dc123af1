"""Every colour that carries a meaning, the same in views, curves and exports. sRGB in [0, 1].

Built in OKLab (Ottosson 2020), where equal steps look equal, so that no map shows edges that the data has not.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray

SKIN = (0.862, 0.845, 0.822)
"""Uncoloured shapes and the low end of every kernel map: no heat looks like bare skin."""

MARKERS: tuple[tuple[float, float, float], ...] = (
    (0.090, 0.500, 0.800),
    (0.835, 0.369, 0.000),
    (0.000, 0.620, 0.451),
    (0.800, 0.475, 0.655),
    (0.902, 0.624, 0.000),
    (0.337, 0.706, 0.914),
    (0.560, 0.330, 0.190),
    (0.420, 0.420, 0.440),
)
"""One for each of eight picked points, after Okabe and Ito: told apart by colour-blind readers, on light and dark."""

_LMS_FROM_LAB = np.array(
    [[1.0, 0.3963377774, 0.2158037573], [1.0, -0.1055613458, -0.0638541728], [1.0, -0.0894841775, -1.2914855480]]
)
_RGB_FROM_LMS = np.array(
    [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ]
)


def oklab_to_srgb(lab: ArrayLike) -> FloatArray:
    """(…, 3) OKLab to (…, 3) sRGB, clipped to what a screen shows."""
    linear = (np.asarray(lab, dtype=np.float64) @ _LMS_FROM_LAB.T) ** 3 @ _RGB_FROM_LMS.T
    linear = np.clip(linear, 0.0, 1.0)
    curve: FloatArray = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return curve


def srgb_to_oklab(rgb: ArrayLike) -> FloatArray:
    """(…, 3) sRGB to (…, 3) OKLab, the inverse of `oklab_to_srgb`."""
    rgb = np.asarray(rgb, dtype=np.float64)
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    lab: FloatArray = np.cbrt(linear @ np.linalg.inv(_RGB_FROM_LMS).T) @ np.linalg.inv(_LMS_FROM_LAB).T
    return lab


def lch(lightness: ArrayLike, chroma: ArrayLike, hue: ArrayLike) -> FloatArray:
    """OKLCH to sRGB, hue in degrees; arguments broadcast."""
    lightness, chroma, hue = np.broadcast_arrays(lightness, chroma, np.radians(hue))
    return oklab_to_srgb(np.stack([lightness, chroma * np.cos(hue), chroma * np.sin(hue)], axis=-1))


def theta_colour(theta: ArrayLike) -> FloatArray:
    """(…, 3): the hue of angle θ (radians) with period π, the same on the dial, the arrows and the curves.

    Lightness swings with the hue so that 0°, 45°, 90° and 135° stay apart for readers who see two primaries only.
    """
    turn = 2.0 * np.asarray(theta, dtype=np.float64)
    return lch(0.62 - 0.06 * np.cos(turn), 0.135, 28.0 + np.degrees(turn))


@cache
def kernel_map(size: int = 256) -> FloatArray:
    """(size, 3): from bare skin through amber and crimson to deep violet, lightness falling evenly.

    The dark end keeps a third of the light, so that shading still shows the form where the heat is greatest.
    """
    skin = srgb_to_oklab(SKIN)
    stops = np.array([0.0, 0.12, 0.38, 0.62, 0.82, 1.0])
    lightness = skin[0] + (0.27 - skin[0]) * stops
    chroma = np.array([0.0, 0.075, 0.150, 0.185, 0.150, 0.105])
    hue = np.radians([78.0, 70.0, 48.0, 18.0, -28.0, -62.0])
    lab = np.stack([lightness, chroma * np.cos(hue), chroma * np.sin(hue)], axis=1)
    lab[0] = skin
    at = np.linspace(0.0, 1.0, size)
    return oklab_to_srgb(np.stack([np.interp(at, stops, lab[:, axis]) for axis in range(3)], axis=1))


def hex_colour(rgb: ArrayLike) -> str:
    """(3,) sRGB as "#rrggbb"."""
    red, green, blue = np.round(255 * np.clip(np.asarray(rgb, dtype=np.float64), 0, 1)).astype(int)
    return f"#{red:02x}{green:02x}{blue:02x}"
