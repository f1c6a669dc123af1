"""Nested dissection: in which order to eliminate the vertices of a sparse symmetric pattern.

A vertex separator splits the graph in two halves that do not touch; each half is split again until it is small.
Eliminating the halves before their separator keeps the factors of a surface with n vertices at O(n log n) entries,
gathered in dense blocks (George 1973). The order follows from the pattern alone, so every pose of one connectivity,
every angle and every anisotropy share it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from hashlib import blake2b
from pathlib import Path

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components, maximum_bipartite_matching

from .._check import BoolArray, FloatArray, IntArray, read_only

LANDMARKS = 8
"""Breadth-first distances from this many far-apart vertices place every vertex; 4 gave 10 % more fill, 16 no less."""

KEPT = 8
"""Dissections that are remembered; each is as small as a few index arrays."""

_known: dict[bytes, Dissection] = {}


@dataclass(frozen=True, eq=False)
class Dissection:
    """A tree of vertex sets, children before parents: no edge joins two sets unless one lies above the other.

    permutation : (n,), the vertices in the order of their elimination.
    starts : (N + 1,), set i holds permutation[starts[i]:starts[i + 1]] (perhaps none, where a graph falls apart by
        itself).
    parents : (N,), the set above each; −1 for the root.
    """

    permutation: IntArray
    starts: IntArray
    parents: IntArray

    def save(self, folder: Path) -> None:
        np.savez(folder / "dissection.npz", **{field.name: getattr(self, field.name) for field in fields(self)})

    @classmethod
    def load(cls, folder: Path) -> Dissection:
        with np.load(folder / "dissection.npz", allow_pickle=False) as arrays:
            return cls(**{field.name: read_only(arrays[field.name]) for field in fields(cls)})


Progress = Callable[[int, int], None]


def known_dissection(
    indptr: IntArray, indices: IntArray, *, progress: Progress = lambda done, total: None
) -> Dissection:
    """`nested_dissection`, remembered for the last few patterns: every pose of one connectivity has the same."""
    digest = blake2b(np.asarray(indptr, dtype=np.int64).tobytes(), digest_size=16)
    digest.update(np.asarray(indices, dtype=np.int64).tobytes())
    key = digest.digest()
    found = _known.pop(key, None)
    found = nested_dissection(indptr, indices, progress=progress) if found is None else found
    _known[key] = found
    while len(_known) > KEPT:
        _known.pop(next(iter(_known)), None)
    return found


def nested_dissection(
    indptr: IntArray, indices: IntArray, *, leaf: int = 40, progress: Progress = lambda done, total: None
) -> Dissection:
    """Dissect the graph of a symmetric sparse matrix into sets of at most about `leaf` vertices.

    indptr, indices : compressed rows of the pattern; entries on the diagonal do not matter.
    progress : told how many vertices of how many have their place; what it raises ends the computation.
    The result depends on these arrays only, never on chance, on coordinates or on values.
    """
    n = len(indptr) - 1
    rows = np.repeat(np.arange(n), np.diff(indptr))
    upper = rows < indices
    tails, heads = rows[upper], np.asarray(indices, dtype=np.int64)[upper]
    places = _graph_places(indptr, indices)
    sets: list[IntArray] = []
    parents: list[int] = []
    placed = 0

    def dissect(vertices: IntArray, tails: IntArray, heads: IntArray) -> int:
        nonlocal placed
        children: list[int] = []
        own = vertices
        if len(vertices) > leaf:
            part = _two_halves(places[vertices], tails, heads)  # 0, 1: halves; 2: separator
            own = vertices[part == 2]
            for half in (0, 1):
                inside = np.flatnonzero(part == half)
                children.append(dissect(vertices[inside], *_subgraph(inside, tails, heads, len(vertices))))
        sets.append(own)
        parents.append(-1)
        placed += len(own)
        progress(placed, n)
        for child in children:
            parents[child] = len(sets) - 1
        return len(sets) - 1

    dissect(np.arange(n), tails, heads)
    starts = np.concatenate([[0], np.cumsum([len(own) for own in sets])])
    permutation = np.concatenate(sets).astype(np.int64)
    return Dissection(read_only(permutation), read_only(starts.astype(np.int64)), read_only(np.array(parents)))


def _subgraph(inside: IntArray, tails: IntArray, heads: IntArray, count: int) -> tuple[IntArray, IntArray]:
    number = np.full(count, -1)
    number[inside] = np.arange(len(inside))
    tails, heads = number[tails], number[heads]
    kept = (tails >= 0) & (heads >= 0)
    return tails[kept], heads[kept]


def _graph_places(indptr: IntArray, indices: IntArray) -> FloatArray:
    """(n, LANDMARKS + 1): where each vertex lies in its graph, by smoothed distances from far-apart vertices.

    The last column tells components apart, so that a half is cut between components before it is cut through one.
    """
    n = len(indptr) - 1
    graph = csr_array((np.ones(len(indices), dtype=np.int8), indices, indptr), shape=(n, n))
    labels = connected_components(graph, directed=False)[1]
    columns = np.zeros((n, LANDMARKS))
    nearest = np.full(n, np.inf)
    start = _farthest_from(graph, 0)
    for column in columns.T:
        column[:] = _hops(graph, start)
        nearest = np.minimum(nearest, column)
        start = int(np.argmax(np.where(np.isfinite(column), nearest, -1.0)))
    columns[~np.isfinite(columns)] = 0.0
    degree = np.maximum(np.diff(indptr), 1)[:, None]
    for _ in range(3):  # whole numbers tie in large groups that a median cannot split; averages do not
        columns = 0.5 * columns + 0.5 * (graph @ columns) / degree
    apart = 4.0 * (columns.max(initial=1.0) + 1.0)
    return np.column_stack([columns, apart * labels])


def _hops(graph: csr_array, start: int) -> FloatArray:
    """(n,): edges on the shortest path from `start`; infinite in other components."""
    order, before = breadth_first_order(graph, start, directed=False)
    hops = np.full(graph.shape[0], np.inf)
    hops[start] = 0.0
    # Parents precede children in the order, and so does each level: fill level by level.
    position = np.empty(graph.shape[0], dtype=np.int64)
    position[order] = np.arange(len(order))
    parent = position[before[order[1:]]]
    level_end, level = 1, 0
    while level_end < len(order):
        begin, level = level_end, level + 1
        level_end = 1 + int(np.searchsorted(parent, begin))
        hops[order[begin:level_end]] = level
    return hops


def _farthest_from(graph: csr_array, start: int) -> int:
    hops = _hops(graph, start)
    return int(np.argmax(np.where(np.isfinite(hops), hops, -1.0)))


def _two_halves(places: FloatArray, tails: IntArray, heads: IntArray) -> IntArray:
    """0, 1 for the halves and 2 for the separator of a graph: the best of several planes, then the least vertex
    cover.
    """
    centred = places - places.mean(axis=0)
    axes = np.linalg.eigh(centred.T @ centred)[1][:, ::-1][:, :3]
    angles = np.pi * np.arange(6) / 6
    directions = np.column_stack(
        [np.outer(axes[:, 0], np.cos(angles)) + np.outer(axes[:, 1], np.sin(angles)), axes[:, 2]]
    )
    heights = (centred @ directions).T
    straight = [_cut(height, 0.5, tails, heads) for height in heights]
    chosen = heights[int(np.argmin([cut.score for cut in straight]))]
    shifted = [_cut(chosen, share, tails, heads) for share in (0.42, 0.46, 0.54, 0.58)]
    best = min([*straight, *shifted], key=lambda cut: cut.score)
    upper = best.upper
    if not np.isfinite(best.score):  # all places coincide, as in a complete graph
        upper = np.arange(len(places)) >= len(places) // 2
    part = upper.astype(np.int64)
    part[_least_cover(upper, tails, heads)] = 2
    return part


@dataclass(frozen=True, eq=False)
class _Cut:
    """Which vertices lie above a plane, and how bad that is; infinitely, if all or none do."""

    upper: BoolArray
    score: float


def _cut(height: FloatArray, share: float, tails: IntArray, heads: IntArray) -> _Cut:
    """The cut with `share` of the vertices below it. A lopsided one deepens the tree: it must save edges for that."""
    k = int(share * len(height))
    upper = height > np.partition(height, k)[k]
    count = np.count_nonzero(upper)
    if not 0 < count < len(upper):
        return _Cut(upper, np.inf)
    edges = np.count_nonzero(upper[tails] != upper[heads])
    return _Cut(upper, (edges + 1) * (1.0 + 2.0 * abs(2.0 * count / len(upper) - 1.0) ** 2))


def _least_cover(upper: BoolArray, tails: IntArray, heads: IntArray) -> IntArray:
    """The fewest vertices that touch every edge between the halves (König: as many as a maximum matching has edges)."""
    across = upper[tails] != upper[heads]
    below = np.where(upper[tails], heads, tails)[across]
    above = np.where(upper[tails], tails, heads)[across]
    if len(below) == 0:
        return np.empty(0, dtype=np.int64)
    low, row = np.unique(below, return_inverse=True)
    high, column = np.unique(above, return_inverse=True)
    between = csr_array((np.ones(len(row)), (row, column)), shape=(len(low), len(high)))
    partner = maximum_bipartite_matching(between, perm_type="column")  # of each row: its column, or −1
    of_column = np.full(len(high), -1)
    of_column[partner[partner >= 0]] = np.flatnonzero(partner >= 0)
    reached = partner < 0  # rows that alternating paths reach from unmatched rows
    reached_columns = np.zeros(len(high), dtype=bool)
    frontier = np.flatnonzero(reached)
    while len(frontier):
        fresh = np.unique(between[frontier].indices)
        fresh = fresh[~reached_columns[fresh]]
        reached_columns[fresh] = True
        frontier = of_column[fresh]
        frontier = frontier[(frontier >= 0) & ~reached[frontier]]
        reached[frontier] = True
    return np.concatenate([low[~reached], high[reached_columns]])
