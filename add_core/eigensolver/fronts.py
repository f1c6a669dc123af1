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

    The solution grows in a workspace: each group's own rows lie together with their padding, one row of zeros last.
    What leads to it is held in another array: the right-hand side (n, p), then the shares (c, r, p) of group after
    group that its fronts subtract from rows further up.

    first : where its own rows begin in the workspace. fronts, size : c of them, s rows each.
    rest : (c, r) the workspace rows that each front touches further up; padding points to the row of zeros.
    shares : where in the held array its shares begin.
    slots, entries : flat positions in (c, s + r, s + r) and the entries (of nnz) of A that belong there.
    padding : flat positions of the ones that keep padded pivots regular.
    children : what lower groups add.
    """

    first: int
    fronts: int
    size: int
    rest: IntArray
    shares: int
    slots: IntArray
    entries: IntArray
    padding: IntArray
    children: tuple[ChildBlock, ...]

    def own_rows(self, x: FloatArray, begin: int = 0) -> FloatArray:
        """(c, s, p): a view of the workspace x, or of its rows from `begin` on."""
        first = self.first - begin
        return x[first : first + self.fronts * self.size].reshape(self.fronts, self.size, x.shape[1])

    def rest_rows(self, x: FloatArray) -> FloatArray:
        """(c, r, p): a copy of the rows of x further up."""
        return np.take(x, self.rest, axis=0)

    def own_shares(self, held: FloatArray) -> FloatArray:
        """(c, r, p): a view of the held array."""
        return held[self.shares : self.shares + self.rest.size].reshape(*self.rest.shape, held.shape[1])


@dataclass(frozen=True, eq=False)
class Level:
    """Groups of one height: none touches a row of another.

    first : where their rows begin in the workspace.
    gather : (rows, held) of 1 and −1: each row of the right-hand side minus the shares that lower fronts have in it.
    """

    first: int
    gather: csr_array
    groups: tuple[FrontGroup, ...]

    def gathered(self, held: FloatArray) -> list[FloatArray]:
        """(c, s, p) of each group: its rows of the right-hand side after the elimination of all lower fronts."""
        rows = self.gather @ held
        return [group.own_rows(rows, self.first) for group in self.groups]


@dataclass(frozen=True, eq=False)
class FrontTree:
    """Everything about a factorisation that follows from the pattern (indptr, indices) of A alone.

    dissection : the order of elimination. diagonal : (n,) the diagonal entries of A. levels : lowest first.
    places : (n,) where each row, in the tree's order, lies in the workspace of `workspace` rows. held : rows of the
        array of right-hand sides and shares.
    ordered_indptr, ordered_indices, ordered_entries : the pattern in the tree's order, and which entry of A goes where.
    """

    indptr: IntArray
    indices: IntArray
    dissection: Dissection
    diagonal: IntArray
    levels: tuple[Level, ...]
    places: IntArray
    workspace: int
    held: int
    ordered_indptr: IntArray
    ordered_indices: IntArray
    ordered_entries: IntArray

    @property
    def size(self) -> int:
        return len(self.indptr) - 1

    @property
    def groups(self) -> list[FrontGroup]:
        return [group for level in self.levels for group in level.groups]

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
            levels=layout.levels,
            places=read_only(layout.places),
            workspace=layout.workspace,
            held=layout.held,
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
        heights = _heights(dissection)
        batches = self._all_batches(heights)
        self.places = np.empty(len(dissection.permutation), dtype=np.int64)
        self.workspace = self._place(batches) + 1
        rests = [self._rest_rows(batch) for batch in batches]
        shares = np.cumsum([len(self.places), *(rest.size for rest in rests)])
        self.held = int(shares[-1])
        groups = [
            self._group(number, batch, rests[number], int(shares[number])) for number, batch in enumerate(batches)
        ]
        ends = np.flatnonzero(np.diff([heights[batch[0]] for batch in batches], append=-1)) + 1
        self.levels = self._levels(groups, [int(end) for end in ends], self._gathering(rests))

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

    def _rest_rows(self, batch: IntArray) -> IntArray:
        """(c, r): workspace rows, those of each front ascending, then the row of zeros as padding."""
        rows = np.full((len(batch), self._sizes(batch)[1]), self.workspace - 1)
        for k, i in enumerate(batch):
            rows[k, : len(self._rests[i])] = self.places[self._rests[i]]
        return read_only(rows)

    def _gathering(self, rests: list[IntArray]) -> csr_array:
        """(workspace, held): 1 where a row takes its right-hand side, −1 where it takes a front's share."""
        rows = np.concatenate([self.places, *(rest.ravel() for rest in rests)])
        taken = np.flatnonzero(rows < self.workspace - 1)
        signs = np.where(taken < len(self.places), 1.0, -1.0)
        return csr_array((signs, (rows[taken], taken)), shape=(self.workspace, self.held))

    def _levels(self, groups: list[FrontGroup], ends: list[int], gather: csr_array) -> tuple[Level, ...]:
        levels = []
        for begin, end in zip([0, *ends], ends, strict=False):
            first = self._firsts[begin]
            after = self._firsts[end] if end < len(groups) else self.workspace - 1
            levels.append(Level(first, gather[first:after], tuple(groups[begin:end])))
        return tuple(levels)

    def _group(self, number: int, batch: IntArray, rest: IntArray, shares: int) -> FrontGroup:
        s, r = self._sizes(batch)
        slots, padding, blocks = [], [], []
        for k, i in enumerate(batch):
            begin, end, after = self._starts[i], self._starts[i + 1], self._rests[i]

            def place(rows: IntArray, begin: int = begin, end: int = end, after: IntArray = after) -> IntArray:
                return np.where(rows < end, rows - begin, s + np.searchsorted(after, rows))

            base = k * (s + r) ** 2
            row, column = place(self._edges[self._entries[i]]).T
            slots.append(base + row * (s + r) + column)
            padding.append(base + np.arange(end - begin, s) * (s + r + 1))
            for child in self._children[i]:
                blocks.append(ChildBlock(*self._home[child], parent=k, positions=place(self._rests[child])))
        return FrontGroup(
            first=self._firsts[number],
            fronts=len(batch),
            size=s,
            rest=rest,
            shares=shares,
            slots=np.concatenate(slots),
            entries=np.concatenate([self._entries[i] for i in batch]),
            padding=np.concatenate(padding),
            children=tuple(blocks),
        )


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
