"""Quadric decimation that keeps a mirror-symmetric mesh symmetric and only chooses among its vertices."""

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree


def compacted(faces, mirror):
    """The vertices that `faces` use, and faces and mirror map in their numbers."""
    used = np.unique(faces)
    number = np.full(len(mirror), -1)
    number[used] = np.arange(len(used))
    return used, number[faces], number[mirror[used]]


def mirrored(half, mirror):
    """Faces of one half together with their mirror images, turned so that all face the same way."""
    return np.concatenate([half, mirror[half][:, ::-1]])


def decimate(vertices, faces, mirror, count, *, axis):
    """About `count` of `vertices`: (chosen numbers, faces among them, their mirror map).

    vertices : (n, 3), symmetric about the plane where coordinate `axis` is 0; no face may cross it.
    One half is decimated with its rim, the mid-plane, kept in place, and then mirrored. The number of faces that gives
    `count` vertices is searched by bisection.
    """
    own = mirror == np.arange(len(mirror))
    side = np.where(own, 0.0, np.sign(vertices[:, axis]))[faces]
    if ((side > 0).any(axis=1) & (side < 0).any(axis=1)).any():
        raise ValueError("faces cross the mid-plane; triangulate one half and mirror it first")
    half = faces[side.sum(axis=1) > 0]
    in_half, half_faces, _ = compacted(half, mirror)
    tree = cKDTree(vertices[in_half])

    def attempt(face_count):
        kept, corners = _collapsed(vertices[in_half], half_faces, face_count)
        distance, nearest = tree.query(kept)
        if distance.max() > 1e-6:
            raise RuntimeError("decimation moved a vertex")
        chosen = in_half[nearest]
        return chosen[corners], 2 * len(chosen) - int(own[chosen].sum())

    low, high = count // 4, len(half)
    while high - low > 1:
        middle = (low + high) // 2
        corners, reached = attempt(middle)
        if reached == count:
            break
        low, high = (low, middle) if reached > count else (middle, high)
    return compacted(mirrored(corners, mirror), mirror)


def _collapsed(vertices, faces, face_count):
    """Quadric edge collapse that leaves every surviving vertex where it was."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    meshes.meshing_decimation_quadric_edge_collapse(
        targetfacenum=int(face_count),
        qualitythr=0.5,
        preserveboundary=True,
        boundaryweight=100.0,
        preservenormal=True,
        preservetopology=True,
        optimalplacement=False,
        planarquadric=True,
        planarweight=0.001,
        autoclean=False,
    )
    points, corners = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()
    used = np.unique(corners)
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    return points[used], number[corners]
