"""The graph of chords of a point cloud: what paths over its surface follow in place of faces."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from .._check import FloatArray, IntArray
from .cloud import PointCloud
from .distinct import sorted_distinct


def chord_graph(cloud: PointCloud) -> csr_array:
    """(n, n): lengths of the chords that paths may take, to be read as undirected.

    Chords join points that hold each other in their fans, and points two or three such steps apart on one piece of
    surface (single steps would zigzag). What only one of two fans claims may bridge a gap, which a shortest path
    would not miss: it counts only where nothing else joins two pieces. Points in one place are joined by edges of
    length 0, stored as such.
    """
    n, first, place = cloud.vertex_count, cloud.distinct.first, cloud.distinct.place
    corners = place[cloud.fans.triangles]
    claimed = _pattern(np.repeat(corners[:, 0], 2), corners[:, 1:].ravel(), len(first))
    held = claimed.multiply(claimed.T).tocsr()
    neighbours = cloud.tangent_planes.nearest.indices
    centre, column = np.nonzero(cloud.tangent_planes.on_surface)
    seen = _pattern(centre, neighbours[centre, column], len(first))
    chords = (held + (held @ held + held @ held @ held).multiply(seen + seen.T)).tocoo()
    piece = connected_components(chords, directed=False)[1]
    loose = claimed.tocoo()
    joins = piece[loose.row] != piece[loose.col]
    doubled = np.flatnonzero(first[place] != np.arange(n))
    i = np.concatenate([first[chords.row], first[loose.row[joins]], doubled])
    j = np.concatenate([first[chords.col], first[loose.col[joins]], first[place[doubled]]])
    low, high = np.minimum(i, j), np.maximum(i, j)
    _, once = np.unique(low * n + high, return_index=True)
    low, high = low[once], high[once]
    lengths = np.linalg.norm(cloud.points[low] - cloud.points[high], axis=1)
    return csr_array(coo_array((lengths, (low, high)), shape=(n, n)))


def _pattern(rows: IntArray, columns: IntArray, count: int) -> csr_array:
    """(count, count): 1 at the given places."""
    entries = sorted_distinct(rows * count + columns)
    return csr_array(coo_array((np.ones(len(entries)), (entries // count, entries % count)), shape=(count, count)))


def chord_distances(cloud: PointCloud, sources: IntArray) -> FloatArray:
    """(len(sources), n): lengths of the shortest paths along chords; inf between pieces that no chord joins."""
    return np.asarray(dijkstra(chord_graph(cloud), directed=False, indices=sources))
