"""`add-core spectra`: eigenvalues and eigenfunctions of every angle and anisotropy of a shape."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Literal

import click
import numpy as np

from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh
from ..io import save_arrays
from ..operators import AnisotropicLaplacian, Conductivity
from ..spectra import SpectralFamily, compute_spectra, compute_spectrum
from . import options
from .reporting import progress, result


@click.command("spectra")
@click.argument("shape")
@click.option("--alphas", type=options.Numbers(), default=(0.0, 25.0, 50.0), show_default="0,25,50")
@click.option("--angles", type=int, default=16, show_default=True, help="L: angles evenly from 0° up to 180°.")
@click.option("--theta", type=float, help="In degrees: the operator at this angle alone, of the one α given. Not kept.")
@click.option("--count", type=int, default=300, show_default=True, help="K: eigenpairs of each operator.")
@click.option("--precision", type=click.Choice(("float64", "float32")), default="float64", show_default=True)
@click.option("--workers", type=int, help="Processes; by default one for each core, at most four.")
@click.option("--no-cache", is_flag=True, help="Compute anew, and keep nothing.")
@options.conductivity
@options.own_units
@options.output((".npz",))
@options.as_json
def command(
    shape: str,
    alphas: tuple[float, ...],
    angles: int,
    theta: float | None,
    count: int,
    precision: Literal["float64", "float32"],
    workers: int | None,
    no_cache: bool,
    conductivity: Conductivity,
    own_units: bool,
    output: Path | None,
    as_json: bool,
) -> None:
    """Eigenvalues and eigenfunctions of the anisotropic Laplacians of SHAPE.

    They are kept on disk (see `add-core cache`), so that the same request is answered at once the next time. The NPZ
    file holds alphas, thetas, eigenvalues, eigenfunctions and mass, as numpy.load reads them.
    """
    worked_on = options.shape_to_work_on(shape, own_units=own_units)
    start = perf_counter()
    with progress("Spectra", as_json=as_json) as advance:
        if theta is not None:
            family = _at_one_angle(worked_on, alphas, theta, count, conductivity)
        else:
            family = compute_spectra(
                worked_on,
                alphas=alphas,
                angles=angles,
                count=count,
                conductivity=conductivity,
                dtype=precision,
                workers=workers,
                cache=not no_cache,
                progress=advance,
            )
    if output is not None:
        _save(family, output, precision)
    values = {
        "operators": len(family),
        "eigenpairs of each": count,
        "unit of length": options.length_unit(own_units),
        "highest eigenvalue": float(family.eigenvalues.max()),
        "seconds": round(perf_counter() - start, 2),
    }
    result(values | ({"output": str(output)} if output else {}), as_json=as_json)


def _at_one_angle(
    shape: TriangleMesh | PointCloud, alphas: tuple[float, ...], theta: float, count: int, conductivity: Conductivity
) -> SpectralFamily:
    if len(alphas) != 1:
        raise ParameterError(f"--theta asks for one operator, but --alphas names {len(alphas)}. Give one α.")
    laplacian = AnisotropicLaplacian(shape, alpha=alphas[0], conductivity=conductivity)
    found = compute_spectrum(laplacian, theta=float(np.radians(theta)), count=count)
    return SpectralFamily(
        alphas=np.array(alphas),
        thetas=np.radians([theta]),
        eigenvalues=found.eigenvalues[None],
        eigenfunctions=found.eigenfunctions[None],
        mass=found.mass,
        name=shape.name,
        conductivity=conductivity,
    )


def _save(family: SpectralFamily, output: Path, precision: str) -> None:
    kept = replace(family, eigenfunctions=np.asarray(family.eigenfunctions, dtype=precision))
    names = ("alphas", "thetas", "eigenvalues", "eigenfunctions", "mass")
    save_arrays(output, {name: getattr(kept, name) for name in names})
