"""Remesh every shape of a collection on its own, with ground truth.

`python build_remeshed.py COLLECTION.npz OUTPUT.npz [COUNT]`. Shapes of one connectivity flatter every method; these
share none. For every new vertex the file holds where it lies on the original: its face there, barycentric coordinates,
and the nearest of that face's corners.
"""

import sys

import igl
import numpy as np
import pymeshlab
import quantised


def remesh(vertices, faces, count):
    """About `count` vertices, evenly spread, near-equilateral faces."""
    corners = vertices[faces]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    length = 0.96 * np.sqrt(area / count * 2 / np.sqrt(3))
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    meshes.meshing_isotropic_explicit_remeshing(
        iterations=8, targetlen=pymeshlab.PureValue(length), featuredeg=60, checksurfdist=False
    )
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def place_on(points, vertices, faces):
    """(face, barycentric coordinates) of the point of the original that is nearest to each of `points`."""
    _, face, nearest = igl.point_mesh_squared_distance(points, vertices, faces)[:3]
    a, b, c = np.moveaxis(vertices[faces[face]], 1, 0)
    normal = np.cross(b - a, c - a)
    scale = (normal * normal).sum(axis=1)
    u = (np.cross(b - nearest, c - nearest) * normal).sum(axis=1) / scale
    v = (np.cross(c - nearest, a - nearest) * normal).sum(axis=1) / scale
    share = np.clip(np.stack([u, v, 1 - u - v], axis=1), 0, 1)
    return face, share / share.sum(axis=1, keepdims=True)


def main():
    source, target = sys.argv[1:3]
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 5000
    vertices, faces, _, subjects, poses = quantised.load(source)
    parts = {name: [] for name in ("vertices", "faces", "original_face", "original_share", "original_vertex")}
    for shape in vertices:
        points, triangles = remesh(shape, faces, count)
        face, share = place_on(points, shape, faces)
        parts["vertices"].append(points.astype(np.float32))
        parts["faces"].append(triangles.astype(np.int32))
        parts["original_face"].append(face.astype(np.int32))
        parts["original_share"].append(share.astype(np.float32))
        parts["original_vertex"].append(faces[face, share.argmax(axis=1)].astype(np.int32))
    starts = {f"{name}_start": np.cumsum([0] + [len(part) for part in parts[name]]) for name in ("vertices", "faces")}
    joined = {name: np.concatenate(part) for name, part in parts.items()}
    np.savez_compressed(target, subject=subjects, pose=poses, **joined, **starts)
    sizes = [len(part) for part in parts["vertices"]]
    print(f"{target}: {len(vertices)} shapes of {min(sizes):,} to {max(sizes):,} vertices")


if __name__ == "__main__":
    main()
