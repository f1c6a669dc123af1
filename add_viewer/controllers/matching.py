"""Which point of the source each point of a target is, as the chosen matching finds it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from psygnal import Signal

from add_core.errors import ShapeFileError
from add_core.evaluation import PrincetonCurve, princeton_curve, surface_area

from ..models.descriptor_names import descriptor_name
from ..models.insights import Insights, MatchQuality, QualityCurve
from ..models.matching import Matching, Method
from ..models.results import Results
from ..models.session import Session, SessionState
from ..models.shapes import OpenShape, Shape
from .answers import Answers, Question
from .carrying import true_match
from .descriptors import COUNT

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_REFINEMENT: dict[Method, str] = {"nearest": "fm", "functional-map": "icp", "zoomout": "zoomout"}
"""What the switch adds: the paper's smoothing by a functional map, ICP of the map itself, or ZoomOut."""


@dataclass(frozen=True, eq=False)
class FoundMap:
    """A correspondence from a source (1) to a target (2), raw and refined.

    raw, refined : (n2,), the source vertex of each target vertex.
    errors : by name "raw", "refined", "raw symmetric", "refined symmetric": (n2,) geodesic error ÷ √area of the source,
        NaN where unknown; empty where no truth is known.
    """

    raw: IntArray
    refined: IntArray
    errors: Mapping[str, FloatArray]

    def match(self, *, refined: bool) -> IntArray:
        """(n2,) the one that the switch asks for."""
        return self.refined if refined else self.raw

    def error(self, *, refined: bool, symmetric: bool = False) -> FloatArray | None:
        """(n2,) geodesic error ÷ √area."""
        return self.errors.get(("refined" if refined else "raw") + (" symmetric" if symmetric else ""))

    def curve(self, *, refined: bool, symmetric: bool = False) -> PrincetonCurve | None:
        """Share of matches within a geodesic radius; None where no truth is known."""
        error = self.error(refined=refined, symmetric=symmetric)
        return None if error is None or np.isnan(error).all() else princeton_curve(error, symmetric=symmetric)


@dataclass(frozen=True)
class MatchQuestion:
    """A pair of shapes under one method.

    truth : what the command is told of it: "same", equal vertex numbers correspond; "known" of shipped shapes; or "".
    """

    source: str
    target: str
    source_shape: Shape
    target_shape: Shape
    method: Method
    descriptor: str
    truth: str
    names: tuple[str, str] = field(compare=False)

    kind = "match"
    file_name = "map.npz"

    @property
    def title(self) -> str:
        how = "functional map" if self.method == "functional-map" else descriptor_name(self.descriptor).title
        return f"the {how} matches of {self.names[0]} and {self.names[1]}"

    def arguments(self, output: Path) -> tuple[str, ...]:
        """Raw and refined at once: the switch between them must not wait."""
        descriptor = "fm" if self.method == "functional-map" else self.descriptor
        fewest = min(self.source_shape.vertex_count, self.target_shape.vertex_count) - 1
        size = str(max(4, min(120, fewest)))
        options = ("--descriptor", descriptor, "--refine", _REFINEMENT[self.method], "--size", size)
        truth = ("--truth", self.truth) if self.truth else ()
        return ("match", self.source, self.target, *options, "--count", str(COUNT), *truth, "-o", str(output))

    def read(self, output: Path, said: Mapping[str, Any]) -> FoundMap:
        """Raises ShapeFileError if the file fits other shapes."""
        with np.load(output, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        raw, refined = arrays["raw_matches"], arrays["matches"]
        if len(refined) != self.target_shape.vertex_count or refined.max() >= self.source_shape.vertex_count:
            raise ShapeFileError(f"{self.source} or {self.target} has changed since it was opened. Open it again.")
        errors = {
            f"{stage}{setting}": arrays[f"{prefix}error{suffix}"]
            for stage, prefix in (("raw", "raw_"), ("refined", ""))
            for setting, suffix in (("", ""), (" symmetric", "_symmetric"))
            if f"{prefix}error{suffix}" in arrays
        }
        return FoundMap(raw, refined, errors)


class MatchingController:
    """Keeps `Results.maps` in step with the source, the targets and the chosen matching.

    changed : something is known, or goes on, that was not before.
    """

    changed = Signal()

    def __init__(self, session: Session, results: Results, insights: Insights, answers: Answers) -> None:
        self._session, self._results, self._insights, self._answers = session, results, insights, answers
        session.matching_changed.connect(answers.forget_problems)
        for signal in (session.shapes_changed, session.active_changed, session.matching_changed):
            signal.connect(self._follow)
        answers.arrived.connect(self._arrived)
        answers.progressed.connect(lambda question: self._tell(question))

    def found(self, target: str) -> FoundMap | None:
        """What is known about the pair of the source and `target`."""
        question = self._question(target)
        known: FoundMap | None = None if question is None else self._answers.get(question)
        return known

    def message(self, target: str) -> str:
        """Why there is no map yet, in words."""
        question = self._question(target)
        if question is None:
            return "No true correspondence is known between these shapes. Choose another matching."
        return "" if self._answers.get(question) is not None else self._answers.message(question)

    def root_area(self) -> float:
        """√area of the source, by which errors were divided, in geodesic diameters."""
        source = self._session.state.active
        return 1.0 if source is None else float(np.sqrt(surface_area(source.shape)))

    def _question(self, target: str) -> MatchQuestion | None:
        state = self._session.state
        source, other = state.active, state.shape(target)
        if source is None or other is None or state.matching.method == "true":
            return None
        return question_of(source, other, state.matching)

    def _follow(self) -> None:
        state = self._session.state
        for target in _targets(state):
            source = state.active
            assert source is not None
            if state.matching.method == "true":
                self._set(source, target, true_match(source, target))
            else:
                found = self._answers.want(question_of(source, target, state.matching))
                self._set(source, target, None if found is None else found.match(refined=state.matching.refined))
        self._announce()

    def _announce(self) -> None:
        state, root = self._session.state, None
        qualities = []
        for target in _targets(state) if state.matching.method != "true" else ():
            found = self.found(target.key)
            root = self.root_area() if root is None else root
            curves = {} if found is None else curves_of(found, root)
            qualities.append(MatchQuality(target.key, self.message(target.key), curves))
        self._insights.set_qualities(tuple(qualities))
        self.changed.emit()

    def _set(self, source: OpenShape, target: OpenShape, match: IntArray | None) -> None:
        before = self._results.maps.get((source.key, target.key))
        if match is None and before is None:
            return
        if match is None or before is None or not np.array_equal(match, before):
            self._results.set_map(source.key, target.key, match)

    def _arrived(self, question: Question) -> None:
        if isinstance(question, MatchQuestion):
            self._follow()

    def _tell(self, question: Question) -> None:
        if isinstance(question, MatchQuestion):
            self._announce()


def curves_of(found: FoundMap, root_area: float) -> dict[tuple[bool, bool], QualityCurve]:
    """By (refined, symmetric); errors were divided by `root_area`, √area in geodesic diameters."""
    curves = {}
    for refined in (False, True):
        for symmetric in (False, True):
            curve = found.curve(refined=refined, symmetric=symmetric)
            if curve is not None:
                curves[refined, symmetric] = QualityCurve(curve.x, curve.y, curve.mean_error * root_area, curve.exact)
    return curves


def question_of(source: OpenShape, target: OpenShape, matching: Matching) -> MatchQuestion:
    """The question for one pair; a functional map starts from the wave kernel signature, whatever is chosen."""
    descriptor = "wks" if matching.method == "functional-map" else matching.descriptor
    return MatchQuestion(
        source.reference,
        target.reference,
        source.shape,
        target.shape,
        matching.method,
        descriptor,
        _truth(source, target),
        (source.name, target.name),
    )


def _truth(source: OpenShape, target: OpenShape) -> str:
    match = true_match(source, target)
    if match is None:
        return ""
    same = len(match) == source.vertex_count and bool((match == np.arange(len(match))).all())
    return "same" if same else "known"


def _targets(state: SessionState) -> tuple[OpenShape, ...]:
    return tuple(shape for shape in state.shapes if shape.key != state.active_key and state.active is not None)
