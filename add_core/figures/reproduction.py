"""From a list of numbers to files: each figure drawn, saved whole, and remembered before the next begins."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter

import matplotlib
from matplotlib.figure import Figure
from PIL import Image

from .._check import positive
from ..errors import ParameterError
from ..io.atomic import write_atomically
from .cast import Cast, people
from .drawn import NotDrawn
from .gallery import FIGURES, PaperFigure, by_number
from .index_page import FILE as PAGE
from .index_page import index_page
from .page import TYPE
from .quality import QUALITIES, Quality
from .record import Entry, Record
from .studio import Step, Studio, Workshop

FORMATS = ("png", "pdf", "svg")
MODELS = "models"
"""Folder, within that of the figures, of the networks trained for them."""

Watch = Callable[[PaperFigure], AbstractContextManager[Step]]


@dataclass(frozen=True)
class Outcome:
    """What became of a figure. entry : None if it could not be drawn, for the `reason`. kept : it was there already and
    has not been drawn again.
    """

    figure: PaperFigure
    entry: Entry | None
    kept: bool = False
    reason: str = ""


def chosen_figures(numbers: Sequence[int] | None) -> list[PaperFigure]:
    """The figures of these numbers in the paper's order, all for None. Raises ParameterError for an unknown one."""
    if numbers is None:
        return list(FIGURES)
    for number in numbers:
        if by_number(number) is None:
            first, last = FIGURES[0].number, FIGURES[-1].number
            raise ParameterError(f"only must name figures from {first} to {last}, but it names {number}.")
    return [figure for figure in FIGURES if figure.number in numbers]


def reproduce(
    folder: str | Path,
    *,
    only: Sequence[int] | None = None,
    quality: str | Quality = "full",
    image: str = "png",
    again: bool = False,
    train: float | None = None,
    cast: Cast | None = None,
    command: str = "",
    watch: Watch | None = None,
    finished: Callable[[Outcome], object] | None = None,
) -> list[Outcome]:
    """Draw figures of the paper into `folder`, with index.html around them.

    only : numbers of figures. quality : a name of QUALITIES or a Quality. image : one of FORMATS. again : draw what is
    there already too. train : minutes to train each network of Figure 8 for, with few bodies and models kept in
    `folder`; None takes a report that ships. cast : who appears; the shipped people. command : what to tell the reader
    to run. watch : gives for each figure that is drawn a context, whose value is called as step(done, total) along the
    way; whatever that raises ends the work, and the next call goes on with the figure at hand. finished : called after
    each.

    Raises ParameterError for an unknown figure, quality or format, ShapeFileError if the folder cannot be written.
    """
    figures, place = chosen_figures(only), Path(folder)
    level = _quality(quality)
    if image not in FORMATS:
        raise ParameterError(f"format must be one of {', '.join(FORMATS)}, but it is {image!r}.")
    workshop = None if train is None else Workshop(place / MODELS, positive("train", train))
    try:
        place.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ParameterError(f"{place} cannot be made a folder: {error.strerror or error}.") from None
    studio = Studio(cast or people(), level, workshop)
    record, outcomes = Record(place), []
    for figure in figures:
        outcome = _outcome(figure, studio, record, (place, image, command), again=again, watch=watch)
        outcomes.append(outcome)
        undrawn = {one.figure.number: one.reason for one in outcomes if one.entry is None}
        page = index_page(record, undrawn=undrawn)
        write_atomically(place / PAGE, page.encode())
        if finished is not None:
            finished(outcome)
    return outcomes


def _outcome(
    figure: PaperFigure,
    studio: Studio,
    record: Record,
    where: tuple[Path, str, str],
    *,
    again: bool,
    watch: Watch | None,
) -> Outcome:
    folder, image, command = where
    training = studio.workshop.minutes if studio.workshop is not None and figure.can_train else 0.0
    kept = record.finished(figure.number, quality=studio.quality.name, image=image, training=training)
    if kept is not None and not again:
        return Outcome(figure, kept, kept=True)
    try:
        with nullcontext(_ignore) if watch is None else watch(figure) as studio.step:
            entry = _made(figure, studio, folder, image)
    except NotDrawn as error:
        return Outcome(figure, None, reason=str(error))
    entry = replace(entry, training=training, command=command)
    record.add(entry)
    return Outcome(figure, entry)


def _ignore(done: int, total: int) -> None:
    """Nobody asked how far it is."""


def _quality(quality: str | Quality) -> Quality:
    if isinstance(quality, Quality):
        return quality
    if quality not in QUALITIES:
        raise ParameterError(f"quality must be one of {', '.join(QUALITIES)}, but it is {quality!r}.")
    return QUALITIES[quality]


def _made(figure: PaperFigure, studio: Studio, folder: Path, image: str) -> Entry:
    start = perf_counter()
    with matplotlib.rc_context(TYPE):
        drawn = figure.draw(studio)
        picture = _encoded(drawn.figure, image, studio.quality.dots)
    files = {f"{figure.stem}.{image}": picture}
    files |= {f"{figure.stem}.{ending}": text.encode() for ending, text in drawn.tables.items()}
    for name, data in files.items():
        write_atomically(folder / name, data)
    seconds = round(perf_counter() - start, 1)
    said = drawn.caption, drawn.missing
    return Entry(figure.number, tuple(files), *said, studio.quality.name, image, seconds)


def _encoded(figure: Figure, image: str, dots: int) -> bytes:
    """The file of a figure; the same figure gives the same bytes."""
    buffer, stamp = io.BytesIO(), {"svg": {"Date": None}, "pdf": {"CreationDate": None}}
    figure.savefig(buffer, format=image, dpi=dots, metadata=stamp.get(image))
    if image == "png":
        # Without transparency, on a white page, at two thirds of the size.
        picture = Image.open(io.BytesIO(buffer.getvalue())).convert("RGB")
        buffer = io.BytesIO()
        picture.save(buffer, "PNG", optimize=True, dpi=(dots, dots))
    return buffer.getvalue()
