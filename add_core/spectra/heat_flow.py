"""Live heat kernels: columns of exp(−t S⁻¹W) without eigenvectors, at the speed of a slider."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .._check import BoolArray, FloatArray, finite, instance_of, numbers, positive, positive_array, vertex_index
from ..errors import ParameterError
from ..operators import AnisotropicLaplacian
from .heat_factors import Factor, Factors, Ordering, Progress
from .krylov import KrylovBasis, workspace

TOLERANCE = 1e-5
"""Relative accuracy of a kernel in the mass-weighted norm, and of the heat left at its source, by default."""
STILL = 1e12
"""Times later than this over Weyl's first eigenvalue, when all heat is even to rounding, are taken for that one."""
LEAST_TIME = 1e-300
"""Times earlier than this, whose reciprocals are too large to count, are taken for it: no heat has moved yet."""
_FACTOR_BYTES = 256 * 2**20


class HeatFlow:
    r"""Anisotropic heat kernels :math:`h_{α,θ,t}(x, ·)`, eq. (17), of one operator, for any source x, angle θ and
    time t.

    The kernel's column is projected on a Krylov space of (S + γW)⁻¹S with γ a fraction of t: some fifteen vectors
    reach `TOLERANCE` where an expansion in 300 eigenfunctions errs by half at small t. A factorisation is kept
    while θ and the decade of t stay, and a basis while the source stays too, so that another time costs next to
    nothing.

    What is spread evenly over a connected piece is split off first: its share is known exactly, so heat is
    conserved to rounding. Not safe to call from two threads at once.

    progress : told between the steps of a factorisation how many of how many are done; what it raises ends the call
        and leaves the flow as it was.
    """

    def __init__(
        self,
        laplacian: AnisotropicLaplacian,
        *,
        tolerance: float = TOLERANCE,
        progress: Progress = lambda done, total: None,
    ) -> None:
        instance_of("laplacian", laplacian, AnisotropicLaplacian, remedy="AnisotropicLaplacian(shape) makes one.")
        self.laplacian, self.tolerance = laplacian, positive("tolerance", tolerance)
        self._progress = progress
        self._massive: BoolArray = laplacian.mass > 0
        self._root = np.sqrt(np.where(self._massive, laplacian.mass, 1.0))
        # One factorisation follows the kernel: fresh memory for each costs a fifth of its time. Signatures come
        # back to theirs.
        self._latest, self._angles = Factors(progress, limit=0), Factors(progress, limit=_FACTOR_BYTES)
        self._basis: tuple[tuple[int, float, float], KrylovBasis] | None = None
        self._workspace = workspace(len(self._root))
        self._last = STILL / laplacian.weyl_eigenvalue(1)

    def kernel(self, source: int, *, theta: float, time: float) -> FloatArray:
        """Heat kernel h(source, ·) (n,), 1/length²: how unit heat released at `source` lies after `time`.

        theta : radians, counter-clockwise from the direction of maximum curvature. time : length², > 0.
        Heat stays on its connected piece, where Σ mass · h = 1; vertices without mass hold none.
        Raises ParameterError for a time that is not positive and a source that is no vertex or has no mass.
        """
        source, theta, time = self._vertex(source), finite("theta", theta), positive("time", time)
        time = min(max(time, LEAST_TIME), self._last)
        gamma = 10.0 ** np.floor(np.log10(time)) / 4
        basis = self._basis_at(source, theta, gamma)
        column = np.empty(len(self._root))
        column[self._ordering.order] = basis.decay(time, tolerance=self.tolerance)
        return column / self._root * self._massive

    def autodiffusion(self, source: int, *, thetas: ArrayLike, times: ArrayLike) -> FloatArray:
        """Heat left at `source`, h_{α,θ,t}(x, x), for each angle and time: (len(thetas), len(times)), 1/length².

        The anisotropic heat kernel signature of one vertex (section 4.1), straight from the operator.
        Raises like `kernel`.
        """
        source, moments = self._vertex(source), np.clip(positive_array("times", times), LEAST_TIME, self._last)
        angles = [finite("thetas", angle) for angle in np.atleast_1d(numbers("thetas", thetas))]
        # A diagonal value converges twice as fast as a column, so one factorisation serves one and a half decades.
        gammas = 10.0 ** (1.5 * np.floor(np.log10(moments) / 1.5)) / 2
        left, room = np.empty((len(angles), len(moments))), workspace(len(self._root))
        for row, theta in enumerate(angles):
            for gamma in np.unique(gammas):
                basis = self._new_basis(source, self._angles.at(self.laplacian, theta, gamma, self._root), room)
                for k in np.flatnonzero(gammas == gamma):
                    left[row, k] = basis.left_at_start(moments[k], tolerance=self.tolerance)
        return left

    def _vertex(self, source: int) -> int:
        source = vertex_index("source", source, len(self._root))
        if not self._massive[source]:
            raise ParameterError(
                f"source {source} belongs to no face with an area, so it holds no heat. Choose another vertex."
            )
        return source

    def _basis_at(self, source: int, theta: float, gamma: float) -> KrylovBasis:
        key = (source, theta, gamma)
        if self._basis is None or self._basis[0] != key:
            self._basis = None
            factor = self._latest.at(self.laplacian, theta, gamma, self._root)
            self._basis = key, self._new_basis(source, factor, self._workspace)
        return self._basis[1]

    @cached_property
    def _ordering(self) -> Ordering:
        return Ordering.of(self.laplacian.pattern, self._progress)

    def _new_basis(self, source: int, factor: Factor, room: FloatArray) -> KrylovBasis:
        elimination, pieces = self._ordering, self.laplacian.pattern.pieces
        piece = np.where(pieces == pieces[source], self._root, 0.0)[elimination.order]
        start = np.zeros(len(piece))
        start[elimination.position[source]] = 1 / self._root[source]
        even = piece / np.linalg.norm(piece)
        return KrylovBasis(factor.apply, start, rate=1 / factor.gamma, kernel=even, workspace=room)
