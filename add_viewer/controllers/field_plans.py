"""How a view comes by its field: what it depends on, who computes it, and what to say until it is there."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..models.fields import FieldChoice, ShapeField
from ..models.results import Results
from ..models.session import SessionState
from ..models.shapes import OpenShape
from .answers import Answers
from .descriptors import DescriptorStore
from .matching import MatchingController
from .operators import OperatorStore

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Plan:
    """inputs : equal inputs give equal fields. work : computes the field, off the window's thread; None: it cannot be
    computed yet. message : why not, and what is being done about it.
    """

    inputs: tuple[Hashable, ...] = ()
    work: Callable[[], ShapeField] | None = None
    message: str = ""


@dataclass(frozen=True, eq=False)
class Sources:
    """Where fields come from."""

    results: Results
    answers: Answers
    descriptors: DescriptorStore
    operators: OperatorStore
    matching: MatchingController


@dataclass(frozen=True, eq=False)
class Place:
    """One view for which a field is wanted: the session as it stands, the choice of its panel, and its shape."""

    state: SessionState
    choice: FieldChoice
    shape: OpenShape


class Planner(Protocol):
    """Plans the fields of some kinds; called in the window's thread, it only looks up and asks."""

    def __call__(self, place: Place, sources: Sources) -> Plan: ...


class Same:
    """An input that counts by identity: an array, a shape. It is held: an id alone could be given to another."""

    def __init__(self, value: object) -> None:
        self._value = value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and other._value is self._value

    def __hash__(self) -> int:
        return id(self._value)
