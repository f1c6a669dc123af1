"""`add-core describe`: a signature of every vertex."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import click
import numpy as np

from ..descriptors import (
    anisotropic_heat_kernel_signature,
    anisotropic_heat_kernel_times,
    geometry_vectors,
    heat_kernel_times,
    scale_invariant_heat_kernel_signature,
    scaled_heat_kernel_signature,
    wave_kernel_energies,
    wave_kernel_signature,
    windowed_fourier_descriptor,
)
from ..evaluation.baselines import describe_with
from ..io import extensions, save_shape
from ..operators import Conductivity
from ..spectra import SpectralFamily, compute_spectra
from . import options
from .reporting import progress, result
from .shapes import open_shape


def _hks(family: SpectralFamily, numbers: int) -> np.ndarray:
    return scaled_heat_kernel_signature(family[0], heat_kernel_times(family[0], numbers))


def _si_hks(family: SpectralFamily, numbers: int) -> np.ndarray:
    return scale_invariant_heat_kernel_signature(family[0], frequencies=numbers)


def _wks(family: SpectralFamily, numbers: int) -> np.ndarray:
    chosen = wave_kernel_energies(family[0], numbers)
    return wave_kernel_signature(family[0], chosen.energies, width=chosen.width)


def _wft(family: SpectralFamily, numbers: int) -> np.ndarray:
    signals = _hks(family, 1)
    return windowed_fourier_descriptor(family[0], signals, frequencies=numbers)[:, 0]


def _ahks(family: SpectralFamily, numbers: int) -> np.ndarray:
    return anisotropic_heat_kernel_signature(family, anisotropic_heat_kernel_times(family, numbers))


def _splines(family: SpectralFamily, numbers: int) -> np.ndarray:
    return geometry_vectors(family, count=numbers)


SIGNATURES: dict[str, Callable[[SpectralFamily, int], np.ndarray]] = {
    "hks": _hks,
    "si-hks": _si_hks,
    "wks": _wks,
    "wft": _wft,
    "ahks": _ahks,
    "geometry-vectors": _splines,
}
_DIRECTED = ("ahks", "geometry-vectors")


@click.command("describe")
@click.argument("names", metavar="[MODEL] SHAPE", nargs=-1, required=True)
@click.option("--descriptor", type=click.Choice(list(SIGNATURES)), default="ahks", show_default=True)
@click.option("--numbers", type=int, default=16, show_default=True, help="Times, energies, frequencies or splines.")
@click.option("--alphas", type=options.Numbers(), default=(50.0,), show_default="50", help="Of directed descriptors.")
@click.option("--angles", type=int, default=16, show_default=True, help="Of directed descriptors.")
@click.option("--count", type=int, default=300, show_default=True, help="K: eigenpairs of each operator.")
@click.option(
    "--compared", is_flag=True, help="As descriptors are compared: logarithms, each number standardised over the shape."
)
@options.conductivity
@options.own_units
@options.output(extensions(holding_fields=True), required=True)
@options.as_json
def command(
    names: tuple[str, ...],
    descriptor: str,
    numbers: int,
    alphas: tuple[float, ...],
    angles: int,
    count: int,
    compared: bool,
    conductivity: Conductivity,
    own_units: bool,
    output: Path,
    as_json: bool,
) -> None:
    """A signature of every vertex of SHAPE, as a field of the shape in the file written.

    MODEL is a file or a folder of `add-core train`, or the name of a shipped one such as humans-madd3; it knows all
    options itself. A correspondence network gives the reference's vertex that each vertex most probably is, how
    probable that is, and where it lies.
    hks, si-hks, wks and wft are isotropic: they cannot tell left from right. ahks and geometry-vectors have `numbers`
    values for each α and angle, angle after angle. --compared adds α = 0 to them and has numbers of its own, those of
    `add-core match` and `evaluate`.
    """
    if len(names) > 1:
        _learned(names, output, as_json=as_json)
        return
    shape = names[0]
    worked_on = options.shape_to_work_on(shape, own_units=own_units)
    directed = descriptor in _DIRECTED
    with progress("Spectra", as_json=as_json) as advance:
        family = compute_spectra(
            worked_on,
            alphas=_degrees(alphas, compared=compared) if directed else (0.0,),
            angles=angles,
            count=min(count, int(worked_on.vertex_count)),
            conductivity=conductivity,
            progress=advance,
        )
    values = describe_with(descriptor, family) if compared else SIGNATURES[descriptor](family, numbers)
    values = values.reshape(len(values), -1)
    save_shape(open_shape(shape), output, fields={descriptor.replace("-", "_"): values})
    facts = {
        "descriptor": descriptor,
        "vertices": len(values),
        "numbers": values.shape[1],
        "unit of length": options.length_unit(own_units),
        "output": str(output),
    }
    result(facts, as_json=as_json)


def _degrees(alphas: tuple[float, ...], *, compared: bool) -> tuple[float, ...]:
    return (0.0, *(alpha for alpha in alphas if alpha > 0)) if compared else alphas


def _learned(names: tuple[str, ...], output: Path, *, as_json: bool) -> None:
    if len(names) > 2:
        raise click.UsageError(f"One model and one shape at a time, but there are {len(names)} names.")
    from ..learning import load_model

    model, shape = load_model(names[0]), open_shape(names[1])
    with progress("Spectra", as_json=as_json) as advance:
        if model.network.is_classifier:
            found = model.match(shape, progress=advance)
            fields = {"reference_vertex": found.vertices, "probability": found.probabilities}
            if model.reference is not None:
                fields = {"learned": model.reference.vertices[found.vertices], **fields}
        else:
            fields = {"learned": model.describe(shape, progress=advance)}
    save_shape(shape, output, fields=fields)
    facts = {
        "descriptor": names[0],
        "vertices": shape.vertex_count,
        "numbers": fields["learned"].shape[1] if "learned" in fields else 1,
        "unit of length": options.length_unit(False),
        "output": str(output),
    }
    result(facts, as_json=as_json)
