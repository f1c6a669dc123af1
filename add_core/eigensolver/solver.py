"""The smallest eigenpairs of one operator after another on one sparsity pattern: W φ = λ S φ."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import ArpackError, eigsh

from .._check import BoolArray, FloatArray, IntArray
from ..errors import ConvergenceError
from .dense import dense_pairs
from .factorisation import factorise, factorise_near
from .fronts import FrontTree
from .lanczos import RitzPairs, shift_invert_lanczos
from .ordering import Dissection, known_dissection
from .refinement import RESIDUAL, ROWS, StandardPairs, orient, repaired

_log = logging.getLogger(__name__)

SHIFT = 0.6
"""The shift as a share of Weyl's estimate of the largest eigenvalue asked for: between 0.55 and 0.65 the basis is
smallest.
"""

DENSE_SIZE = 400
"""Up to this many vertices the dense eigensolver is faster."""

DENSE_RESCUE = 3000
"""Up to this many vertices the dense eigensolver serves as the fallback."""


@dataclass(frozen=True, eq=False)
class Eigenpairs:
    """Eigenvalues (K,) ascending, S-orthonormal eigenfunctions (n, K), and why another method had to be used ('' if
    not).
    """

    values: FloatArray
    functions: FloatArray
    fallback: str = ""


@dataclass(frozen=True, eq=False)
class _Found:
    """Pairs beside the kernel. order : (n,), the active vertex of each row of their vectors."""

    pairs: StandardPairs
    order: IntArray
    fallback: str = ""


@dataclass(frozen=True, eq=False)
class PencilSolver:
    """Solves W φ = λ S φ for any positive semi-definite W on one pattern; the symbolic work is done once, on first use.

    indptr, indices : the symmetric pattern (n rows, diagonal stored) that all W share.
    mass : (n,) ≥ 0. Vertices without mass belong to no face: eigenfunctions are 0 there.
    dissection : the order of elimination, if it is known already.
    """

    indptr: IntArray
    indices: IntArray
    mass: FloatArray
    dissection: Dissection | None = None

    def eigenpairs(self, values: FloatArray, *, count: int, scale: float) -> Eigenpairs:
        """The `count` smallest eigenpairs of the operator with the entries `values` (nnz,) of W.

        scale : an estimate of the largest eigenvalue asked for, such as Weyl's; its error costs time, not accuracy.
        The null space is exact: λ = 0 and the constant of each connected component, in order of first vertex. Every
        pair is verified (residual at most 1e-6 relative), Sylvester's inertia counts that none is missed, and signs
        are fixed.
        """
        root = np.sqrt(self.mass[self.active])
        rows = np.repeat(np.arange(len(root)), np.diff(self._indptr))
        standard = values[self._entries] / (root[rows] * root[self._indices])
        matrix = csr_array((standard, self._indices, self._indptr), shape=(len(root), len(root)))
        kernel = _kernel(matrix, root)[:count]
        found = self._beside_kernel(matrix, kernel, count - len(kernel), scale)
        functions = np.empty((len(self.mass), count))
        functions[~self.active] = 0.0
        vertices = np.flatnonzero(self.active)
        functions[vertices, : len(kernel)] = kernel.T / root[:, None]
        for begin in range(0, len(root), ROWS):
            part = found.order[begin : begin + ROWS]
            functions[vertices[part], len(kernel) :] = found.pairs.vectors[begin : begin + ROWS] / root[part, None]
        orient(functions[:, len(kernel) :])
        values = np.concatenate([np.zeros(len(kernel)), np.maximum(found.pairs.values, 0.0)])
        return Eigenpairs(values, functions, found.fallback)

    @cached_property
    def active(self) -> BoolArray:
        """(n,): vertices that have mass."""
        return self.mass > 0

    @cached_property
    def _entries(self) -> IntArray:
        """Entries of the pattern between vertices with mass."""
        rows = np.repeat(self.active, np.diff(self.indptr))
        return np.flatnonzero(rows & self.active[self.indices])

    @cached_property
    def _indices(self) -> IntArray:
        numbers: IntArray = np.cumsum(self.active) - 1
        kept: IntArray = numbers[self.indices[self._entries]]
        return kept

    @cached_property
    def _indptr(self) -> IntArray:
        starts: IntArray = np.searchsorted(self._entries, self.indptr).astype(np.int64)
        kept: IntArray = starts[np.append(self.active, True)]
        return kept

    @cached_property
    def tree(self) -> FrontTree:
        """The symbolic factorisation."""
        return FrontTree.of(self._indptr, self._indices, self.order)

    @cached_property
    def order(self) -> Dissection:
        """The order of elimination, to be handed to another solver on the same pattern."""
        return self.dissection or known_dissection(self._indptr, self._indices)

    def _beside_kernel(self, matrix: csr_array, kernel: FloatArray, count: int, scale: float) -> _Found:
        """The `count` smallest positive eigenpairs and, where Lanczos failed, what was used instead."""
        n = len(kernel.T)
        as_given = np.arange(n)
        if count == 0:
            return _Found(StandardPairs(np.empty(0), np.empty((n, 0))), as_given)
        if n <= DENSE_SIZE or 2.2 * count + 200 > 0.75 * n:
            return _Found(dense_pairs(matrix, kernel, count, scale), as_given)
        shift, problem = SHIFT * scale, ""
        for block, always in ((12, False), (16, True), (32, True)):
            try:
                pairs = self._by_lanczos(matrix.data, kernel, count, shift, block=block, always=always)
                return _Found(pairs, self.tree.dissection.permutation)
            except (ConvergenceError, np.linalg.LinAlgError) as error:
                problem = str(error)
                _log.info("blocks of %d: %s", block, problem)
                shift = self._balanced_shift(matrix.data, shift, count + len(kernel))
        method = "dense eigensolver" if n <= DENSE_RESCUE else "scipy.sparse.linalg.eigsh"
        _log.warning("Block Lanczos failed (%s) Using the %s instead.", problem, method)
        if n <= DENSE_RESCUE:
            return _Found(dense_pairs(matrix, kernel, count, scale), as_given, method)
        return _Found(_by_arpack(matrix, kernel, count, scale), as_given, method)

    def _balanced_shift(self, values: FloatArray, shift: float, count: int) -> float:
        """A shift with somewhat more than half of the wanted eigenvalues below it, where `scale` was far off."""
        for _ in range(8):
            try:
                below = factorise(self.tree, values, shift, count=True).negatives
            except np.linalg.LinAlgError:
                below = count
            if 0.4 * count <= below <= 0.75 * count + 1:
                break
            shift *= float(np.clip(0.58 * count / max(below, 1), 0.1, 10.0))
        return 1.003 * shift  # not the very shift that failed

    def _by_lanczos(
        self, values: FloatArray, kernel: FloatArray, count: int, shift: float, *, block: int, always: bool
    ) -> StandardPairs:
        """Verified pairs, in the tree's order."""
        order = self.tree.dissection.permutation
        kernel = np.ascontiguousarray(kernel[:, order])
        factors = factorise_near(self.tree, values, shift)
        ritz = shift_invert_lanczos(
            factors.solve,
            kernel,
            count,
            shift=factors.shift,
            block=block,
            first_check=len(kernel) + int(1.55 * count) + 6 * block,  # about what half of all operators need
            most=min(len(kernel) + 4 * count + 30 * block, len(order) - 2 * block),
            tolerance=0.7 * RESIDUAL,
            floor=1e-6 * shift,
            always=always,
        )
        self._count_check(values, ritz, count, len(kernel))
        return repaired(factors, kernel, StandardPairs(ritz.values[:count], ritz.vectors))

    def _count_check(self, values: FloatArray, ritz: RitzPairs, count: int, kernel: int) -> None:
        """Raise ConvergenceError unless Sylvester's inertia finds as many eigenvalues as Lanczos did."""
        for below, between in _places_to_count(ritz.values, count):
            found = factorise(self.tree, values, between, count=True).negatives
            if found == kernel + below:
                return
        raise ConvergenceError(f"{found} eigenvalues lie below {between:.6g}, but {kernel + below} were found.")


def _places_to_count(values: FloatArray, count: int) -> list[tuple[int, float]]:
    """Where to count eigenvalues and how many should lie below: just above the last one asked for, if it stands alone.

    Inside a cluster of equal eigenvalues counting would be a matter of rounding: then at the next gap above or below.
    A value missed within the cluster itself would change nothing.
    """
    gaps = np.diff(values, append=values[-1] * (1 + 1e-4))
    wide = gaps > 1e-6 * values
    indices = [*range(count - 1, min(count + 6, len(values))), *range(count - 2, -1, -1)]
    chosen = [k for k in indices if wide[k]][:2]
    if not chosen:
        return [(0, 0.5 * float(values[0]))]
    # Values beyond those asked for may not have converged, so try nearer to the last that has.
    return [(k + 1, float(values[k] + share * gaps[k])) for share in (0.5, 0.02) for k in chosen]


def _kernel(matrix: csr_array, root: FloatArray) -> FloatArray:
    """(c, n) orthonormal: the constant of each connected component, S^½-weighted, in order of first vertex."""
    coupled = abs(matrix)  # a copy: the pattern is shared
    coupled.eliminate_zeros()
    components, labels = connected_components(coupled, directed=False)
    kernel = np.zeros((components, len(root)))
    kernel[labels, np.arange(len(root))] = root
    kernel /= np.linalg.norm(kernel, axis=1, keepdims=True)
    return kernel


def _by_arpack(matrix: csr_array, kernel: FloatArray, count: int, scale: float) -> StandardPairs:
    wanted = count + len(kernel)
    start = np.random.default_rng(0).standard_normal(len(kernel.T))
    try:
        values, vectors = eigsh(matrix.tocsc(), k=wanted, sigma=-1e-3 * scale, v0=start)
    except (ArpackError, RuntimeError) as error:
        raise ConvergenceError(f"SciPy's eigsh failed as well: {error}") from None
    order = np.argsort(values)[len(kernel) :]
    vectors = vectors[:, order] - kernel.T @ (kernel @ vectors[:, order])
    return StandardPairs(values[order], np.linalg.qr(vectors)[0])
