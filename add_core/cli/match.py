"""`add-core match`: the points of one shape on another."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from .._check import IntArray
from ..correspondence import icp, nearest_matches, zoomout
from ..correspondence.functional_map import FunctionalMap
from ..errors import ParameterError
from ..evaluation.baselines import BASELINES, describe_with, functional_map_matches, isotropic
from ..geometry import PointCloud, TriangleMesh, normalize
from ..io import save_shape
from ..spectra import SpectralFamily, compute_spectra
from .reporting import Advance, progress, result
from .shapes import open_shape

REFINEMENTS = ("none", "fm", "icp", "zoomout")


@click.command("match")
@click.argument("first")
@click.argument("second")
@click.option(
    "--descriptor",
    default="ahks",
    show_default=True,
    help=f"{', '.join(BASELINES)}, fm (functional maps), or a model of add-core train.",
)
@click.option(
    "--refine", type=click.Choice(REFINEMENTS), default="zoomout", show_default=True, help="By a functional map."
)
@click.option(
    "--size", type=click.IntRange(min=4), default=120, show_default=True, help="Eigenfunctions to refine with."
)
@click.option("--count", type=click.IntRange(min=10), default=200, show_default=True, help="K: eigenpairs.")
@click.option("--alpha", type=float, default=50.0, show_default=True)
@click.option("--angles", type=click.IntRange(min=1), default=16, show_default=True)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    required=True,
    help="Text file: a vertex number of FIRST for each vertex of SECOND, a line each.",
)
@click.option(
    "--colors", type=click.Path(path_type=Path, dir_okay=False), help="Also write SECOND with FIRST's colours."
)
@click.option("--json", "as_json", is_flag=True, help="JSON lines on stdout: progress and the result.")
def command(
    first: str,
    second: str,
    descriptor: str,
    refine: str,
    size: int,
    count: int,
    alpha: float,
    angles: int,
    output: Path,
    colors: Path | None,
    as_json: bool,
) -> None:
    """Find for each vertex of SECOND the vertex of FIRST at the same place, by descriptors alone.

    Shapes may be meshes or clouds, with any numbers of vertices; both are scaled to unit geodesic diameter first.
    Vertex numbers start at 0.
    """
    shapes = open_shape(first), open_shape(second)
    with progress("Spectra", as_json=as_json) as advance:
        families = _families(shapes, alpha, angles, count, advance)
    matches = _raw(descriptor, shapes, families)
    matches, found = _refined(matches, families, refine, size)
    try:
        np.savetxt(output, matches, fmt="%d")
    except OSError as error:
        raise ParameterError(f"{output} cannot be written: {error.strerror or error}.") from None
    if colors is not None:
        from ..correspondence import transfer_colors

        carried = transfer_colors(shapes[0], matches, smooth_map=found)
        save_shape(shapes[1], colors, fields={"transferred": carried.smooth, "match": matches.astype(np.float64)})
    result(
        {
            "descriptor": descriptor,
            "refined by": refine,
            "vertices of first": shapes[0].vertex_count,
            "vertices of second": shapes[1].vertex_count,
            "different matches": len(np.unique(matches)),
            "output": str(output),
        },
        as_json=as_json,
    )


def _families(
    shapes: tuple[TriangleMesh | PointCloud, TriangleMesh | PointCloud],
    alpha: float,
    angles: int,
    count: int,
    advance: Advance,
) -> tuple[SpectralFamily, SpectralFamily]:
    found = []
    for position, shape in enumerate(shapes):

        def both(done: int, total: int, position: int = position) -> None:
            advance(position * total + done, 2 * total)

        k = min(count, shape.vertex_count - 1)
        found.append(compute_spectra(normalize(shape), alphas=(0.0, alpha), angles=angles, count=k, progress=both))
    return found[0], found[1]


def _raw(
    descriptor: str,
    shapes: tuple[TriangleMesh | PointCloud, TriangleMesh | PointCloud],
    families: tuple[SpectralFamily, SpectralFamily],
) -> IntArray:
    if descriptor == "fm":
        return functional_map_matches(*families)
    if descriptor in BASELINES:
        one, two = (describe_with(descriptor, family) for family in families)
    else:
        from ..learning import load_model

        model = load_model(descriptor)
        one, two = (np.asarray(model.describe(shape), dtype=np.float64) for shape in shapes)
    return nearest_matches(two, one)


def _refined(
    matches: IntArray, families: tuple[SpectralFamily, SpectralFamily], refine: str, size: int
) -> tuple[IntArray, FunctionalMap | None]:
    if refine == "none":
        return matches, None
    one, two = isotropic(families[0]), isotropic(families[1])
    if refine == "zoomout":
        found = zoomout(one, two, matches, stop=size)
    else:
        most = min(size, len(one.eigenvalues), len(two.eigenvalues))
        found = FunctionalMap.from_matches(one, two, matches, count=most)
        found = icp(found) if refine == "icp" else found
    return found.match_21, found
