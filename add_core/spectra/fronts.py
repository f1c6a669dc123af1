"""The symbolic half of a multifrontal factorisation: which front holds which vertices and where its entries go."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from .._check import FloatArray, IntArray, read_only
from .ordering import Dissection

PADDING = 1.3
"""Many small fronts of one height are padded to one size and treated by one call while that adds less than this to
the work.
"""

CALL = 20_000
"""What one more call costs, counted in entries of a front: below this a batch takes any padding."""


@dataclass(frozen=True, eq=False)
class ChildBlock:
    """What a lower front leaves to one above: its block `member` of `group` adds to `positions` of front `parent`."""

    group: int
    member: int
    parent: int
    positions: IntArray


@dataclass(frozen=True, eq=False)
class FrontGroup:
    """Fronts that are treated by one call. Padding points to row n, one past the last.

    own : (c, s) the rows that each front eliminates. rest : (c, r) the rows that it touches further up.
    slots, entries : flat positions in (c, s + r, s + r) and the entries (of nnz) of A that belong there.
    padding : flat positions of the ones that keep padded pivots regular.
    children : what lower groups add.
    targets, gather : rows touched by any front of the group, and the 0-1 matrix that sums their shares.
    """

    own: IntArray
    rest: IntArray
    slots: IntArray
    entries: IntArray
    padding: IntArray
    children: tuple[ChildBlock, ...]
    targets: IntArray
    gather: csr_array

    def own_rows(self, x: FloatArray) -> FloatArray:
        """(c, s, p) of x (n + 1, p)."""
        if len(self.own) == 1 and self.own.size:
            return x[None, self.own[0, 0] : self.own[0, -1] + 1]
        return x[self.own]

    def set_own_rows(self, x: FloatArray, own: FloatArray) -> None:
        """Write (c, s, p) to x (n + 1, p); what padding writes lands in the last row."""
        x[self.own] = own

    def subtract(self, x: FloatArray, shares: FloatArray) -> None:
        """Subtract (c, r, p) from the rows of x further up."""
        if len(self.rest) == 1:
            x[self.rest[0]] -= shares[0]
        else:
            x[self.targets] -= self.gather @ shares.reshape(-1, shares.shape[2])


@dataclass(frozen=True, eq=False)
class FrontTree:
    """Everything about a factorisation that follows from the pattern (indptr, indices) of A alone.

    dissection : the order of elimination. diagonal : (n,) the diagonal entries of A. groups : lowest first.
    ordered_indptr, ordered_indices, ordered_entries : the pattern in the tree's order, and which entry of A goes where.
    """

    indptr: IntArray
    indices: IntArray
    dissection: Dissection
    diagonal: IntArray
    groups: tuple[FrontGroup, ...]
    ordered_indptr: IntArray
    ordered_indices: IntArray
    ordered_entries: IntArray

    @property
    def size(self) -> int:
        return len(self.indptr) - 1

    @classmethod
    def of(cls, indptr: IntArray, indices: IntArray, dissection: Dissection) -> FrontTree:
        """Analyse a symmetric pattern whose diagonal is stored, to be eliminated in the order of `dissection`."""
        n = len(indptr) - 1
        position = np.empty(n, dtype=np.int64)
        position[dissection.permutation] = np.arange(n)
        rows = np.repeat(np.arange(n), np.diff(indptr))
        edges = np.column_stack([position[rows], position[indices]])
        groups = tuple(_grouped(dissection, edges))
        entries = np.lexsort((edges[:, 1], edges[:, 0]))
        return cls(
            indptr=indptr,
            indices=indices,
            dissection=dissection,
            diagonal=read_only(np.flatnonzero(rows == indices)),
            groups=groups,
            ordered_indptr=np.searchsorted(edges[entries, 0], np.arange(n + 1)),
            ordered_indices=edges[entries, 1],
            ordered_entries=entries,
        )


def _rests(dissection: Dissection, edges: IntArray, entry_groups: list[IntArray]) -> list[IntArray]:
    """For each set: the later rows that it or any set below it touches, ascending."""
    below: list[list[IntArray]] = [[] for _ in dissection.parents]
    rests = []
    for i, parent in enumerate(dissection.parents):
        end = dissection.starts[i + 1]
        touched = np.concatenate([edges[entry_groups[i]].max(axis=1), *below[i]])
        rests.append(np.unique(touched[touched >= end]))
        if parent >= 0:
            below[parent].append(rests[i])
    return rests


def _heights(dissection: Dissection) -> IntArray:
    heights = np.zeros(len(dissection.parents), dtype=np.int64)
    for i, parent in enumerate(dissection.parents):
        if parent >= 0:
            heights[parent] = max(heights[parent], heights[i] + 1)
    return heights


def _grouped(dissection: Dissection, edges: IntArray) -> Iterator[FrontGroup]:
    starts = dissection.starts
    owner = np.repeat(np.arange(len(starts) - 1), np.diff(starts))[edges.min(axis=1)]
    order = np.argsort(owner, kind="stable")
    entry_groups = np.split(order, np.searchsorted(owner[order], np.arange(1, len(starts) - 1)))
    rests = _rests(dissection, edges, entry_groups)
    heights = _heights(dissection)
    home: dict[int, tuple[int, int]] = {}
    children: list[list[int]] = [[] for _ in dissection.parents]
    for i, parent in enumerate(dissection.parents):
        if parent >= 0:
            children[parent].append(i)
    number = 0
    for height in range(int(heights.max()) + 1):
        members = np.flatnonzero(heights == height)
        for batch in _batches(members, np.diff(starts)[members], np.array([len(rests[i]) for i in members])):
            for member, i in enumerate(batch):
                home[int(i)] = (number, member)
            yield _front_group(batch, starts, edges, entry_groups, rests, children, home)
            number += 1


def _batches(members: IntArray, owns: IntArray, rests: IntArray) -> Iterator[IntArray]:
    """Split fronts of one height, smallest first, so that padding a batch to one size wastes no more than PADDING."""
    order = np.lexsort((owns, rests))
    batch: list[int] = []
    real = 0
    for k in order:
        work = owns[k] * (owns[k] + 2 * rests[k])
        s, r = max(owns[[*batch, k]]), max(rests[[*batch, k]])
        if batch and (len(batch) + 1) * s * (s + 2 * r) > PADDING * (real + work) + CALL:
            yield members[batch]
            batch, real = [], 0
        batch.append(k)
        real += work
    yield members[batch]


def _front_group(
    batch: IntArray,
    starts: IntArray,
    edges: IntArray,
    entry_groups: list[IntArray],
    rests: list[IntArray],
    children: list[list[int]],
    home: dict[int, tuple[int, int]],
) -> FrontGroup:
    n = int(starts[-1])
    s = max(int(starts[i + 1] - starts[i]) for i in batch)
    r = max(len(rests[i]) for i in batch)
    own, rest = np.full((len(batch), s), n), np.full((len(batch), r), n)
    slots, padding, blocks = [], [], []
    for k, i in enumerate(batch):
        begin, end = starts[i], starts[i + 1]
        own[k, : end - begin] = np.arange(begin, end)
        rest[k, : len(rests[i])] = rests[i]

        def place(rows: IntArray, begin: int = begin, end: int = end, after: IntArray = rests[i]) -> IntArray:
            return np.where(rows < end, rows - begin, s + np.searchsorted(after, rows))

        base = k * (s + r) ** 2
        row, column = place(edges[entry_groups[i]]).T
        slots.append(base + row * (s + r) + column)
        padding.append(base + np.arange(end - begin, s) * (s + r + 1))
        blocks += [ChildBlock(*home[child], parent=k, positions=place(rests[child])) for child in children[i]]
    valid = rest.ravel() < n
    targets, target = np.unique(rest.ravel()[valid], return_inverse=True)
    gather = csr_array((np.ones(len(target)), (target, np.flatnonzero(valid))), shape=(len(targets), len(batch) * r))
    return FrontGroup(
        own=read_only(own),
        rest=read_only(rest),
        slots=np.concatenate(slots),
        entries=np.concatenate([entry_groups[i] for i in batch]),
        padding=np.concatenate(padding),
        children=tuple(blocks),
        targets=targets,
        gather=gather,
    )
