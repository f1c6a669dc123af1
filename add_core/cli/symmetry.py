"""`add-core symmetry`: the mirror image of every vertex, found by the shape itself."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from ..correspondence import intrinsic_symmetry
from ..errors import ParameterError
from . import options
from .reporting import progress, result
from .shapes import open_shape


@click.command("symmetry")
@click.argument("shape")
@click.option("--alpha", type=float, default=50.0, show_default=True)
@click.option("--angles", type=click.IntRange(min=2), default=16, show_default=True)
@click.option("--count", type=click.IntRange(min=10), default=150, show_default=True, help="K: eigenpairs.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    required=True,
    help="Text file: the number of each vertex's mirror image, a line each.",
)
@options.as_json
def command(shape: str, alpha: float, angles: int, count: int, output: Path, as_json: bool) -> None:
    """Find the map that mirrors SHAPE in whatever pose, by f_θ∘η = f_−θ: what θ is to a point, −θ is to its mirror
    image.

    The best map is written, whether or not it is good enough to be called a symmetry: "found" says so, and "reason"
    why not.
    """
    with progress("Spectra", as_json=as_json) as advance:
        answer = intrinsic_symmetry(open_shape(shape), alpha=alpha, angles=angles, count=count, progress=advance)
    try:
        np.savetxt(output, answer.candidate, fmt="%d")
    except OSError as error:
        raise ParameterError(f"{output} cannot be written: {error.strerror or error}.") from None
    result(
        {
            "found": answer.found,
            "confidence": round(answer.confidence, 3),
            "distortion": round(answer.distortion, 4),
            "reason": answer.reason,
            "output": str(output),
        },
        as_json=as_json,
    )
