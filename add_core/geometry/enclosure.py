"""What a cloud encloses: which Delaunay tetrahedra lie inside of its surface, and the normals of their border."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.csgraph import breadth_first_order, maximum_flow
from scipy.sparse.linalg import cg

from .._check import BoolArray, FloatArray, IntArray
from .tetrahedra import Tetrahedra

SHARPNESS, OPPOSITION = 8, 3.0
"""Power by which balls that meet in more than their skins count as one side; weight of the two sides of a point."""
SMOOTHNESS, ROUNDS = 0.01, 3
"""Weight of the border against the votes of the points, and how often these vote."""
_WHOLE = 10_000  # capacities are whole numbers: of a vote or facet of weight 1
_LEAST = 1e-3  # of a facet's weight: no border is for nothing


@dataclass(frozen=True, eq=False)
class Enclosure:
    """The border between what lies inside and outside of a surface through all points.

    normals : (n, 3), unit, outward. Of points that the border passes by, of the fuzzy border before the first vote.
    facets : (b, 3), the triangles of the border. radii : (b,), of the circles through their corners, and areas : (b,);
        in the unit of the points' extent.
    """

    normals: FloatArray
    facets: IntArray
    radii: FloatArray
    areas: FloatArray


def enclosure(tetrahedra: Tetrahedra) -> Enclosure:
    """Divide the Delaunay tetrahedra of a cloud into inside and outside.

    First every one is given a number between −1, outside, and 1 (Kolluri, Shewchuk, O'Brien 2004): the balls of
    neighbours are alike as far as they overlap, the largest balls on both sides of a point are opposites, and what lies
    outside the hull is −1. These numbers fade where sheets touch, but the way in which they rise is an inward normal
    for every point. Then the points vote for what lies in front and behind, and the border is where a minimum cut
    separates the votes along facets that lie on the skins of large balls (Labatut, Pons, Keriven 2009); its normals
    vote again.
    """
    normals = _border_normals(tetrahedra, _fuzzy_sides(tetrahedra))[0]
    for _ in range(ROUNDS):
        sides = _divided(tetrahedra, _votes(tetrahedra, normals))
        found, passed = _border_normals(tetrahedra, sides)
        normals = np.where(passed[:, None], normals, found)
    facets = tetrahedra.facets
    border = _jumps(tetrahedra, sides) != 0
    return Enclosure(normals, facets.corners[border], facets.radii[border], facets.areas[border])


def _fuzzy_sides(tetrahedra: Tetrahedra) -> FloatArray:
    """(t,): between −1 outside and 1 inside."""
    count = len(tetrahedra.corners)
    one, other = tetrahedra.facets.sides.T
    alike = np.clip(1 - tetrahedra.facets.sinking.min(axis=1), _LEAST, 1) ** SHARPNESS
    alike = np.where(other < 0, np.clip(1 - tetrahedra.facets.sinking[:, 0], _LEAST, 1) ** SHARPNESS, alike)
    near, far, against = _poles(tetrahedra)
    rows, columns = np.concatenate([one, near]), np.concatenate([other, far])
    links = np.concatenate([-alike, against])
    weight = np.abs(links)
    known = columns < 0
    diagonal = np.bincount(rows, weight, count) + np.bincount(columns[~known], weight[~known], count) + 1e-9
    outside = np.bincount(rows[known], links[known], count)
    i, j, link = rows[~known], columns[~known], links[~known]
    system = csr_array(coo_array((np.r_[link, link], (np.r_[i, j], np.r_[j, i])), shape=(count, count)))
    system = csr_array(system + diags_array(diagonal))
    found = cg(system, outside, rtol=1e-6, maxiter=1000, M=diags_array(1 / diagonal))[0]
    return np.asarray(found, dtype=np.float64)


def _poles(tetrahedra: Tetrahedra) -> tuple[IntArray, IntArray, FloatArray]:
    """The largest ball at every point, −1 where its direction is out of the hull, as the second of three arrays; the
    first is the largest that lies the other way, the third how much they are opposites. Points without are left out."""
    points, place = len(tetrahedra.points), tetrahedra.corners.ravel()
    ball = np.repeat(np.arange(len(tetrahedra.corners)), 4)
    direction = tetrahedra.directions.reshape(-1, 3)
    order = np.argsort(np.where(tetrahedra.solid, tetrahedra.radii, 0.0)[ball], kind="stable")
    largest = np.zeros(points, dtype=np.int64)
    largest[place[order]] = order  # the last one stays
    outward, on_hull = _hull_normals(tetrahedra)
    first = np.where(on_hull[:, None], outward, direction[largest])
    order = order[np.einsum("ti,ti->t", direction[order], first[place[order]]) < 0]
    opposite = np.full(points, -1)
    opposite[place[order]] = order
    has = opposite >= 0
    cosine = np.einsum("ni,ni->n", first[has], direction[opposite[has]])
    far = np.where(on_hull, -1, ball[largest])[has]
    return ball[opposite[has]], far, OPPOSITION * np.abs(cosine) ** 4


def _hull_normals(tetrahedra: Tetrahedra) -> tuple[FloatArray, BoolArray]:
    facets = tetrahedra.facets
    hull = facets.sides[:, 1] < 0
    total = np.zeros_like(tetrahedra.points)
    np.add.at(total, facets.corners[hull], facets.upright[hull, None, :])
    length = np.linalg.norm(total, axis=1)
    return total / np.maximum(length, np.finfo(float).tiny)[:, None], length > 0


def _votes(tetrahedra: Tetrahedra, normals: FloatArray) -> FloatArray:
    """(t,): for inside, below 0 for outside: how far its ball lies behind each corner, as large as it looks there."""
    ahead = np.einsum("tci,tci->tc", tetrahedra.directions, normals[tetrahedra.corners])
    return np.asarray(-(ahead * tetrahedra.shares).sum(axis=1))


def _divided(tetrahedra: Tetrahedra, votes: FloatArray) -> FloatArray:
    """(t,): 1 inside, −1 outside, by a minimum cut."""
    count = len(votes)
    one, other = tetrahedra.facets.sides.T
    weight = SMOOTHNESS * np.clip(1 - tetrahedra.facets.sinking.min(axis=1), _LEAST, 1) ** 2
    source, sink = count, count + 1
    other = np.where(other < 0, sink, other)
    every = np.arange(count)
    rows = np.concatenate([one, other, np.full(count, source), every])
    columns = np.concatenate([other, one, every, np.full(count, sink)])
    capacity = np.concatenate([weight, weight, np.maximum(votes, 0), np.maximum(-votes, 0)])
    whole = np.round(_WHOLE * capacity).astype(np.int32)
    usable = (whole > 0) & (rows != sink)
    graph = csr_array(coo_array((whole[usable], (rows[usable], columns[usable])), shape=(count + 2, count + 2)))
    rest = csr_array(graph - maximum_flow(graph, source, sink).flow)
    rest.data = np.maximum(rest.data, 0)
    rest.eliminate_zeros()
    reached = breadth_first_order(rest, source, return_predecessors=False)
    sides = np.full(count, -1.0)
    sides[reached[reached < count]] = 1.0
    return sides


def _jumps(tetrahedra: Tetrahedra, sides: FloatArray) -> FloatArray:
    """(f,): by how much a tetrahedron before a facet lies farther inside than the one behind it."""
    all_sides = np.append(sides, -1.0)[tetrahedra.facets.sides]
    return np.asarray((all_sides[:, 0] - all_sides[:, 1]) / 2)


def _border_normals(tetrahedra: Tetrahedra, sides: FloatArray) -> tuple[FloatArray, BoolArray]:
    """(n, 3), unit: outward normals of the facets around each point, by angle, as far as `sides` change there; (n,):
    whether nothing changes, so that they are 0."""
    facets = tetrahedra.facets
    jumps = _jumps(tetrahedra, sides)
    border = np.flatnonzero(jumps)
    total = np.zeros_like(tetrahedra.points)
    leaning = jumps[border, None] * facets.upright[border]
    np.add.at(total, facets.corners[border], facets.angles[border, :, None] * leaning[:, None, :])
    length = np.linalg.norm(total, axis=1)
    return total / np.maximum(length, np.finfo(float).tiny)[:, None], length == 0
