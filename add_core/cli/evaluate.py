"""`add-core evaluate`: descriptors by the paper's three protocols, as tables, curves and one page."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import click

from ..contest import Describer, Pair, chosen_pairs
from ..contest.pairs import FOREST, MAPS
from ..errors import ParameterError
from ..evaluation import Scores, averaged, save_report, table
from ..evaluation.baselines import BASELINES
from ..evaluation.samples import VARIANTS, sample
from ..evaluation.scores import PROTOCOLS
from ..io import Collection, dogs, humans, poses
from .reporting import progress, result

COLLECTIONS = {"humans": humans, "poses": poses, "dogs": dogs}


@click.command("evaluate")
@click.argument("models", metavar="[RUN|MODEL]...", nargs=-1)
@click.option("--data", type=click.Choice(list(COLLECTIONS)), default="humans", show_default=True)
@click.option(
    "--variant",
    type=click.Choice(VARIANTS),
    default="mesh",
    show_default=True,
    help="Same triangles, other triangles (test people only), or clouds of 4,000 points.",
)
@click.option(
    "--descriptors",
    default=None,
    show_default="hks,wks,ahks without RUN",
    help=f"Some of {', '.join(BASELINES)}, {MAPS} "
    f"(functional maps), {FOREST} (random forest) or models of add-core train, with commas; "
    f"+zoomout after one refines its matches, +zoomout-plain does so without a guide.",
)
@click.option("--protocol", type=click.Choice(["all", *PROTOCOLS]), default="all", show_default=True)
@click.option("--pairs", type=click.IntRange(min=1), default=6, show_default=True, help="Pairs of test shapes.")
@click.option("--seed", type=int, default=0, show_default=True, help="Which pairs.")
@click.option("--queries", type=click.IntRange(min=1), help="Points asked for on each shape.", show_default="all")
@click.option("--count", type=click.IntRange(min=10), default=300, show_default=True, help="K: eigenpairs.")
@click.option("--alpha", type=float, default=50.0, show_default=True)
@click.option("--angles", type=click.IntRange(min=1), default=16, show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path, file_okay=False), help="Folder for the report.")
@click.option("--json", "as_json", is_flag=True, help="JSON: the result on stdout, progress on stderr, a line each.")
def command(
    models: tuple[str, ...],
    data: str,
    variant: str,
    descriptors: str | None,
    protocol: str,
    pairs: int,
    seed: int,
    queries: int | None,
    count: int,
    alpha: float,
    angles: int,
    output: Path | None,
    as_json: bool,
) -> None:
    """Match test shapes by descriptors, and compare with the truth: CMC, ROC, Princeton and P(right side).

    RUN is the folder of a training, or a model by its file or name; models may be among the --descriptors too. Of
    correspondence networks the matches count: points are near each other where their places on the reference are.

    Each shape is scaled to unit geodesic diameter; spectra are kept in the cache. With -o, a folder is written with
    index.html, curves.svg, scores.csv, curves.csv and scores.json.
    """
    methods = _methods(models, descriptors)
    if data != humans().title and any(method.startswith(FOREST) for method in methods):
        raise ParameterError(f"descriptors must not name {FOREST} for {data}: it is trained on the shipped people.")
    protocols = PROTOCOLS if protocol == "all" else (protocol,)
    collection = COLLECTIONS[data]()
    chosen = chosen_pairs(collection, pairs, seed)
    describer = Describer(alpha=alpha, angles=angles, count=count)
    found: dict[str, list[Scores]] = {method: [] for method in methods}
    with progress("Pairs and descriptors", as_json=as_json) as advance:
        for number, numbers in enumerate(chosen):
            done, total = number * (1 + len(methods)), len(chosen) * (1 + len(methods))
            advance(done, total)
            source, target = (sample(collection, index, variant) for index in numbers)
            pair = Pair(source, target, describer)
            for order, method in enumerate(methods, start=1):
                advance(done + order, total)
                found[method].append(pair.scores(method, protocols=protocols, queries=queries))
        advance(total, total)
    scores = [averaged(found[method]) for method in methods]
    if output is not None:
        _save(scores, output, collection, variant, chosen, queries, count, as_json=as_json)
    if as_json:
        result({score.method: score.numbers for score in scores}, as_json=True)
    else:
        click.echo(table(scores))


def _methods(models: tuple[str, ...], descriptors: str | None) -> list[str]:
    listed = ("" if models else "hks,wks,ahks") if descriptors is None else descriptors
    names = [*models, *(name.strip() for name in listed.split(",") if name.strip())]
    if not names:
        raise ParameterError("descriptors must name at least one, but the list is empty.")
    return list(dict.fromkeys(names))


def _save(
    scores: list[Scores],
    output: Path,
    collection: Collection,
    variant: str,
    chosen: list[tuple[int, int]],
    queries: int | None,
    count: int,
    *,
    as_json: bool,
) -> None:
    listed = "; ".join(f"{collection.names[i]} → {collection.names[j]}" for i, j in chosen)
    asked = "all points" if queries is None else f"{queries} points spread evenly over each first shape"
    notes = [
        f"Mean over {len(chosen)} pairs of test shapes ({variant}): {listed}.",
        f"Asked: {asked}, among all points of the second shape. {count} eigenfunctions. Errors and radii are geodesic "
        "distances ÷ √area; symmetric scores count the mirror image as true.",
    ]
    command = "add-core " + shlex.join(sys.argv[1:])
    save_report(scores, output, title=f"{collection.title}, {variant}", command=command, notes=notes)
    if not as_json:
        click.echo(f"Report: {output / 'index.html'}")
