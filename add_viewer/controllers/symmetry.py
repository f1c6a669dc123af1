"""Mirror maps: the true one where it is known, otherwise what the shape itself tells."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from add_core.errors import ShapeFileError

from ..models.insights import Insights, Telling
from ..models.results import Results
from ..models.session import Session, SessionState
from ..models.shapes import OpenShape, Shape
from .answers import Question
from .descriptors import DescriptorStore

IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class FoundSymmetry:
    """eta : (n,) the best mirror map. found : whether it is good enough; reason : why not. confidence : 0 to 1."""

    eta: IntArray
    found: bool
    confidence: float
    reason: str


@dataclass(frozen=True)
class SymmetryQuestion:
    """The mirror image of every vertex of a shape."""

    reference: str
    shape: Shape
    shape_name: str = field(compare=False)

    kind = "symmetry"
    file_name = "mirror.txt"

    @property
    def title(self) -> str:
        return f"the mirror map of {self.shape_name}"

    def arguments(self, output: Path) -> tuple[str, ...]:
        """With fewer eigenfunctions than a small shape has vertices."""
        count = max(10, min(150, self.shape.vertex_count - 2))
        return ("symmetry", self.reference, "--count", str(count), "-o", str(output))

    def read(self, output: Path, said: Mapping[str, Any]) -> FoundSymmetry:
        """Raises ShapeFileError if the file fits another shape."""
        eta = np.loadtxt(output, dtype=np.int64, ndmin=1)
        if len(eta) != self.shape.vertex_count:
            raise ShapeFileError(f"{self.reference} has changed since it was opened. Open it again.")
        return FoundSymmetry(eta, bool(said["found"]), float(said["confidence"]), str(said["reason"]))


class SymmetryController:
    """Looks for the mirror map of shapes that come without one, and keeps `Insights.tellings` in step."""

    def __init__(self, session: Session, results: Results, insights: Insights, descriptors: DescriptorStore) -> None:
        self._session, self._results, self._insights = session, results, insights
        self._descriptors, self._answers = descriptors, descriptors.answers
        self._answers.arrived.connect(self._arrived)
        self._answers.progressed.connect(lambda question: self._tell())
        for signal in (session.picks_changed, session.shapes_changed, session.active_changed, session.field_changed):
            signal.connect(self._tell)

    def find(self, key: str) -> None:
        """Begin to look for the mirror map of the shape of that key."""
        shape = self._session.state.shape(key)
        if shape is not None and shape.symmetry is None:
            self._answers.forget_problems()
            found = self._answers.want(_question(shape))
            if found is not None:
                self._learn(shape, found)

    def compare(self, descriptor: str) -> None:
        """Begin to compute a descriptor of the active shape."""
        shape = self._session.state.active
        if shape is not None:
            self._answers.forget_problems()
            self._descriptors.want(shape, descriptor)
            self._tell()

    def _tell(self) -> None:
        state = self._session.state
        shape, pair = state.active, mirror_pair(state)
        if shape is None:
            self._insights.set_tellings((), "")
            return
        tellings = tuple(telling(shape, pair, name, self._descriptors) for name in self._descriptors.names)
        self._insights.set_tellings(tellings, self.message(shape.key))

    def message(self, key: str) -> str:
        """What is happening, in words; "" if nothing is."""
        shape = self._session.state.shape(key)
        question = None if shape is None else _question(shape)
        if question is None or not (self._answers.is_asked(question) or self._answers.has_failed(question)):
            return ""
        return self._answers.message(question)

    def _arrived(self, question: Question) -> None:
        if isinstance(question, SymmetryQuestion):
            found = self._answers.get(question)
            for shape in self._session.state.shapes:
                if found is not None and shape.shape is question.shape:
                    self._learn(shape, found)
        self._tell()

    def _learn(self, shape: OpenShape, found: FoundSymmetry) -> None:
        if found.found:
            self._session.learn_symmetry(shape.key, found.eta, found.confidence)
        else:
            self._results.report(
                f"{shape.name} has no mirror symmetry that could be found. {found.reason} "
                "Pick a mirror point by hand: pick a point, then Alt-click its partner."
            )


def mirror_pair(state: SessionState) -> tuple[int, int] | None:
    """The last picked point of the active shape and its mirror image: picked by hand, or as the map says."""
    for pick in reversed(state.active_picks):
        if pick.is_mirror and pick.mirror_of is not None:
            return pick.mirror_of, pick.vertex
    shape = state.active
    plain = [pick.vertex for pick in state.active_picks]
    mirror = shape.mirror(plain[-1]) if shape is not None and plain else None
    return None if mirror is None else (plain[-1], mirror)


def telling(shape: OpenShape, pair: tuple[int, int] | None, name: str, store: DescriptorStore) -> Telling:
    """How far the descriptor `name` tells the pair apart, if it has been computed."""
    found = store.get(shape, name)
    if found is None:
        return Telling(name, message=store.message(shape, name) if store.is_asked(shape, name) else "")
    if pair is None:
        return Telling(name, message="Pick a point")
    return Telling(name, float(np.linalg.norm(found[pair[0]] - found[pair[1]])) / max(store.median(shape, name), 1e-12))


def _question(shape: OpenShape) -> SymmetryQuestion:
    return SymmetryQuestion(shape.reference, shape.shape, shape.name)
