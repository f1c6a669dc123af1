"""`add-core kernel`: where heat is, some time after it was dropped on a vertex."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from ..io import extensions, save_shape
from ..operators import AnisotropicLaplacian, Conductivity
from ..spectra import HeatFlow
from . import options
from .reporting import result
from .shapes import open_shape

_SPREAD = 5.0
_MODES = 300


@click.command("kernel")
@click.argument("shape")
@click.option("--source", type=int, required=True, help="Number of the vertex, from 0.")
@click.option("--alpha", type=float, default=50.0, show_default=True, help="Degree of anisotropy; 0 is isotropic.")
@click.option("--theta", type=float, default=0.0, show_default=True, help="Degrees from the maximum curvature.")
@click.option("--time", type=float, help="Diffusion time, length². Default: one between local and global.")
@options.conductivity
@options.own_units
@options.output(extensions(holding_fields=True))
@options.as_json
def command(
    shape: str,
    source: int,
    alpha: float,
    theta: float,
    time: float | None,
    conductivity: Conductivity,
    own_units: bool,
    output: Path | None,
    as_json: bool,
) -> None:
    """The anisotropic heat kernel of one vertex of SHAPE, eq. (17).

    The file written holds SHAPE as it is, with the kernel as the field `heat_kernel`.
    """
    worked_on = options.shape_to_work_on(shape, own_units=own_units)
    laplacian = AnisotropicLaplacian(worked_on, alpha=alpha, conductivity=conductivity)
    moment = _SPREAD / laplacian.weyl_eigenvalue(_MODES) if time is None else time
    heat = HeatFlow(laplacian).kernel(source, theta=float(np.radians(theta)), time=moment)
    if output is not None:
        save_shape(open_shape(shape), output, fields={"heat_kernel": heat})
    values = {
        "vertex": source,
        "alpha": alpha,
        "theta": theta,
        "time": moment,
        "unit of length": options.length_unit(own_units),
        "heat left at the vertex": float(heat[source]),
        "share of the area that holds half of the heat": _area_of_half(heat, laplacian.mass),
    }
    result(values | ({"output": str(output)} if output else {}), as_json=as_json)


def _area_of_half(heat: np.ndarray, mass: np.ndarray) -> float:
    order = np.argsort(heat)[::-1]
    held = np.cumsum((mass * heat)[order])
    inside = order[: int(np.searchsorted(held, held[-1] / 2)) + 1]
    return float(mass[inside].sum() / mass.sum())
