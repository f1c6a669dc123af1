"""The mirror map of a mesh whose triangles are symmetric, found from one symmetric pose."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from .._check import FloatArray, IntArray, instance_of, read_only
from .mesh import TriangleMesh

_SEEDS = 20
"""How many faces are tried for each plane; the first nearly always leads to the map or shows that there is none."""


def mirror_map(mesh: TriangleMesh) -> IntArray | None:
    """(n,): the vertex that mirrors each vertex, its own inverse; None if the triangles have no such symmetry.

    mesh : in a pose that is symmetric about some plane, not necessarily exactly: the pose only says where to begin.
        From there the map is followed from triangle to triangle, so that it is exact, and holds for every pose.
    The plane is sought across the principal axes and the coordinate axes. Vertices without a face map to themselves.
    Raises ParameterError for what is no mesh; the vertices of a cloud have no triangles to follow.
    """
    instance_of("mesh", mesh, TriangleMesh)
    opposite = _opposite_corners(mesh)
    for guess in _reflections(mesh):
        found = _follow(mesh, opposite, guess)
        if found is not None and (found[found] == np.arange(len(found))).all():
            return read_only(found)
    return None


def _opposite_corners(mesh: TriangleMesh) -> dict[tuple[int, int], int]:
    """The third corner of the face that runs from one vertex to another."""
    faces = mesh.faces.tolist()
    return {edge: corner for a, b, c in faces for edge, corner in (((a, b), c), ((b, c), a), ((c, a), b))}


def _reflections(mesh: TriangleMesh) -> list[IntArray]:
    """(n,) for each plane: the vertex nearest to the mirror image of each vertex; best plane first."""
    weight = mesh.vertex_areas if mesh.has_mass.any() else np.ones(mesh.vertex_count)
    weight = weight / weight.sum()
    centred = mesh.vertices - weight @ mesh.vertices
    _, axes = np.linalg.eigh((centred * weight[:, None]).T @ centred)
    tree = cKDTree(centred)
    guesses: list[tuple[float, IntArray]] = []
    for normal in np.concatenate([axes.T, np.eye(3)]):
        image: FloatArray = centred - 2.0 * np.outer(centred @ normal, normal)
        distance, nearest = tree.query(image)
        guesses.append((float(weight @ distance), np.asarray(nearest, dtype=np.int64)))
    return [nearest for _, nearest in sorted(guesses, key=lambda pair: pair[0])]


def _follow(mesh: TriangleMesh, opposite: dict[tuple[int, int], int], guess: IntArray) -> IntArray | None:
    """The map that begins at some face of each component as `guess` says; None if none fits the triangles."""
    result = np.full(mesh.vertex_count, -1, dtype=np.int64)
    result[~mesh.is_referenced] = np.flatnonzero(~mesh.is_referenced)
    begins = [face for face in mesh.faces.tolist() if _is_mirrored(face, guess, opposite)]
    for label in np.unique(mesh.component_labels[mesh.is_referenced]):
        own = [face for face in begins if mesh.component_labels[face[0]] == label]
        for face in own[:: max(len(own) // _SEEDS, 1)]:
            part = _propagated(face, guess, opposite)
            if part is not None:
                result[list(part)] = list(part.values())
                break
        else:
            return None
    return result


def _is_mirrored(face: list[int], guess: IntArray, opposite: dict[tuple[int, int], int]) -> bool:
    a, b, c = (int(guess[corner]) for corner in face)
    return opposite.get((b, a)) == c


def _propagated(face: list[int], guess: IntArray, opposite: dict[tuple[int, int], int]) -> dict[int, int] | None:
    """Every vertex that triangles lead to from `face`, and its mirror image; None where two ways disagree.

    A mirror turns triangles over: what lies left of the edge a → b lies left of b' → a'.
    """
    image = {corner: int(guess[corner]) for corner in face}
    waiting = [(face[1], face[0]), (face[2], face[1]), (face[0], face[2])]
    seen: set[tuple[int, int]] = set()
    while waiting:
        a, b = waiting.pop()
        if (a, b) in seen:
            continue
        seen.add((a, b))
        corner, mirrored = opposite.get((a, b)), opposite.get((image[b], image[a]))
        if corner is None and mirrored is None:
            continue  # both sides end here
        if corner is None or mirrored is None or image.setdefault(corner, mirrored) != mirrored:
            return None
        seen |= {(b, corner), (corner, a)}
        waiting += [(corner, b), (a, corner)]
    return image
