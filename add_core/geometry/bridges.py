"""Fan triangles that bridge a gap: a hand that rests on a thigh must not grow together with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from .._check import BoolArray, FloatArray, IntArray
from .distinct import is_among, sorted_distinct
from .normals import EstimatedNormals, reflected_cosines

DETOUR = 10.0
"""An edge whose ends are this many times as far apart along the surface as across the edge bridges a gap."""
POOR_COST = 2.0
"""Cost of an edge, in its own length, beyond which a detour shorter by as much makes it a bridge."""
FACING, FACING_DETOUR = 0.4, 2.0
"""Sine between an edge and the tangent planes of both its ends above which they face each other across a gap, if the
edge runs outside of the surface: the walls of an armpit. Of such ends, those count as far apart along the surface."""
CROTCH, CROTCH_DETOUR = 0.9, 2.25
"""Length and detour, in distances between neighbours, below which no edge whose ends face each other bridges: where
two fingers part, the way around it leads over the next points."""
CROSSING, CROSSING_DETOUR = 0.8, 4.0
"""Sum of the sines by which an edge runs below the tangent planes of its ends above which it crosses the inside if
their normals are opposed: a thin sheet, or a hand sunk into a hip. Of such ends, those count as far apart."""
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
    estimated: EstimatedNormals | None = None,
) -> BoolArray:
    """(t,): which fan triangles join parts of the surface that are near in space but far apart along it.

    The edges of the `sure` triangles are taken first, and those that cost no more than `SURE_COST` times the
    spacing of the points, unless they face each other or run through the inside for more than `POOR_COST` times their
    length, as where surfaces cross. The others follow in `ROUNDS`, those first that are short
    and lie well between their normals: an edge is refused if its ends are joined already, but only by a detour of
    `DETOUR` times its length, or fewer if it lies badly between their normals: see `_reaches`.
    So a finger is tied to its hand before it can be tied to what it points at. Where normals are given, edges that run
    through the inside come before those outside: they span no gap, and what they join makes no detour later.
    Triangles with a refused edge bridge, except the cheapest of those without which a part would come loose.

    stars : (t, 3), centre first. points, normals : (n, 3). spacing : (n,), mean distance to the next neighbours.
    estimated : if the normals are, and so say little about inside and outside where sheets are close. Then every edge
        off the border of what the points enclose is tested, after all others.
    """
    count = len(points)
    sides = np.sort(stars[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2), axis=1)
    keys, edge = np.unique(sides[:, 0] * count + sides[:, 1], return_inverse=True)
    edge = edge.reshape(-1, 3)
    ends = np.stack([keys // count, keys % count], axis=1)
    spacing = spacing[ends].max(axis=1)
    chords = _Chords.of(ends, points, normals)
    cost, outside = chords.cost, chords.outside
    off = np.zeros(len(ends), dtype=bool) if estimated is None else estimated.off_surface(ends)
    straight = ~off & _held_by_both(ends, stars, count) & (cost <= SURE_BEND * chords.length)
    untested = ~off & ~chords.facing & (outside | (cost <= POOR_COST * chords.length))
    taken = straight | (untested & (cost <= SURE_COST * spacing))
    taken[edge[sure]] = True
    order = np.lexsort((cost, outside & (estimated is None), chords.facing | off))
    taken = _grown(taken, ends, chords.length, _reaches(chords, spacing), order[~taken[order]])
    kept = _rejoined(np.asarray(taken[edge].all(axis=1)), stars, cost[edge].max(axis=1, initial=0.0), count)
    if np.count_nonzero(kept) < (1 - MOST_BRIDGES) * len(kept):
        return np.zeros(len(kept), dtype=bool)  # points too few to tell near from far: every way is a detour
    return np.asarray(~kept)


@dataclass(frozen=True, eq=False)
class _Chords:
    """Of each edge (e,): length, cost, and how it lies between the normals of its ends.

    facing : whether these look at each other across it. outside : whether it runs outside of the surface.
    crossing : whether it crosses the inside between opposed walls.
    """

    length: FloatArray
    cost: FloatArray
    facing: BoolArray
    outside: BoolArray
    crossing: BoolArray

    @classmethod
    def of(cls, ends: IntArray, points: FloatArray, normals: FloatArray) -> _Chords:
        chord = points[ends[:, 1]] - points[ends[:, 0]]
        length = np.linalg.norm(chord, axis=1)
        chord /= length[:, None]
        here, there = normals[ends[:, 0]], normals[ends[:, 1]]
        rise, fall = np.einsum("ei,ei->e", chord, here), np.einsum("ei,ei->e", chord, there)
        cost = length * (2 - reflected_cosines(chord, here, there) + np.maximum(rise**2, fall**2))
        opposed = np.einsum("ei,ei->e", here, there) < 0
        return cls(length, cost, np.minimum(rise, -fall) > FACING, rise > fall, opposed & (fall - rise > CROSSING))


def _reaches(chords: _Chords, spacing: FloatArray) -> FloatArray:
    """(e,): how long the detour between the ends of an edge may be if it is to lie on the surface.

    `DETOUR` times its length, the fewer the more it costs beyond `POOR_COST`; `FACING_DETOUR` or `CROSSING_DETOUR`
    times between opposed walls; but for edges shorter than `CROTCH` spacings at least `CROTCH_DETOUR` spacings.

    spacing : (e,), mean distance to the next neighbours at the end where these are farther.
    """
    length = chords.length
    detour = DETOUR * np.minimum(1.0, POOR_COST * length / chords.cost)
    detour[chords.crossing] = np.minimum(detour[chords.crossing], CROSSING_DETOUR)
    detour[chords.facing] = FACING_DETOUR
    least = np.where(chords.facing & (length < CROTCH * spacing), CROTCH_DETOUR * spacing, 0.0)
    return np.asarray(np.maximum(detour * length, least))


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
