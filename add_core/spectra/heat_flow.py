"""Live heat kernels: columns of exp(−t S⁻¹W) without eigenvectors, at the speed of a slider."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array
from scipy.sparse.linalg import SuperLU, splu

from .._check import BoolArray, FloatArray, finite, instance_of, numbers, positive, positive_array, vertex_index
from ..errors import ParameterError
from ..operators import AnisotropicLaplacian
from .krylov import KrylovBasis, workspace

TOLERANCE = 1e-5
"""Relative accuracy of a kernel in the mass-weighted norm, and of the heat left at its source, by default."""
_FACTOR_BYTES = 256 * 2**20
_BYTES_PER_ENTRY = 12


class HeatFlow:
    r"""Anisotropic heat kernels :math:`h_{α,θ,t}(x, ·)`, eq. (17), of one operator, for any source x, angle θ and
    time t.

    The kernel's column is projected on a Krylov space of (S + γW)⁻¹S with γ a fraction of t: some fifteen vectors
    reach `TOLERANCE` where an expansion in 300 eigenfunctions errs by half at small t. A factorisation is kept
    while θ and the decade of t stay, and a basis while the source stays too, so that another time costs next to
    nothing.

    What is spread evenly over a connected piece is split off first: its share is known exactly, so heat is
    conserved to rounding. Not safe to call from two threads at once.
    """

    def __init__(self, laplacian: AnisotropicLaplacian, *, tolerance: float = TOLERANCE) -> None:
        instance_of("laplacian", laplacian, AnisotropicLaplacian, remedy="AnisotropicLaplacian(shape) makes one.")
        self.laplacian, self.tolerance = laplacian, positive("tolerance", tolerance)
        self._massive: BoolArray = laplacian.mass > 0
        self._root = np.sqrt(np.where(self._massive, laplacian.mass, 1.0))
        # One factorisation follows the kernel: fresh memory for each costs a fifth of its time. Signatures come
        # back to theirs.
        self._latest, self._angles = _Factors(limit=0), _Factors(limit=_FACTOR_BYTES)
        self._basis: tuple[tuple[int, float, float], KrylovBasis] | None = None
        self._workspace = workspace(len(self._root))

    def kernel(self, source: int, *, theta: float, time: float) -> FloatArray:
        """Heat kernel h(source, ·) (n,), 1/length²: how unit heat released at `source` lies after `time`.

        theta : radians, counter-clockwise from the direction of maximum curvature. time : length², > 0.
        Heat stays on its connected piece, where Σ mass · h = 1; vertices without mass hold none.
        Raises ParameterError for a time that is not positive and a source that is no vertex or has no mass.
        """
        source, theta, time = self._vertex(source), finite("theta", theta), positive("time", time)
        gamma = 10.0 ** np.floor(np.log10(time)) / 4
        basis = self._basis_at(source, theta, gamma)
        column = np.empty(len(self._root))
        column[self.laplacian.pattern.elimination.order] = basis.decay(time, tolerance=self.tolerance)
        return column / self._root * self._massive

    def autodiffusion(self, source: int, *, thetas: ArrayLike, times: ArrayLike) -> FloatArray:
        """Heat left at `source`, h_{α,θ,t}(x, x), for each angle and time: (len(thetas), len(times)), 1/length².

        The anisotropic heat kernel signature of one vertex (section 4.1), straight from the operator.
        Raises like `kernel`.
        """
        source, moments = self._vertex(source), positive_array("times", times)
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

    def _new_basis(self, source: int, factor: _Factor, room: FloatArray) -> KrylovBasis:
        elimination, pieces = self.laplacian.pattern.elimination, self.laplacian.pattern.pieces
        piece = np.where(pieces == pieces[source], self._root, 0.0)[elimination.order]
        start = np.zeros(len(piece))
        start[elimination.position[source]] = 1 / self._root[source]
        even = piece / np.linalg.norm(piece)
        return KrylovBasis(factor.apply, start, rate=1 / factor.gamma, kernel=even, workspace=room)


class _Factors:
    """The factorisations used last, as many as fit into `limit` bytes, and at least one."""

    def __init__(self, *, limit: int) -> None:
        self._limit = limit
        self._kept: OrderedDict[tuple[float, float], _Factor] = OrderedDict()

    def at(self, laplacian: AnisotropicLaplacian, theta: float, gamma: float, root: FloatArray) -> _Factor:
        """The one at θ and γ, kept or new."""
        key = (theta, gamma)
        if key not in self._kept:
            self._make_room()
            self._kept[key] = _Factor.of(laplacian, theta, gamma, root)
        self._kept.move_to_end(key)
        return self._kept[key]

    def _make_room(self) -> None:
        sizes = [factor.bytes for factor in self._kept.values()]
        while sizes and sum(sizes) + sizes[-1] > self._limit:
            self._kept.popitem(last=False)
            sizes.pop(0)


@dataclass(frozen=True, eq=False)
class _Factor:
    """(I + γA)⁻¹ for A = S^{-1/2} W S^{-1/2}, on vectors in elimination order."""

    lu: SuperLU
    gamma: float
    root: FloatArray

    @classmethod
    def of(cls, laplacian: AnisotropicLaplacian, theta: float, gamma: float, root: FloatArray) -> _Factor:
        pattern, elimination = laplacian.pattern, laplacian.pattern.elimination
        values = gamma * laplacian.stiffness_values(theta)
        values[pattern.diagonal] += root**2
        n = pattern.vertex_count
        matrix = csc_array((values[elimination.entries], elimination.indices, elimination.indptr), shape=(n, n))
        # Positive definite, so no pivoting; a surface's supernodes are small, hence narrow panels.
        lu = splu(
            matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, relax=4, panel_size=1, options={"SymmetricMode": True}
        )
        return cls(lu, gamma, root[elimination.order])

    @property
    def bytes(self) -> int:
        return _BYTES_PER_ENTRY * int(self.lu.nnz)

    def apply(self, vector: FloatArray) -> FloatArray:
        return np.asarray(self.root * self.lu.solve(self.root * vector))
