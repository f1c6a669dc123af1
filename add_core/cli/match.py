"""`add-core match`: the points of one shape on another."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from .._check import FloatArray, IntArray
from ..correspondence import icp, nearest_matches, zoomout
from ..correspondence.functional_map import FunctionalMap
from ..errors import ParameterError, ShapeFileError
from ..evaluation import match_errors, surface_area
from ..evaluation.baselines import (
    BASELINES,
    DIRECTED,
    UNDIRECTED,
    describe_with,
    functional_map_matches,
    isotropic,
    refined_matches,
)
from ..geometry import PointCloud, TriangleMesh, normalize
from ..geometry.pair_distances import PairDistances
from ..io import known_matches, save_arrays, save_shape, shipped_place
from ..io.contents import indices
from ..io.text import float_rows, lines_of
from ..spectra import SpectralFamily, compute_spectra
from .reporting import Advance, progress, result
from .shapes import open_shape

REFINEMENTS = ("none", "fm", "icp", "zoomout", "zoomout-plain")


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
    "--refine",
    type=click.Choice(REFINEMENTS),
    default="zoomout",
    show_default=True,
    help="By a functional map; zoomout is guided by descriptors that tell left from right, zoomout-plain is not.",
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
    help="Text file: a vertex number of FIRST for each vertex of SECOND, a line each. Ending in .npz: an archive of "
    "matches, matches before refinement and, with --truth, their errors.",
)
@click.option(
    "--truth",
    metavar="FILE",
    help="Text file like the output, -1 where unknown; 'same': equal numbers correspond; 'known': of shipped shapes. "
    "Reports the errors.",
)
@click.option(
    "--colors", type=click.Path(path_type=Path, dir_okay=False), help="Also write SECOND with FIRST's colours."
)
@click.option("--json", "as_json", is_flag=True, help="JSON: the result on stdout, progress on stderr, a line each.")
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
    truth: str | None,
    colors: Path | None,
    as_json: bool,
) -> None:
    """Find for each vertex of SECOND the vertex of FIRST at the same place, by descriptors alone.

    Shapes may be meshes or clouds, with any numbers of vertices; both are scaled to unit geodesic diameter first.
    Vertex numbers start at 0.
    """
    shapes = open_shape(first), open_shape(second)
    true = None if truth is None else _truth(truth, first, second, shapes[1].vertex_count)
    guided = refine == "zoomout" and descriptor in UNDIRECTED
    alphas = (0.0, alpha) if descriptor in DIRECTED or guided else (0.0,)
    with progress("Spectra", as_json=as_json) as advance:
        families = _families(shapes, alphas, angles, count, advance)
    if descriptor == "fm":
        raw, guides = functional_map_matches(*families), None
    else:
        described = _described(descriptor, shapes, families)
        raw, guides = nearest_matches(described[1], described[0]), None if guided else described
    matches, found = _refined(raw, families, refine, size, guides)
    errors = {} if true is None else _errors(first, shapes[0], true, raw, matches)
    _save(output, raw, matches, errors)
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
            **{f"mean {name.replace('_', ' ')}": round(float(np.nanmean(e)), 4) for name, e in errors.items()},
            "output": str(output),
        },
        as_json=as_json,
    )


def _truth(name: str, first: str, second: str, count: int) -> IntArray:
    """(n2,): the true vertex of the first for each of the second."""
    if name == "same":
        return np.arange(count)
    if name == "known":
        one, two = shipped_place(first), shipped_place(second)
        known = None if one is None or two is None else known_matches(one, two)
        if known is None:
            raise ParameterError(f"the true correspondence of {first} and {second} is not known. Give a file with it.")
        return known
    try:
        return indices(float_rows(lines_of(Path(name).read_bytes()), 1, "the number of a vertex")[:, 0])
    except (OSError, ShapeFileError) as error:
        raise ParameterError(f"{name} is not a list of vertex numbers, one a line ({error}).") from None


def _errors(
    first: str, shape: TriangleMesh | PointCloud, truth: IntArray, raw: IntArray, matches: IntArray
) -> dict[str, FloatArray]:
    """Geodesic errors ÷ √area (n2,) before and after refinement, NaN where unknown; symmetric too, where η is known."""
    place = None if Path(first).exists() else shipped_place(first)
    settings = {"": None} if place is None else {"": None, "_symmetric": place.collection.symmetry}
    distances, area = PairDistances(shape), surface_area(shape)
    return {
        f"{name}error{setting}": match_errors(found, truth, symmetry=chart, distances=distances, area=area)
        for name, found in (("raw_", raw), ("", matches))
        for setting, mirror in settings.items()
        for chart in [np.arange(shape.vertex_count) if mirror is None else mirror]
    }


def _save(output: Path, raw: IntArray, matches: IntArray, errors: dict[str, FloatArray]) -> None:
    if output.suffix.lower() == ".npz":
        save_arrays(output, {"matches": matches, "raw_matches": raw, **errors})
        return
    try:
        np.savetxt(output, matches, fmt="%d")
    except OSError as error:
        raise ParameterError(f"{output} cannot be written: {error.strerror or error}.") from None


def _families(
    shapes: tuple[TriangleMesh | PointCloud, TriangleMesh | PointCloud],
    alphas: tuple[float, ...],
    angles: int,
    count: int,
    advance: Advance,
) -> tuple[SpectralFamily, SpectralFamily]:
    found = []
    for position, shape in enumerate(shapes):

        def both(done: int, total: int, position: int = position) -> None:
            advance(position * total + done, 2 * total)

        k = min(count, max(1, int(shape.has_mass.sum()) - 1))
        found.append(compute_spectra(normalize(shape), alphas=alphas, angles=angles, count=k, progress=both))
    return found[0], found[1]


def _described(
    descriptor: str,
    shapes: tuple[TriangleMesh | PointCloud, TriangleMesh | PointCloud],
    families: tuple[SpectralFamily, SpectralFamily],
) -> tuple[FloatArray, FloatArray]:
    if descriptor in BASELINES:
        one, two = (describe_with(descriptor, family) for family in families)
    else:
        from ..learning import load_model

        model = load_model(descriptor)
        one, two = (np.asarray(model.embed(shape), dtype=np.float64) for shape in shapes)
    return one, two


def _refined(
    matches: IntArray,
    families: tuple[SpectralFamily, SpectralFamily],
    refine: str,
    size: int,
    guides: tuple[FloatArray, FloatArray] | None,
) -> tuple[IntArray, FunctionalMap | None]:
    if refine == "none":
        return matches, None
    one, two = isotropic(families[0]), isotropic(families[1])
    if refine == "zoomout":
        found = refined_matches(*families, matches, guides=guides, size=size)
    elif refine == "zoomout-plain":
        found = zoomout(one, two, matches, stop=size)
    else:
        most = min(size, len(one.eigenvalues), len(two.eigenvalues))
        found = FunctionalMap.from_matches(one, two, matches, count=most)
        found = icp(found) if refine == "icp" else found
    return found.match_21, found
