"""Which state of a trained model is looked at while it trains on: one for all shapes, never half of a newer one."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

from ..models.shapes import OpenShape
from .answers import Answers, Question

QuestionOf = Callable[[OpenShape, str, int], Question]


def is_model_file(name: str) -> bool:
    """Whether a descriptor is named by the path of a model, rather than by a word."""
    return Path(name).name != name


def newest(name: str) -> int:
    """When the model's file was written, in nanoseconds; −1 if it is gone, 0 for descriptors without a file."""
    if not is_model_file(name):
        return 0
    try:
        return Path(name).stat().st_mtime_ns
    except OSError:
        return -1


def keep_state(model: Path, place: Path) -> Path:
    """The model as it is now, at a place where no newer state replaces it. Raises OSError if there is none."""
    if not place.exists():
        place.parent.mkdir(parents=True, exist_ok=True)
        try:
            os.link(model, place)  # its training replaces the file as a whole
        except OSError:
            shutil.copyfile(model, place)
    return place


class ModelStates:
    """The state shown of every model, and the newer one on its way.

    question_of : asks for a shape's descriptors by the state of a model that was written at a time.
    """

    def __init__(self, answers: Answers, question_of: QuestionOf) -> None:
        self._answers, self._question_of = answers, question_of
        self._shown: dict[str, int] = {}
        self._coming: dict[str, tuple[int, tuple[OpenShape, ...]]] = {}
        self._wanted_again: dict[str, tuple[OpenShape, ...]] = {}
        answers.arrived.connect(lambda _question: self._settle())

    def shown(self, name: str) -> int:
        """When the state that is shown was written; 0 for descriptors without a file."""
        return self._shown.setdefault(name, newest(name)) if is_model_file(name) else 0

    def catch_up(self, name: str) -> None:
        """Show the newest state from now on, computed or not: the shown one can no longer be computed."""
        if is_model_file(name):
            self._coming.pop(name, None)
            self._shown[name] = newest(name)

    def renew(self, name: str, shapes: Sequence[OpenShape]) -> None:
        """Compute the newest state for `shapes`; what is there is shown until all of it has arrived."""
        stamp = newest(name)
        if name in self._coming:
            self._wanted_again[name] = tuple(shapes)  # one at a time, however quickly it learns
        elif stamp > 0 and stamp != self.shown(name):
            self._coming[name] = stamp, tuple(shapes)
            for shape in shapes:
                self._answers.want(self._question_of(shape, name, stamp))
            self._settle()

    def _settle(self) -> None:
        for name, (stamp, shapes) in list(self._coming.items()):
            questions = [self._question_of(shape, name, stamp) for shape in shapes]
            has_failed = any(self._answers.has_failed(question) for question in questions)
            if not has_failed and any(self._answers.get(question) is None for question in questions):
                continue
            del self._coming[name]
            if not has_failed:
                self._shown[name] = stamp
            if name in self._wanted_again:
                self.renew(name, self._wanted_again.pop(name))
