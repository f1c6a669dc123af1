"""Factorisations of I + γA for heat: SuperLU's for most shapes, dense fronts for the largest."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol
from weakref import WeakKeyDictionary

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import SuperLU, splu

from .._check import FloatArray, IntArray
from ..eigensolver.factorisation import Factorisation, factorise
from ..eigensolver.fronts import FrontTree
from ..eigensolver.ordering import known_dissection
from ..operators import AnisotropicLaplacian
from ..operators.pattern import SparsityPattern

Progress = Callable[[int, int], None]
"""Told how many steps of how many are done; what it raises ends the computation."""

MOST_SUPERLU = 60_000
"""Vertices up to which SuperLU is used: its order is found sooner, but at 200K vertices dense fronts are 15 times as
fast and hold half as much.
"""

_BYTES_PER_ENTRY = 12
_trees: WeakKeyDictionary[SparsityPattern, FrontTree] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class Ordering:
    """In which order vectors are kept. order : (n,) the vertex at each place. position : (n,) its inverse."""

    order: IntArray
    position: IntArray

    @classmethod
    def of(cls, pattern: SparsityPattern, progress: Progress) -> Ordering:
        """The order in which the factors on this pattern eliminate."""
        if pattern.vertex_count <= MOST_SUPERLU:
            return cls(pattern.elimination.order, pattern.elimination.position)
        order = _tree(pattern, progress).dissection.permutation
        position = np.empty_like(order)
        position[order] = np.arange(len(order))
        return cls(order, position)


class Factor(Protocol):
    """(I + γA)⁻¹ for A = S^{-1/2} W S^{-1/2}, on vectors in elimination order."""

    @property
    def gamma(self) -> float: ...

    @property
    def bytes(self) -> int: ...

    def apply(self, vector: FloatArray) -> FloatArray: ...


class Factors:
    """The factorisations used last, as many as fit into `limit` bytes, and at least one."""

    def __init__(self, progress: Progress, *, limit: int) -> None:
        self._progress, self._limit = progress, limit
        self._kept: OrderedDict[tuple[float, float], Factor] = OrderedDict()

    def at(self, laplacian: AnisotropicLaplacian, theta: float, gamma: float, root: FloatArray) -> Factor:
        """The one at θ and γ, kept or new. root : (n,) √S, 1 where there is no mass."""
        key = (theta, gamma)
        if key not in self._kept:
            self._make_room()
            values = gamma * laplacian.stiffness_values(theta)
            values[laplacian.pattern.diagonal] += root**2
            make = _SparseFactor.of if laplacian.pattern.vertex_count <= MOST_SUPERLU else _FrontFactor.of
            self._kept[key] = make(laplacian.pattern, values, gamma, root, self._progress)
        self._kept.move_to_end(key)
        return self._kept[key]

    def _make_room(self) -> None:
        sizes = [factor.bytes for factor in self._kept.values()]
        while sizes and sum(sizes) + sizes[-1] > self._limit:
            self._kept.popitem(last=False)
            sizes.pop(0)


def _factorised(matrix: csc_array) -> SuperLU:
    """Positive definite, so no pivoting; a surface's supernodes are small, hence narrow panels."""
    return splu(
        matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, relax=4, panel_size=1, options={"SymmetricMode": True}
    )


@dataclass(frozen=True, eq=False)
class _SparseFactor:
    lu: SuperLU
    gamma: float
    root: FloatArray

    @classmethod
    def of(
        cls, pattern: SparsityPattern, values: FloatArray, gamma: float, root: FloatArray, progress: Progress
    ) -> _SparseFactor:
        elimination, n = pattern.elimination, pattern.vertex_count
        progress(0, 1)
        matrix = csc_array((values[elimination.entries], elimination.indices, elimination.indptr), shape=(n, n))
        try:
            lu = _factorised(matrix)
        except RuntimeError:  # a piece of slivers alone, whose mass is lost beside γW: singular by rounding
            matrix.setdiag(matrix.diagonal() * (1.0 + 16.0 * np.finfo(np.float64).eps))
            lu = _factorised(matrix)
        return cls(lu, gamma, root[elimination.order])

    @property
    def bytes(self) -> int:
        return _BYTES_PER_ENTRY * int(self.lu.nnz)

    def apply(self, vector: FloatArray) -> FloatArray:
        return np.asarray(self.root * self.lu.solve(self.root * vector))


@dataclass(frozen=True, eq=False)
class _FrontFactor:
    factorisation: Factorisation
    gamma: float
    root: FloatArray

    @classmethod
    def of(
        cls, pattern: SparsityPattern, values: FloatArray, gamma: float, root: FloatArray, progress: Progress
    ) -> _FrontFactor:
        tree = _tree(pattern, progress)
        return cls(factorise(tree, values, 0.0, progress=progress), gamma, root[tree.dissection.permutation])

    @property
    def bytes(self) -> int:
        parts = (*self.factorisation.inverses, *self.factorisation.couplings)
        return sum(part.nbytes for part in parts)

    def apply(self, vector: FloatArray) -> FloatArray:
        return np.asarray(self.root * self.factorisation.solve((self.root * vector)[:, None])[:, 0])


def _tree(pattern: SparsityPattern, progress: Progress) -> FrontTree:
    """The fronts of a pattern, found once for every α, θ and t."""
    found = _trees.get(pattern)
    if found is None:
        dissection = known_dissection(pattern.indptr, pattern.indices, progress=progress)
        found = _trees[pattern] = FrontTree.of(pattern.indptr, pattern.indices, dissection)
    return found
