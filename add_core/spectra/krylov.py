"""A growing shift-invert Krylov basis, and the exponential of an operator on its starting vector."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .._check import FloatArray
from ..errors import ConvergenceError

_MOST_VECTORS = 150
_FIRST = 8
_STEP = 2  # between two looks at the accuracy, each of which costs a third of a solve


class KrylovBasis:
    r"""exp(−tA)v for symmetric positive semi-definite A, projected on span{v, Bv, B²v, …} with B = (I + A/rate)⁻¹.

    apply : x ↦ Bx. kernel : a unit vector with A·kernel = 0; its share of v does not decay and is kept exactly.
    workspace : from `workspace(n)`; a basis that takes another's over ends the other's life. Fresh memory costs time.
    The basis is orthonormal and grows until the requested time is accurate; later times use what is there.
    """

    def __init__(
        self,
        apply: Callable[[FloatArray], FloatArray],
        start: FloatArray,
        *,
        rate: float,
        kernel: FloatArray,
        workspace: FloatArray,
    ) -> None:
        self._apply, self._rate, self._kernel = apply, rate, kernel
        self._share = float(kernel @ start)
        rest = start - self._share * kernel
        rest -= (kernel @ rest) * kernel
        self._norm = float(np.linalg.norm(rest))
        self._start_norm = float(np.linalg.norm(start))
        self._vectors = workspace
        self._projected = np.zeros((_MOST_VECTORS + 1, _MOST_VECTORS + 1))  # upper triangle of Qᵀ B Q
        self._ritz = _Ritz.of(self._projected[:0, :0], rate)
        self._ritz_before: _Ritz | None = None
        self._count = 0
        self._complete = self._norm <= 1e-14 * self._start_norm
        if not self._complete:
            self._vectors[0] = rest / self._norm

    def decay(self, time: float, *, tolerance: float) -> FloatArray:
        """exp(−time·A) v, with an error of about `tolerance` relative to its norm."""
        coefficients = self._settled_coefficients(time, tolerance, _tail_is_small)
        even = self._share * self._kernel
        return even + self._norm * (coefficients @ self._vectors[: len(coefficients)])

    def left_at_start(self, time: float, *, tolerance: float) -> float:
        """vᵀ exp(−time·A) v, with an error of about `tolerance` relative to itself."""
        coefficients = self._settled_coefficients(time, tolerance, _first_is_steady)
        first = float(coefficients[0]) if len(coefficients) else 0.0
        return self._share**2 + self._norm**2 * first

    def _settled_coefficients(
        self, time: float, tolerance: float, settled: Callable[[FloatArray, FloatArray, float], bool]
    ) -> FloatArray:
        """exp(−time·A) of the normalised start, in a basis large enough for `settled` to agree."""
        while not self._complete:
            if self._ritz_before is not None:
                now, before = self._ritz.exponential(time), self._ritz_before.exponential(time)
                size = np.hypot(self._share, self._norm * np.linalg.norm(now)) / self._norm
                if settled(now, before, float(tolerance * size)):
                    return now
            if self._count == _MOST_VECTORS:
                raise ConvergenceError(
                    f"The heat kernel at time {time:g} did not settle with {_MOST_VECTORS} Krylov vectors. "
                    "Are some faces extremely thin?"
                )
            self._grow()
        return self._ritz.exponential(time)

    def _grow(self) -> None:
        target = min(self._count + (_STEP if self._count else _FIRST), _MOST_VECTORS)
        while self._count < target and not self._complete:
            self._extend()
        self._ritz_before = self._ritz if self._count > _FIRST else None
        self._ritz = _Ritz.of(self._projected[: self._count, : self._count], self._rate)

    def _extend(self) -> None:
        j = self._count
        known = self._vectors[: j + 1]
        w = self._apply(self._vectors[j])
        for _ in range(2):  # twice is enough
            w -= (self._kernel @ w) * self._kernel
            overlap = known @ w
            w -= overlap @ known
            self._projected[: j + 1, j] += overlap
        length = float(np.linalg.norm(w))
        self._count = j + 1
        if length <= 1e-13:
            self._complete = True
        else:
            self._vectors[j + 1] = w / length


def workspace(size: int) -> FloatArray:
    """Room for the vectors of one basis at a time, each of length `size`."""
    return np.empty((_MOST_VECTORS + 1, size))


@dataclass(frozen=True, eq=False)
class _Ritz:
    """Decay rates (j,) and eigenvectors (j, j) of A as the first j basis vectors see it."""

    rates: FloatArray
    vectors: FloatArray

    @classmethod
    def of(cls, upper: FloatArray, rate: float) -> _Ritz:
        values, vectors = np.linalg.eigh(upper, UPLO="U")
        return cls(rate * (1 / np.clip(values, np.finfo(float).tiny, 1.0) - 1), vectors)

    def exponential(self, time: float) -> FloatArray:
        """exp(−time·A) of the first basis vector, (j,)."""
        if not len(self.rates):
            return np.zeros(0)
        return np.asarray(self.vectors @ (np.exp(-time * self.rates) * self.vectors[0]))


def _tail_is_small(now: FloatArray, before: FloatArray, bound: float) -> bool:
    return float(np.linalg.norm(now[-2:])) <= bound


def _first_is_steady(now: FloatArray, before: FloatArray, bound: float) -> bool:
    # The first coefficient's error is about the square of the tail's; its change alone can stall and mislead.
    return bool(abs(now[0] - before[0]) <= bound and float(now[-1]) ** 2 <= bound / 10)
