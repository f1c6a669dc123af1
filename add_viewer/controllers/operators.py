"""Operators that stay at hand: building one takes tenths of a second, turning or weighing it milliseconds."""

from __future__ import annotations

from collections import OrderedDict
from typing import Generic, TypeVar

from add_core.operators import AnisotropicLaplacian, Conductivity
from add_core.spectra import HeatFlow

from ..models.long_work import go_on
from ..models.shapes import OpenShape

_Value = TypeVar("_Value")

ACCURACY = 1e-4
"""Relative error of what is shown: below what a colour or a line can show, and a third faster than the core's own."""


_CURVES = 2
"""Flows kept for curves: at α and at 0. Each holds a factorisation for every angle, up to a quarter of a gigabyte."""


class OperatorStore:
    """The latest operators and heat flows of the open shapes.

    Belongs to the thread that computes: SciPy never gives back the memory of a factorisation that another thread drops.
    Keys hold the shapes themselves: an id could be given again to another shape.
    """

    def __init__(self) -> None:
        self._bases: _Latest[AnisotropicLaplacian] = _Latest()
        self._operators: _Latest[AnisotropicLaplacian] = _Latest()
        self._flows: _Latest[HeatFlow] = _Latest()
        self._curves: _Latest[HeatFlow] = _Latest()
        self._curves.resize(_CURVES)
        self.make_room(1)

    def make_room(self, shapes: int) -> None:
        """Keep enough for that many shapes at once, and no more: each flow holds a factorisation."""
        count = max(1, shapes)
        for kept, each in ((self._bases, 4), (self._operators, 6), (self._flows, 4)):
            kept.resize(each + (count - 1) * (each // 2))

    def keep_only(self, shapes: tuple[OpenShape, ...]) -> None:
        """Forget what belongs to other shapes: the factorisations of a large one hold gigabytes."""
        for kept in (self._bases, self._operators, self._flows, self._curves):
            kept.keep_only(shapes)

    def laplacian(self, shape: OpenShape, conductivity: Conductivity, alpha: float) -> AnisotropicLaplacian:
        """The operator of `shape`; frames and sparsity are shared between all α."""
        key = (shape, conductivity, alpha)
        found = self._operators.get(key)
        if found is None:
            found = self._operators.put(key, self._base(shape, conductivity).with_alpha(alpha))
        return found

    def flow(self, shape: OpenShape, conductivity: Conductivity, alpha: float, purpose: str) -> HeatFlow:
        """A heat flow that keeps its factorisation; each `purpose` has its own, so that none evicts another's."""
        key = (shape, conductivity, alpha, purpose)
        flows = self._curves if purpose == "curves" else self._flows
        found = flows.get(key)
        if found is None:
            laplacian = self.laplacian(shape, conductivity, alpha)
            found = flows.put(key, HeatFlow(laplacian, tolerance=ACCURACY, progress=go_on))
        return found

    def _base(self, shape: OpenShape, conductivity: Conductivity) -> AnisotropicLaplacian:
        key = (shape, conductivity)
        found = self._bases.get(key)
        if found is None:
            other = next((base for base in self._bases.values() if base.shape is shape.shape), None)
            frames = other.frames if other is not None else None
            built = AnisotropicLaplacian(shape.shape, alpha=0.0, conductivity=conductivity, frames=frames)
            found = self._bases.put(key, built)
            go_on()  # seconds have passed if the shape is large
        return found


class _Latest(Generic[_Value]):
    """A dictionary of the last few values used."""

    def __init__(self) -> None:
        self._size = 0
        self._kept: OrderedDict[tuple[object, ...], _Value] = OrderedDict()

    def resize(self, size: int) -> None:
        self._size = size
        while len(self._kept) > size:
            self._kept.popitem(last=False)

    def keep_only(self, firsts: tuple[object, ...]) -> None:
        """Drop the values whose key does not begin with one of `firsts`."""
        for key in [key for key in self._kept if key[0] not in firsts]:
            del self._kept[key]

    def get(self, key: tuple[object, ...]) -> _Value | None:
        if key in self._kept:
            self._kept.move_to_end(key)
        return self._kept.get(key)

    def put(self, key: tuple[object, ...], value: _Value) -> _Value:
        self._kept[key] = value
        if len(self._kept) > self._size:
            self._kept.popitem(last=False)
        return value

    def values(self) -> list[_Value]:
        return list(self._kept.values())
