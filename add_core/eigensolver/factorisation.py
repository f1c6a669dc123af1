"""Multifrontal factorisation of A − σI with dense fronts, for thousands of right-hand sides.

Along the tree of a nested dissection every set of vertices is eliminated from a small dense matrix, its front, and
hands the rest to the set above (Duff and Reid 1983; Liu 1992). Solving then is dense matrix times block of vectors,
level by level. σ may lie inside the spectrum: each front pivots, but only within itself, so `factorise_near` verifies
a solution before it trusts one.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg.lapack import dsytrf
from scipy.sparse import csr_array

from .._check import FloatArray
from ..errors import ConvergenceError
from .fronts import FrontGroup, FrontTree

_log = logging.getLogger(__name__)

SOLVE_TOLERANCE = 1e-10
"""A solution must leave less than this share of the right-hand side; an interior shift near a front's own eigenvalue
does not.
"""

ROUNDING = 1e-13
"""Each entry of what is left may be this share of the terms that it is summed from."""


@dataclass(frozen=True, eq=False)
class Factorisation:
    """Solves (A − shift I) x = b for symmetric A, vertices in the tree's order.

    inverses : per group of fronts (c, s, s), the inverse of what is eliminated.
    couplings : per group of fronts (c, r, s), what remains of a front against what is eliminated, times the inverse.
    negatives : how many eigenvalues of A lie below the shift (Sylvester's law of inertia); −1 if not counted.
    values : (nnz,) of A on the tree's pattern. matrix : A in the tree's order.
    refined : whether every solution is improved by one step of iterative refinement.
    """

    tree: FrontTree
    shift: float
    inverses: tuple[FloatArray, ...]
    couplings: tuple[FloatArray, ...]
    negatives: int
    values: FloatArray
    matrix: csr_array
    refined: bool = False

    def refining(self) -> Factorisation:
        """The same with a step of iterative refinement: every entry as accurate as rounding allows."""
        return replace(self, refined=True)

    def solve(self, right: FloatArray) -> FloatArray:
        """x (n, p) for the right-hand sides `right` (n, p), rows in the tree's order."""
        x = self._substituted(right)
        if self.refined:
            x = x + self._substituted(right - (self.matrix @ x - self.shift * x))
        return x

    def _substituted(self, right: FloatArray) -> FloatArray:
        held = np.empty((self.tree.held, right.shape[1]))
        held[: len(right)] = right
        couplings = iter(self.couplings)
        eliminated: list[FloatArray] = []
        for level in self.tree.levels:
            rows = level.gathered(held)
            for group, own, coupling in zip(level.groups, rows, couplings, strict=False):
                np.matmul(coupling, own, out=group.own_shares(held))
            eliminated += rows
        x = np.empty((self.tree.workspace, right.shape[1]))
        x[-1] = 0.0
        steps = zip(self.tree.groups, self.inverses, self.couplings, eliminated, strict=True)
        for group, inverse, coupling, own in reversed(list(steps)):
            found = np.matmul(inverse, own, out=group.own_rows(x))
            found -= coupling.transpose(0, 2, 1) @ group.rest_rows(x)
        return np.take(x, self.tree.places, axis=0)


def factorise(
    tree: FrontTree,
    values: FloatArray,
    shift: float,
    *,
    count: bool = False,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Factorisation:
    """Factorise A − shift I, A given by `values` (nnz,) on the pattern of the tree.

    count : also count the eigenvalues below the shift, at about a third more time. progress : told how many groups of
        fronts of how many are done; what it raises ends the factorisation.
    Raises numpy.linalg.LinAlgError if what a front eliminates is singular.
    """
    shifted = values.copy()
    shifted[tree.diagonal] -= shift
    inverses, couplings = [], []
    remainders: list[FloatArray] = []
    negatives = 0
    for number, group in enumerate(tree.groups):
        progress(number, len(tree.groups))
        front = _assemble(group, shifted, remainders)
        s = group.size
        pivot, border = front[:, :s, :s], front[:, s:, :s]
        inverse = np.linalg.inv(pivot)
        inverse = 0.5 * (inverse + inverse.transpose(0, 2, 1))
        coupling = border @ inverse
        remainders.append(front[:, s:, s:] - coupling @ border.transpose(0, 2, 1))
        inverses.append(inverse)
        couplings.append(coupling)
        if count:
            negatives += sum(_negative_pivots(block) for block in pivot)
    ordered = (values[tree.ordered_entries], tree.ordered_indices, tree.ordered_indptr)
    matrix = csr_array(ordered, shape=(tree.size, tree.size))
    counted = negatives if count else -1
    return Factorisation(tree, shift, tuple(inverses), tuple(couplings), counted, values, matrix)


def _assemble(group: FrontGroup, values: FloatArray, remainders: list[FloatArray]) -> FloatArray:
    """(c, s + r, s + r): the entries of A that a group eliminates, and what the sets below it left."""
    size = group.size + group.rest.shape[1]
    front = np.zeros((group.fronts, size, size))
    flat = front.reshape(-1)
    flat[group.slots] = values[group.entries]
    flat[group.padding] = 1.0
    for child in group.children:
        block = remainders[child.group][child.member]
        into = child.positions
        places = (child.parent * size + into)[:, None] * size + into  # flat: half the time of two indices
        flat[places] += block[: len(into), : len(into)]
    return front


def _negative_pivots(block: FloatArray) -> int:
    """How many eigenvalues of a symmetric matrix are negative, from Bunch and Kaufman's L D Lᵀ."""
    packed, pivots, _ = dsytrf(block, lower=1)
    diagonal = np.diagonal(packed)
    paired = pivots < 0  # a 2 × 2 pivot is indefinite by construction: one negative eigenvalue in two rows
    return int(np.count_nonzero(diagonal[~paired] < 0) + np.count_nonzero(paired) // 2)


def factorise_near(tree: FrontTree, values: FloatArray, shift: float) -> Factorisation:
    """Factorise A − σI with σ at `shift`, or up to 4 % beside it where that is needed for accurate solutions.

    Where slivers spread the entries of A over many orders of magnitude, solutions are refined by one more step.
    Raises ConvergenceError if no shift nearby solves a test system to SOLVE_TOLERANCE, or to rounding where that is
    more.
    """
    for refining, factors in ((False, (1.0, 1.01, 0.99)), (True, (1.0, 1.02, 0.98, 1.04, 0.96))):
        for factor in factors:
            try:
                candidate = factorise(tree, values, factor * shift)
            except np.linalg.LinAlgError:
                continue
            if refining:
                candidate = candidate.refining()
            if _solves(candidate):
                return candidate
            _log.info("the factorisation at %.6g is not accurate; trying beside it", factor * shift)
    raise ConvergenceError(f"No shift within 4 % of {shift:.6g} gives an accurate factorisation.")


def _solves(factors: Factorisation) -> bool:
    """Whether a test system is solved well."""
    matrix = factors.matrix
    right = np.random.default_rng(1).standard_normal((matrix.shape[0], 2))
    x = factors.solve(right)
    left = np.abs(matrix @ x - factors.shift * x - right)
    if np.linalg.norm(left) < SOLVE_TOLERANCE * np.linalg.norm(right):
        return True
    size = abs(matrix) @ np.abs(x) + abs(factors.shift) * np.abs(x) + np.abs(right)
    return bool((left <= ROUNDING * size).all())
