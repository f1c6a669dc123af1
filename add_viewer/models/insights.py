"""What the fields tell in numbers: best matches, left from right, quality of a matching. Shown, never saved."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from psygnal import Signal

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class BestMatch:
    """A vertex that is much like the picked point.

    distance : in descriptor space, ÷ the median distance on that shape. error : geodesic distance to the true place, in
    diameters; None where the truth is not known, or not measured yet. is_mirror : it is the mirror image instead.
    """

    shape: str
    vertex: int
    distance: float
    error: float | None = None
    is_mirror: bool = False


@dataclass(frozen=True)
class Telling:
    """How far a descriptor tells a point from its mirror image.

    ratio : their distance ÷ the median distance of two points; None while unknown, `message` then says why.
    """

    descriptor: str
    ratio: float | None = None
    message: str = ""


@dataclass(frozen=True, eq=False)
class QualityCurve:
    """Share y of matches within geodesic radius x ÷ √area of the truth, both (r,).

    mean : geodesic error in diameters. exact : share of exact matches.
    """

    x: FloatArray
    y: FloatArray
    mean: float
    exact: float


@dataclass(frozen=True, eq=False)
class MatchQuality:
    """How good the matches of one target are.

    curves : by (refined, symmetric); empty where no truth is known. message : what is being done, or why nothing is
    known; "" once the matches are there.
    """

    target: str
    message: str = ""
    curves: dict[tuple[bool, bool], QualityCurve] = field(default_factory=dict)


class Insights:
    """The latest numbers. best : by panel and shape. tellings : one for each descriptor. qualities : one a target.

    mirror_message : what is happening to the search for a mirror map, "" for nothing. descriptors : names to choose
    from.
    """

    best_changed = Signal()
    tellings_changed = Signal()
    qualities_changed = Signal()
    descriptors_changed = Signal()

    def __init__(self) -> None:
        self.best: dict[tuple[int, str], tuple[BestMatch, ...]] = {}
        self.tellings: tuple[Telling, ...] = ()
        self.mirror_message = ""
        self.qualities: tuple[MatchQuality, ...] = ()
        self.descriptors: tuple[str, ...] = ()

    def set_best(self, best: dict[tuple[int, str], tuple[BestMatch, ...]]) -> None:
        """The best matches of every view that shows distances."""
        if best != self.best:
            self.best = best
            self.best_changed.emit()

    def set_tellings(self, tellings: tuple[Telling, ...], mirror_message: str) -> None:
        """Left from right at the picked point, and what is happening to the mirror map."""
        if (tellings, mirror_message) != (self.tellings, self.mirror_message):
            self.tellings, self.mirror_message = tellings, mirror_message
            self.tellings_changed.emit()

    def set_qualities(self, qualities: tuple[MatchQuality, ...]) -> None:
        """The quality of the matches of every target."""
        if qualities or self.qualities:
            self.qualities = qualities
            self.qualities_changed.emit()

    def set_descriptors(self, names: tuple[str, ...]) -> None:
        """Which descriptors there are."""
        if names != self.descriptors:
            self.descriptors = names
            self.descriptors_changed.emit()
