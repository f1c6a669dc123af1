"""The sparsity pattern that every operator of a shape shares."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from .._check import FloatArray, IntArray, read_only


@dataclass(frozen=True, eq=False)
class SparsityPattern:
    """Which vertices of which elements meet: one symmetric CSR pattern, diagonal included, for all angles and
    anisotropies.

    Keeping one pattern by construction matters: adding sparse matrices would prune entries that happen to be zero
    at one angle.

    indptr, indices : CSR row pointers (n + 1,) and sorted columns (nnz,).
    slots : (t, 3, 3) where the entry (i, j) of each element's matrix is summed up.
    """

    indptr: IntArray
    indices: IntArray
    slots: IntArray

    @classmethod
    def of(cls, triangles: IntArray, vertex_count: int) -> SparsityPattern:
        """The pattern of elements with the corners `triangles` (t, 3). Every vertex keeps its diagonal entry."""
        n = vertex_count
        keys = (triangles[:, :, None] * n + triangles[:, None, :]).ravel()
        entries, inverse = np.unique(np.concatenate([keys, np.arange(n) * (n + 1)]), return_inverse=True)
        indptr = np.searchsorted(entries, np.arange(n + 1) * n)
        return cls(
            indptr=read_only(indptr.astype(np.int64)),
            indices=read_only((entries % n).astype(np.int64)),
            slots=read_only(inverse[: len(keys)].reshape(-1, 3, 3).astype(np.int64)),
        )

    @property
    def vertex_count(self) -> int:
        return len(self.indptr) - 1

    @cached_property
    def diagonal(self) -> IntArray:
        """(n,): where each row keeps its diagonal entry."""
        rows = np.repeat(np.arange(self.vertex_count), np.diff(self.indptr))
        return read_only(np.flatnonzero(self.indices == rows))

    def assembly(self, element_matrices: FloatArray) -> csr_array:
        """(nnz, t): from a factor for each of the element matrices (t, 3, 3) to the values of their weighted sum."""
        t = len(element_matrices)
        columns = np.repeat(np.arange(t), 9)
        entries = (element_matrices.ravel(), (self.slots.ravel(), columns))
        return csr_array(entries, shape=(len(self.indices), t))

    @cached_property
    def pieces(self) -> IntArray:
        """(n,): the connected piece of each vertex, numbered by first vertex; vertices of no element stand alone."""
        graph = self.matrix(np.ones(len(self.indices)))
        return read_only(connected_components(graph, directed=False)[1].astype(np.int64))

    def matrix(self, values: FloatArray) -> csr_array:
        """The sparse matrix (n, n) with `values` (nnz,) on this pattern."""
        n = self.vertex_count
        return csr_array((values, self.indices, self.indptr), shape=(n, n))

    @cached_property
    def elimination(self) -> EliminationOrder:
        """An order of the vertices in which sparse factorisations stay sparse, found once for all operators."""
        return EliminationOrder.of(self)


@dataclass(frozen=True, eq=False)
class EliminationOrder:
    """A fill-reducing permutation of a pattern.

    order : (n,): the vertex eliminated k-th. position : (n,) its inverse.
    indptr, indices, entries : the permuted pattern in CSC form, and which value (nnz,) of the original each of its
        entries is.
    """

    order: IntArray
    position: IntArray
    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    entries: IntArray

    @classmethod
    def of(cls, pattern: SparsityPattern) -> EliminationOrder:
        """Minimum degree, as SuperLU finds it."""
        values = np.full(len(pattern.indices), -1.0)
        values[pattern.diagonal] = np.diff(pattern.indptr) + 1.0
        position = splu(
            pattern.matrix(values).tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        ).perm_c.astype(np.int64)
        order = np.argsort(position)
        numbered = pattern.matrix(np.arange(1.0, len(pattern.indices) + 1))
        permuted = numbered[order][:, order].tocsc()
        permuted.sort_indices()
        return cls(
            order=read_only(order),
            position=read_only(position),
            indptr=read_only(permuted.indptr.astype(np.int32)),
            indices=read_only(permuted.indices.astype(np.int32)),
            entries=read_only(permuted.data.astype(np.int64) - 1),
        )
