"""Middles of edges as further places: meshes that were made anew then share many more exact places."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._check import IntArray, read_only
from ..geometry import TriangleMesh


@dataclass(frozen=True, eq=False)
class Middles:
    """Places of the n vertices of a connectivity, and after them those of the middles of its e edges.

    places : (e,), n to n + e − 1, in the order of `TriangleMesh.edges`. symmetry : (n + e,), the place that mirrors
        each place, −1 for a middle whose edge has no mirror image; None without a symmetry.
    """

    places: IntArray
    symmetry: IntArray | None

    @classmethod
    def of(cls, mesh: TriangleMesh, symmetry: IntArray | None = None) -> Middles:
        """Places of a mesh and of all others with the same faces; symmetry : (n,), the vertex that mirrors each."""
        n, edges = mesh.vertex_count, mesh.edges
        places = read_only(n + np.arange(len(edges)))
        if symmetry is None:
            return cls(places, None)
        key, mirrored = _keys(edges, n), _keys(np.asarray(symmetry)[edges], n)
        order = np.argsort(key)
        position = np.minimum(np.searchsorted(key[order], mirrored), len(edges) - 1)
        row = order[position]
        return cls(places, read_only(np.concatenate([symmetry, np.where(key[row] == mirrored, n + row, -1)])))


def _keys(edges: IntArray, count: int) -> IntArray:
    return np.asarray(edges.min(axis=1) * count + edges.max(axis=1))
