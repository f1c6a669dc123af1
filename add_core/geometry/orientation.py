"""Which way the faces of a mesh are turned: with their neighbours, and outward."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from .._check import BoolArray, IntArray
from .mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class Orientation:
    """What it takes to turn all faces of a mesh the same way.

    turned : (m,) bool, faces to turn so that neighbours agree and closed pieces face outward. Of an open piece the
        fewer faces are turned; of a piece that has no two sides, such as a Möbius strip, none.
    disagreeing : (m,) bool, the faces to turn so that neighbours agree, ever the fewer of a piece.
    inward : (m,) bool, faces of closed pieces that enclose a negative volume once their faces agree.
    one_sided : (m,) bool, faces of pieces that cannot be oriented.
    """

    turned: BoolArray
    disagreeing: BoolArray
    inward: BoolArray
    one_sided: BoolArray


def orientation(mesh: TriangleMesh) -> Orientation:
    """How the faces of `mesh` are turned. Edges of exactly two faces join pieces; others say nothing about sides."""
    m = len(mesh.faces)
    first, second, agree = _neighbours(mesh)
    # Every face stands twice in a graph, as it is and turned. Neighbours that agree are linked as they are, others
    # crosswise; a consistent choice for a piece is then one connected component.
    a = np.concatenate([first, first + m])
    b = np.concatenate([np.where(agree, second, second + m), np.where(agree, second + m, second)])
    labels = connected_components(
        coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(2 * m, 2 * m)), directed=False
    )[1]
    kept, flipped = labels[:m], labels[m:]
    piece = np.minimum(kept, flipped)  # the same for all faces of a piece, whichever way they are turned
    one_sided = kept == flipped
    minority = (kept != piece).astype(np.int64)
    share = np.bincount(piece, minority) / np.maximum(np.bincount(piece), 1)
    disagreeing = np.where(share[piece] > 0.5, minority == 0, minority == 1) & ~one_sided
    inward = _inward(mesh, disagreeing, piece) & ~one_sided
    return Orientation(disagreeing ^ inward, disagreeing, inward, one_sided)


def _neighbours(mesh: TriangleMesh) -> tuple[IntArray, IntArray, BoolArray]:
    """Faces on both sides of every edge of exactly two, and whether they run through it in opposite directions."""
    m = len(mesh.faces)
    half = mesh.faces[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2)
    face = np.repeat(np.arange(m), 3)
    low, high = np.sort(half, axis=1).T
    key = low * mesh.vertex_count + high
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=-1))
    lengths = np.diff(starts, append=len(order))
    pairs = starts[(lengths == 2)]
    one, two = order[pairs], order[pairs + 1]
    return face[one], face[two], half[one, 0] != half[two, 0]


def _inward(mesh: TriangleMesh, disagreeing: BoolArray, piece: IntArray) -> BoolArray:
    """(m,): whether the piece of each face is closed and encloses a negative volume after turning `disagreeing`."""
    counts = np.bincount(piece)
    centre = np.zeros((len(counts), 3))
    corners = mesh.vertices[mesh.faces]
    np.add.at(centre, piece, corners.mean(axis=1))
    corners = (
        corners - (centre / np.maximum(counts, 1)[:, None])[piece][:, None]
    )  # volumes far from the origin lose digits
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    signed = np.bincount(piece, np.where(disagreeing, -volume, volume))
    half = np.sort(mesh.faces[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2), axis=1)
    _, edge, faces_at = np.unique(half, axis=0, return_inverse=True, return_counts=True)
    closed = np.bincount(np.repeat(piece, 3), faces_at[edge] != 2) == 0
    inside_out: BoolArray = (closed & (signed < 0))[piece]
    return inside_out
