"""Reading values off computed curves at any time and angle, without computing them anew."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from .results import AutodiffusionCurves, FloatArray

_FINER = 8
"""Points drawn for each computed angle."""


def over_theta(curves: AutodiffusionCurves, reach: float) -> FloatArray:
    """(L,) h(x, x) at t·λ₁ = `reach` for every computed angle, interpolated between times (log in both)."""
    position = np.log(np.clip(reach, curves.reaches[0], curves.reaches[-1]))
    at = np.log(curves.reaches)
    upper = int(np.clip(np.searchsorted(at, position), 1, len(at) - 1))
    share = (position - at[upper - 1]) / (at[upper] - at[upper - 1])
    values: FloatArray = np.exp(
        (1 - share) * np.log(curves.values[:, upper - 1]) + share * np.log(curves.values[:, upper])
    )
    return values


def over_time(curves: AutodiffusionCurves, theta: float) -> FloatArray:
    """(T,) h(x, x) at angle `theta` for every time, interpolated between the computed angles (period π)."""
    thetas = np.concatenate([curves.thetas, curves.thetas[:1] + np.pi])
    values = np.vstack([curves.values, curves.values[:1]])
    angle = theta % np.pi
    angle += np.pi if angle < thetas[0] else 0.0
    upper = int(np.clip(np.searchsorted(thetas, angle), 1, len(thetas) - 1))
    gap = thetas[upper] - thetas[upper - 1]
    share = (angle - thetas[upper - 1]) / gap if gap > 0 else 0.0
    row: FloatArray = (1 - share) * values[upper - 1] + share * values[upper]
    return row


def read_backwards(thetas: FloatArray, values: FloatArray) -> FloatArray:
    """(L,) `values` over `thetas` (L,) at −θ instead of θ, interpolated: f_−θ, which is f_θ of the mirror image."""
    return np.interp(-thetas, thetas, values, period=np.pi)


def once_around(curves: AutodiffusionCurves, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angles from θ₀ to θ₀ + π, and `values` (L,) > 0 over them as a closed smooth curve, for drawing alone.

    A periodic cubic spline of log values goes through every computed one and stays positive; what it adds between
    them is a reading. With fewer than four angles it would invent waves: then both are (L + 1,), joined by lines.
    """
    thetas, closed = np.append(curves.thetas, curves.thetas[0] + np.pi), np.append(values, values[0])
    if len(values) < 4:
        return thetas, closed
    steps = np.arange(_FINER * len(values) + 1) / _FINER
    angles = np.interp(steps, np.arange(len(thetas)), thetas)
    return angles, np.exp(CubicSpline(thetas, np.log(closed), bc_type="periodic")(angles))
