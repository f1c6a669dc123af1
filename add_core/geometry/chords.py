"""The graph of chords of a point cloud: what paths over its surface follow in place of faces."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from .._check import FloatArray, IntArray
from .cloud import PointCloud


def chord_graph(cloud: PointCloud) -> csr_array:
    """(n, n): lengths of the chords between neighbours on one piece of surface, to be read as undirected.

    Chords across a limb or a gap are left out, as they are from the fans, so that no path jumps between parts that
    face each other. Points in one place are joined by edges of length 0, stored as such.
    """
    planes, first = cloud.tangent_planes, cloud.distinct.first
    centre, column = np.nonzero(planes.on_surface)
    sides = cloud.fans.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    doubled = np.flatnonzero(first[cloud.distinct.place] != np.arange(cloud.vertex_count))
    i = np.concatenate([first[centre], sides[:, 0], doubled])
    j = np.concatenate(
        [first[planes.nearest.indices[centre, column]], sides[:, 1], first[cloud.distinct.place[doubled]]]
    )
    low, high = np.minimum(i, j), np.maximum(i, j)
    _, once = np.unique(low * cloud.vertex_count + high, return_index=True)
    low, high = low[once], high[once]
    lengths = np.linalg.norm(cloud.points[low] - cloud.points[high], axis=1)
    return csr_array(coo_array((lengths, (low, high)), shape=(cloud.vertex_count,) * 2))


def chord_distances(cloud: PointCloud, sources: IntArray) -> FloatArray:
    """(len(sources), n): lengths of the shortest paths along chords; inf between pieces that no chord joins."""
    return np.asarray(dijkstra(chord_graph(cloud), directed=False, indices=sources))
