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

CALL = 15_000
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
    """Fronts that are treated by one call, padded to one size.

    Vectors are solved in a workspace: each group's own rows lie together with their padding, one row of zeros last.

    first : where its own rows begin in the workspace. fronts, size : c of them, s rows each.
    rest : (c, r) the workspace rows that each front touches further up; padding points to the row of zeros.
    slots, entries : flat positions in (c, s + r, s + r) and the entries (of nnz) of A that belong there.
    padding : flat positions of the ones that keep padded pivots regular.
    children : what lower groups add.
    targets, gather : workspace rows touched by any front, and the 0-1 matrix that sums their shares.
    """

    first: int
    fronts: int
    size: int
    rest: IntArray
    slots: IntArray
    entries: IntArray
    padding: IntArray
    children: tuple[ChildBlock, ...]
    targets: IntArray
    gather: csr_array

    def own_rows(self, x: FloatArray) -> FloatArray:
        """(c, s, p): a view of the workspace x."""
        return x[self.first : self.first + self.fronts * self.size].reshape(self.fronts, self.size, x.shape[1])

    def rest_rows(self, x: FloatArray) -> FloatArray:
        """(c, r, p): a copy of the rows of x further up."""
        return np.take(x, self.rest, axis=0)

    def subtract(self, x: FloatArray, shares: FloatArray) -> None:
        """Subtract (c, r, p) from the rows of x further up."""
        if self.fronts > 1:
            shares = self.gather @ shares.reshape(-1, shares.shape[2])
        x[self.targets] = np.take(x, self.targets, axis=0) - shares.reshape(-1, x.shape[1])


@dataclass(frozen=True, eq=False)
class FrontTree:
    """Everything about a factorisation that follows from the pattern (indptr, indices) of A alone.

    dissection : the order of elimination. diagonal : (n,) the diagonal entries of A. groups : lowest first.
    places : (n,) where each row, in the tree's order, lies in the workspace of `workspace` rows.
    ordered_indptr, ordered_indices, ordered_entries : the pattern in the tree's order, and which entry of A goes where.
    """

    indptr: IntArray
    indices: IntArray
    dissection: Dissection
    diagonal: IntArray
    groups: tuple[FrontGroup, ...]
    places: IntArray
    workspace: int
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
        layout = _Layout(dissection, edges)
        entries = np.lexsort((edges[:, 1], edges[:, 0]))
        return cls(
            indptr=indptr,
            indices=indices,
            dissection=dissection,
            diagonal=read_only(np.flatnonzero(rows == indices)),
            groups=layout.groups,
            places=read_only(layout.places),
            workspace=layout.workspace,
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


class _Layout:
    """Forms groups from the lowest fronts up, and lays their rows out in the workspace."""

    def __init__(self, dissection: Dissection, edges: IntArray) -> None:
        self._starts, self._edges = dissection.starts, edges
        sets = len(dissection.parents)
        owner = np.repeat(np.arange(sets), np.diff(self._starts))[edges.min(axis=1)]
        order = np.argsort(owner, kind="stable")
        self._entries = np.split(order, np.searchsorted(owner[order], np.arange(1, sets)))
        self._rests = _rests(dissection, edges, self._entries)
        self._children: list[list[int]] = [[] for _ in range(sets)]
        for i, parent in enumerate(dissection.parents):
            if parent >= 0:
                self._children[parent].append(i)
        self._home: dict[int, tuple[int, int]] = {}
        batches = self._all_batches(_heights(dissection))
        self.places = np.empty(len(dissection.permutation), dtype=np.int64)
        self.workspace = self._place(batches) + 1
        self.groups = tuple(self._group(number, batch) for number, batch in enumerate(batches))

    def _sizes(self, batch: IntArray) -> tuple[int, int]:
        owns, rests = np.diff(self._starts)[batch], [len(self._rests[i]) for i in batch]
        return int(owns.max()), max(rests)

    def _all_batches(self, heights: IntArray) -> list[IntArray]:
        batches: list[IntArray] = []
        for height in range(int(heights.max()) + 1):
            members = np.flatnonzero(heights == height)
            rests = np.array([len(self._rests[i]) for i in members])
            batches += _batches(members, np.diff(self._starts)[members], rests)
        return batches

    def _place(self, batches: list[IntArray]) -> int:
        """Fill `places` and note where each batch begins; returns how many rows that takes."""
        row = 0
        self._firsts = []
        for number, batch in enumerate(batches):
            self._firsts.append(row)
            size, _ = self._sizes(batch)
            for member, i in enumerate(batch):
                begin, end = self._starts[i], self._starts[i + 1]
                self.places[begin:end] = row + member * size + np.arange(end - begin)
                self._home[int(i)] = (number, member)
            row += len(batch) * size
        return row

    def _group(self, number: int, batch: IntArray) -> FrontGroup:
        s, r = self._sizes(batch)
        zeros = self.workspace - 1
        rest = np.full((len(batch), r), zeros)
        slots, padding, blocks = [], [], []
        for k, i in enumerate(batch):
            begin, end, after = self._starts[i], self._starts[i + 1], self._rests[i]

            def place(rows: IntArray, begin: int = begin, end: int = end, after: IntArray = after) -> IntArray:
                return np.where(rows < end, rows - begin, s + np.searchsorted(after, rows))

            rest[k, : len(after)] = self.places[after]
            base = k * (s + r) ** 2
            row, column = place(self._edges[self._entries[i]]).T
            slots.append(base + row * (s + r) + column)
            padding.append(base + np.arange(end - begin, s) * (s + r + 1))
            for child in self._children[i]:
                blocks.append(ChildBlock(*self._home[child], parent=k, positions=place(self._rests[child])))
        targets, gather = _gathering(rest, zeros)
        return FrontGroup(
            first=self._firsts[number],
            fronts=len(batch),
            size=s,
            rest=read_only(rest),
            slots=np.concatenate(slots),
            entries=np.concatenate([self._entries[i] for i in batch]),
            padding=np.concatenate(padding),
            children=tuple(blocks),
            targets=targets,
            gather=gather,
        )


def _gathering(rest: IntArray, zeros: int) -> tuple[IntArray, csr_array]:
    if len(rest) == 1:
        return rest[0], csr_array((1, 1))
    valid = rest.ravel() < zeros
    targets, target = np.unique(rest.ravel()[valid], return_inverse=True)
    return targets, csr_array((np.ones(len(target)), (target, np.flatnonzero(valid))), shape=(len(targets), rest.size))


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
