"""Fan triangles that bridge a gap: a hand that rests on a thigh must not grow together with it."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from .._check import BoolArray, FloatArray, IntArray
from .distinct import is_among, sorted_distinct
from .normals import reflected_cosines

DETOUR = 10.0
"""An edge whose ends are this many times as far apart along the surface as across the edge bridges a gap."""
FACING, FACING_DETOUR = 0.4, 2.0
"""Sine between an edge and the tangent planes of both its ends above which they face each other across a gap, if the
edge runs outside of the surface: the walls of an armpit. Of such ends, those count as far apart along the surface."""
SURE_COST = 1.0
"""Cost of an edge, in distances between neighbours, that needs no test."""
SURE_BEND = 1.1
"""Cost of an edge, in its own length, that needs no test if both its ends hold it: it turns by less than 30°."""
MOST_BRIDGES = 0.1
"""Share of the triangles that may bridge gaps in a cloud dense enough to tell."""
ROUNDS = 20
_BLOCK = 128


def bridging_triangles(
    stars: IntArray,
    sure: BoolArray,
    points: FloatArray,
    normals: FloatArray,
    *,
    spacing: FloatArray,
    estimated: bool = False,
) -> BoolArray:
    """(t,): which fan triangles join parts of the surface that are near in space but far apart along it.

    The edges of the `sure` triangles are taken first, and those that cost no more than `SURE_COST` times the
    spacing of the points, unless they face each other. The others follow in `ROUNDS`, those first that are short
    and lie well between their normals: an edge is refused if its ends are joined already, but only by a detour of
    `DETOUR` times its length, or of `FACING_DETOUR` times if they face each other.
    So a finger is tied to its hand before it can be tied to what it points at. Where normals are given, edges that run
    through the inside come before those outside: they cannot span a gap, and what they join makes no detour later.
    Triangles with a refused edge bridge, except the cheapest of those without which a part would come loose.

    stars : (t, 3), centre first. points, normals : (n, 3). spacing : (n,), mean distance to the next neighbours.
    estimated : whether the normals are, and so say little about inside and outside where sheets are close.
    """
    count = len(points)
    sides = np.sort(stars[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2), axis=1)
    keys, edge = np.unique(sides[:, 0] * count + sides[:, 1], return_inverse=True)
    edge = edge.reshape(-1, 3)
    ends = np.stack([keys // count, keys % count], axis=1)
    length, cost, facing, outside = _lengths_and_costs(ends, points, normals)
    reach = np.where(facing, FACING_DETOUR, DETOUR) * length
    straight = _held_by_both(ends, stars, count) & (cost <= SURE_BEND * length)
    taken = straight | ((cost <= SURE_COST * spacing[ends].max(axis=1)) & ~facing)
    taken[edge[sure]] = True
    order = np.lexsort((cost, outside & (not estimated), facing))
    taken = _grown(taken, ends, length, reach, order[~taken[order]])
    kept = _rejoined(np.asarray(taken[edge].all(axis=1)), stars, cost[edge].max(axis=1, initial=0.0), count)
    if np.count_nonzero(kept) < (1 - MOST_BRIDGES) * len(kept):
        return np.zeros(len(kept), dtype=bool)  # points too few to tell near from far: every way is a detour
    return np.asarray(~kept)


def _lengths_and_costs(
    ends: IntArray, points: FloatArray, normals: FloatArray
) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray]:
    """Of each edge: length, cost, whether its ends face each other, and whether it runs outside of the surface."""
    chord = points[ends[:, 1]] - points[ends[:, 0]]
    length = np.linalg.norm(chord, axis=1)
    chord /= length[:, None]
    here, there = normals[ends[:, 0]], normals[ends[:, 1]]
    heights = np.einsum("ei,ei->e", chord, here), np.einsum("ei,ei->e", chord, there)
    steepness = np.maximum(heights[0] ** 2, heights[1] ** 2)
    facing = np.minimum(heights[0], -heights[1]) > FACING
    cost = length * (2 - reflected_cosines(chord, here, there) + steepness)
    return length, cost, facing, heights[0] > heights[1]


def _held_by_both(ends: IntArray, stars: IntArray, count: int) -> BoolArray:
    """(e,): whether each end is the centre of a fan that reaches the other."""
    reached = sorted_distinct(np.repeat(stars[:, 0], 2) * count + stars[:, 1:].ravel())
    there, back = ends[:, 0] * count + ends[:, 1], ends[:, 1] * count + ends[:, 0]
    return is_among(there, reached) & is_among(back, reached)


def _grown(taken: BoolArray, ends: IntArray, length: FloatArray, reach: FloatArray, doubtful: IntArray) -> BoolArray:
    """(e,): `taken` and those of the `doubtful` edges that go with it, asked in their order."""
    taken = taken.copy()
    pending = np.empty(0, dtype=np.int64)
    for part in np.array_split(doubtful, ROUNDS):
        pending = _admit(np.concatenate([pending, part]), taken, ends, length, reach)
    while len(pending):
        pending = _admit(pending, taken, ends, length, reach)
    return taken


def _admit(pending: IntArray, taken: BoolArray, ends: IntArray, length: FloatArray, reach: FloatArray) -> IntArray:
    """Take or refuse the `pending` edges, cheapest first, and return those that still await what joins their ends.

    Between separate pieces only the cheapest edge of each piece is taken at once.
    """
    if not len(pending):
        return pending
    count = int(ends.max()) + 1
    graph = csr_array(coo_array((length[taken], (ends[taken, 0], ends[taken, 1])), shape=(count, count)))
    piece = connected_components(graph, directed=False)[1][ends[pending]]
    joined = pending[piece[:, 0] == piece[:, 1]]
    taken[joined[_detours(graph, ends[joined], reach[joined]) <= reach[joined]]] = True
    apart = piece[:, 0] != piece[:, 1]
    chosen = np.unique(np.unique(piece[apart], return_index=True)[1] // 2)
    waiting = pending[apart]
    taken[waiting[chosen]] = True
    return np.delete(waiting, chosen)


def _detours(graph: csr_array, ends: IntArray, reach: FloatArray) -> FloatArray:
    """(p,): lengths of the paths between pairs of `ends`, inf beyond the greatest `reach`."""
    found = np.full(len(ends), np.inf)
    sources, row = np.unique(ends[:, 0], return_inverse=True)
    for low in range(0, len(sources), _BLOCK):
        inside = np.flatnonzero((row >= low) & (row < low + _BLOCK))
        limit = float(reach[inside].max()) * 1.001
        table = dijkstra(graph, directed=False, indices=sources[low : low + _BLOCK], limit=limit)
        found[inside] = table[row[inside] - low, ends[inside, 1]]
    return found


def _rejoined(kept: BoolArray, stars: IntArray, cost: FloatArray, count: int) -> BoolArray:
    """(t,): `kept` and the cheapest other triangles without which a part would come loose from the rest."""
    kept = kept.copy()
    while True:
        sides = stars[kept][:, [0, 1, 0, 2]].reshape(-1, 2)
        graph = csr_array((np.ones(len(sides), dtype=np.int8), (sides[:, 0], sides[:, 1])), shape=(count, count))
        piece = connected_components(graph, directed=False)[1][stars]
        loose = np.flatnonzero((piece != piece[:, :1]).any(axis=1))
        if not len(loose):
            return kept
        loose = loose[np.argsort(cost[loose], kind="stable")]
        kept[loose[np.unique(np.unique(piece[loose], return_index=True)[1] // 3)]] = True
