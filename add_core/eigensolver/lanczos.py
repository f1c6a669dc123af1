"""Block Lanczos on (A − σI)⁻¹: the eigenpairs of a symmetric matrix on both sides of a shift inside its spectrum.

Basis vectors are kept as contiguous rows, so that every product streams memory. Each new block is made orthogonal to
the two before it; only two blocks of every four are made orthogonal to all others as well, which keeps the basis
semi-orthogonal (Simon 1984; Grimes, Lewis and Simon 1994). Between such passes overlaps grow fastest along the
eigenvectors nearest to the shift, so that every block is made orthogonal to these (Parlett and Scott 1979). A guard
watches what the next full pass finds and lets fewer blocks or none go without.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .._check import FloatArray
from ..errors import ConvergenceError

SKIPPED = 2
"""Blocks without a full pass after every two with one."""

CLOSE, LOOSE = 2e-10, 3e-8
"""A full pass that finds overlaps larger than this came late: from then on one block is skipped at a time, or none."""

NEAREST = 32
"""Ritz vectors nearest to the shift against which every block is made orthogonal. Without them two steps multiply
overlaps by 1e7, with them by 1e4.
"""

SETTLED = 8
"""Steps after which the nearest Ritz vectors are taken; until then every block gets a full pass, still a short one."""

SMOOTHING = 4
"""Inverse iterations on the start: each saves one step of a long recurrence and costs a solve without orthogonalising.
Beyond 5 the start consists of the nearest few eigenvectors only, and saves nothing more."""

STEEP = 1e-2
"""Rows that depend on each other more than this are orthonormalised twice: once leaves rounding over STEEP²."""

LOST = 1e-6
"""Overlaps larger than this have spoilt the projected matrix already: only a new start helps."""


@dataclass(frozen=True, eq=False)
class RitzPairs:
    """Approximate eigenpairs of A, ascending, as combinations of basis vectors.

    values : (p,), at least as many as were asked for; those beyond have not been checked for convergence.
    vectors : (n, k), orthonormal to about the basis's own orthogonality, k as asked for.
    estimate : the largest residual of the k pairs relative to its value, as Lanczos predicts it.
    steps : rows of the basis.
    """

    values: FloatArray
    vectors: FloatArray
    estimate: float
    steps: int


def shift_invert_lanczos(
    solve: Callable[[FloatArray], FloatArray],
    kernel: FloatArray,
    count: int,
    *,
    shift: float,
    block: int = 12,
    first_check: int,
    most: int,
    tolerance: float,
    floor: float,
    always: bool = False,
    seed: int = 0,
) -> RitzPairs:
    """The `count` smallest eigenpairs of a positive semi-definite A beside its known kernel.

    solve : (n, p) → (n, p), applies (A − shift I)⁻¹.
    kernel : (c, n), orthonormal rows with A kernelᵀ = 0; they lead the basis and are not returned.
    block : vectors per step; eigenvalues of higher multiplicity may be found incompletely.
    first_check, most : rows of the basis at the first test of convergence, and at which to give up.
    tolerance : of residuals relative to max(value, floor).
    always : orthogonalise every block against all others from the start.
    Raises ConvergenceError if `most` rows do not suffice, or if skipped passes cost too much orthogonality.
    """
    start = _start(solve, kernel, block, seed=seed)
    basis = _Basis(kernel, shift, most, start, always=always)
    check = first_check
    previous: tuple[int, float] | None = None
    while True:
        basis.extend(solve)
        last = basis.size + block > most
        if basis.size < check and not last:
            continue
        pairs = basis.ritz(count, floor=floor)
        if pairs is not None and pairs.estimate <= tolerance:
            return pairs.with_vectors(basis)
        if last:
            reached = "nothing" if pairs is None else f"{pairs.estimate:.1e}"
            raise ConvergenceError(
                f"{basis.size} Lanczos vectors reached {reached} where {tolerance:.1e} was asked for."
            )
        check = basis.size + _steps_to_go(pairs, previous, basis.size, tolerance, block)
        previous = None if pairs is None else (basis.size, pairs.estimate)


def _start(solve: Callable[[FloatArray], FloatArray], kernel: FloatArray, block: int, *, seed: int) -> FloatArray:
    """(block, n): random rows beside the kernel, after SMOOTHING inverse iterations."""
    rows = np.random.default_rng(seed).standard_normal((block, kernel.shape[1]))
    for _ in range(SMOOTHING):
        rows -= (rows @ kernel.T) @ kernel
        rows = np.ascontiguousarray(solve(rows.T).T)
        try:
            rows, _ = _orthonormal(rows)
        except np.linalg.LinAlgError:
            rows, _ = _refilled(rows, kernel, seed=seed)
    return rows - (rows @ kernel.T) @ kernel


def _steps_to_go(
    pairs: _Convergence | None, previous: tuple[int, float] | None, size: int, tolerance: float, block: int
) -> int:
    """How many more rows convergence will take: residuals fall geometrically, by what was seen or by a factor of 3.5
    a step.
    """
    if pairs is None or pairs.estimate > 1e-2:
        return 3 * block
    rate = np.log(3.5) / block
    if previous is not None and pairs.estimate < 0.7 * previous[1]:
        rate = np.log(previous[1] / pairs.estimate) / (size - previous[0])
    blocks = np.ceil(np.log(1.2 * pairs.estimate / tolerance) / rate / block)
    return int(np.clip(blocks, 1, 8)) * block


@dataclass(frozen=True, eq=False)
class _Convergence:
    """Where the projected problem stands."""

    values: FloatArray
    estimate: float
    mixing: FloatArray  # (rows of the basis with the last block, count)

    def with_vectors(self, basis: _Basis) -> RitzPairs:
        # The product of contiguous rows is a fifth faster than that of columns.
        return RitzPairs(self.values, (self.mixing.T @ basis.rows).T, self.estimate, basis.size)


class _Basis:
    """A growing orthonormal basis Q (rows) and T = Q (A − σI)⁻¹ Qᵀ, with one block more of Q than of T."""

    def __init__(self, kernel: FloatArray, shift: float, most: int, start: FloatArray, *, always: bool) -> None:
        c, n = kernel.shape
        block = len(start)
        self._q = np.empty((most + block, n))
        self._t = np.zeros((most + block, most + block))
        self._q[:c] = kernel
        self._t[np.arange(c), np.arange(c)] = -1.0 / shift  # (A − σI)⁻¹ k = −k/σ
        self._shift, self._block = shift, block
        self._skipped = 0 if always else SKIPPED
        self._turn = 0  # 0 and 1 pass over the whole basis, the next `_skipped` do not
        self._nearest: tuple[FloatArray, FloatArray] | None = None
        self._kernel_rows = self.size = c
        self._append(start)

    @property
    def rows(self) -> FloatArray:
        """(size + block, n)."""
        return self._q[: self.size + self._block]

    def extend(self, solve: Callable[[FloatArray], FloatArray]) -> None:
        """Apply the operator to the newest block, orthogonalise, and let the result be the next."""
        j, b, q = self.size, self._block, self.rows
        new = np.ascontiguousarray(solve(q[j:].T).T)
        low, rounding = max(0, j - b), 1e-8 * float(np.linalg.norm(new))
        overlaps = np.zeros((b, j + b))
        overlaps[:, low:] = new @ q[low:].T
        new -= overlaps[:, low:] @ q[low:]
        left = float(np.linalg.norm(new))  # less than `rounding` where the space is exhausted
        if j == self._kernel_rows + SETTLED * b and self._skipped:
            self._nearest = self._nearest_ritz_vectors()
        if self._nearest is None or self._turn < 2 or left < rounding:
            found = new @ q.T
            new -= found @ q
            overlaps += found
            self._watch(float(np.abs(found[:, :low]).max(initial=0.0)) / max(left, rounding))
        else:
            found = new @ q[low:].T
            new -= found @ q[low:]
            overlaps[:, low:] += found
            mixing, vectors = self._nearest
            found = new @ vectors.T
            new -= found @ vectors
            overlaps[:, : mixing.shape[1]] += found @ mixing
        self._t[j : j + b, : j + b] = overlaps
        self._t[: j + b, j : j + b] = overlaps.T
        self.size += b
        self._turn = (self._turn + 1) % (2 + self._skipped)
        self._append(new)

    def _nearest_ritz_vectors(self) -> tuple[FloatArray, FloatArray]:
        """(m, size) combinations of basis rows and the m vectors (m, n) that they make."""
        j = self.size
        inverse, mixing = np.linalg.eigh(0.5 * (self._t[:j, :j] + self._t[:j, :j].T))
        chosen = np.argsort(-np.abs(inverse), kind="stable")[:NEAREST]
        rows = np.ascontiguousarray(mixing[:, chosen].T)
        return rows, rows @ self._q[:j]

    def _watch(self, overlap: float) -> None:
        if overlap > LOST and self._skipped:
            raise ConvergenceError(f"Lanczos vectors overlap by {overlap:.1e}: a shift too close to an eigenvalue.")
        if overlap > CLOSE:
            self._skipped = min(self._skipped, 0 if overlap > LOOSE else 1)

    def _append(self, new: FloatArray) -> None:
        """Let an orthonormal basis of the rows `new` follow; new = Rᵀ basis, R kept for residuals."""
        j, b = self.size, self._block
        try:
            self._q[j : j + b], self._r = _orthonormal(new)
        except np.linalg.LinAlgError:
            self._q[j : j + b], self._r = _refilled(new, self._q[:j], seed=j)

    def ritz(self, count: int, *, floor: float) -> _Convergence | None:
        """Eigenpairs of T, purified by one more step of the recurrence; None while fewer than `count` make sense."""
        j, b, c = self.size, self._block, self._kernel_rows
        inverse, mixing = np.linalg.eigh(0.5 * (self._t[c:j, c:j] + self._t[c:j, c:j].T))
        inverse = np.where(inverse == 0.0, np.finfo(float).tiny, inverse)
        values = self._shift + 1.0 / inverse
        sensible = np.flatnonzero(values > -1e-6 * self._shift)
        sensible = sensible[np.argsort(values[sensible], kind="stable")]
        if len(sensible) < count:
            return None
        chosen = sensible[:count]
        tail = (self._r @ mixing[-b:, chosen]) / inverse[chosen]
        residuals = np.linalg.norm(tail, axis=0) / np.abs(inverse[chosen])
        estimate = float((residuals / np.maximum(values[chosen], floor)).max())
        full = np.zeros((j + b, count))
        full[c:j], full[j:] = mixing[:, chosen], tail
        return _Convergence(values[sensible], estimate, full)


def _orthonormal(new: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Orthonormal rows v and R with new = Rᵀ v, by Cholesky. Raises LinAlgError if rows depend on each other."""
    rows, triangle = _by_cholesky(new)
    lengths = np.diagonal(triangle)
    if lengths.min() > STEEP * lengths.max():
        return rows, triangle.T
    rows, second = _by_cholesky(rows)
    return rows, second.T @ triangle.T


def _by_cholesky(new: FloatArray) -> tuple[FloatArray, FloatArray]:
    triangle: FloatArray = np.linalg.cholesky(new @ new.T).astype(np.float64, copy=False)
    return np.linalg.inv(triangle) @ new, triangle


def _refilled(new: FloatArray, basis: FloatArray, *, seed: int) -> tuple[FloatArray, FloatArray]:
    """As `_orthonormal`, where directions that vanished (an exhausted Krylov space) are replaced by fresh ones with R
    = 0.
    """
    left, lengths, right = np.linalg.svd(new, full_matrices=False)
    alive = lengths > 1e-12 * max(lengths[0], np.finfo(float).tiny)
    fresh = np.random.default_rng(seed).standard_normal(new.shape)
    rows = np.where(alive[:, None], right, fresh)
    for _ in range(3):
        rows[~alive] -= (rows[~alive] @ basis.T) @ basis
        rows[~alive] -= (rows[~alive] @ rows[alive].T) @ rows[alive]
        rows[~alive] = np.linalg.qr(rows[~alive].T)[0].T
    return rows, np.where(alive, lengths, 0.0)[:, None] * left.T
