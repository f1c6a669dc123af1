"""Colour maps of the fields, safe for colour-blind readers. sRGB in [0, 1]; built in OKLab like `colours`."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Literal

import numpy as np

from .._check import FloatArray
from .colours import SKIN, kernel_map, oklab_to_srgb, srgb_to_oklab, theta_colour

Tones = Literal["kernel", "distance", "signed", "sequential", "angle", "grey"]

BLUE, RED = 255.0, 32.0
"""Hues, in degrees, of the cold and the hot end: they differ for every kind of colour-blindness."""


@cache
def distance_map(size: int = 256) -> FloatArray:
    """(size, 3): cold where near, through pale, to hot where far, as in the paper's Figure 6.

    Both ends keep half of the light: most of a shape may be near, and its form must still show.
    """
    return _through_lab(
        size,
        at=[0.0, 0.25, 0.50, 0.75, 1.0],
        lightness=[0.46, 0.62, 0.90, 0.74, 0.56],
        chroma=[0.150, 0.125, 0.035, 0.125, 0.165],
        hue=[260.0, 245.0, 130.0, 62.0, 32.0],
    )


@cache
def signed_map(size: int = 256) -> FloatArray:
    """(size, 3): blue below zero, bare skin at zero (the middle), red above."""
    skin = srgb_to_oklab(SKIN)
    share = np.linspace(-1.0, 1.0, size)
    hue = np.radians(np.where(share < 0, BLUE, RED))
    reach = np.abs(share)
    lightness = skin[0] + (0.42 - skin[0]) * reach
    chroma = 0.15 * np.sin(0.5 * np.pi * np.minimum(1.25 * reach, 1.0))
    lab = np.stack([lightness, chroma * np.cos(hue), chroma * np.sin(hue)], axis=1)
    lab += np.exp(-((reach / 0.12) ** 2))[:, None] * np.array([0.0, skin[1], skin[2]])
    return oklab_to_srgb(lab)


@cache
def sequential_map(size: int = 256) -> FloatArray:
    """(size, 3): from bare skin through green and teal to deep blue, lightness falling evenly."""
    skin = srgb_to_oklab(SKIN)
    return _through_lab(
        size,
        at=[0.0, 0.15, 0.45, 0.75, 1.0],
        lightness=np.interp([0.0, 0.15, 0.45, 0.75, 1.0], [0, 1], [skin[0], 0.30]),
        chroma=[0.006, 0.06, 0.11, 0.105, 0.10],
        hue=[85.0, 130.0, 172.0, 230.0, 268.0],
    )


@cache
def grey_map(size: int = 256) -> FloatArray:
    """(size, 3): from bare skin to nearly black, for print without colours."""
    skin = srgb_to_oklab(SKIN)
    share = np.linspace(1.0, 0.0, size)[:, None]
    return oklab_to_srgb(share * skin + (1.0 - share) * np.array([0.24, 0.0, 0.0]))


@cache
def angle_map(size: int = 256) -> FloatArray:
    """(size, 3): the hue of θ from 0 to π, the first colour coming again at the end."""
    return theta_colour(np.linspace(0.0, np.pi, size))


_MAPS: dict[Tones, Callable[[int], FloatArray]] = {
    "kernel": kernel_map,
    "distance": distance_map,
    "signed": signed_map,
    "sequential": sequential_map,
    "angle": angle_map,
    "grey": grey_map,
}


def tone_map(tones: Tones, size: int = 256) -> FloatArray:
    """(size, 3): the colours of a field."""
    return _MAPS[tones](size)


def coloured(position: FloatArray, tones: Tones) -> FloatArray:
    """(n, 3): the colours of positions (n,) in [0, 1]."""
    return tone_map(tones)[np.round(255 * np.clip(position, 0.0, 1.0)).astype(np.int64)]


def _through_lab(size: int, *, at: list[float], lightness: object, chroma: list[float], hue: list[float]) -> FloatArray:
    """A smooth path through stops given in cylindrical OKLab."""
    angle, radius = np.radians(hue), np.asarray(chroma)
    lab = np.stack([np.asarray(lightness), radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    share = np.linspace(0.0, 1.0, size)
    return oklab_to_srgb(np.stack([np.interp(share, at, lab[:, axis]) for axis in range(3)], axis=1))
