"""Mirror maps: the true one where it is known, otherwise what the shape itself tells."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from add_core.errors import ShapeFileError

from ..models.results import Results
from ..models.session import Session
from ..models.shapes import OpenShape, Shape
from .answers import Answers, Question

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
    """Looks for the mirror map of shapes that come without one, when somebody wants it."""

    def __init__(self, session: Session, results: Results, answers: Answers) -> None:
        self._session, self._results, self._answers = session, results, answers
        answers.arrived.connect(self._arrived)

    def find(self, key: str) -> None:
        """Begin to look for the mirror map of the shape of that key."""
        shape = self._session.state.shape(key)
        if shape is not None and shape.symmetry is None:
            self._answers.forget_problems()
            found = self._answers.want(_question(shape))
            if found is not None:
                self._learn(shape, found)

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

    def _learn(self, shape: OpenShape, found: FoundSymmetry) -> None:
        if found.found:
            self._session.learn_symmetry(shape.key, found.eta, found.confidence)
        else:
            self._results.report(
                f"{shape.name} has no mirror symmetry that could be found. {found.reason} "
                "Pick a mirror point by hand: pick a point, then Alt-click its partner."
            )


def _question(shape: OpenShape) -> SymmetryQuestion:
    return SymmetryQuestion(shape.reference, shape.shape, shape.name)
