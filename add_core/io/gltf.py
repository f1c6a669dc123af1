"""glTF and GLB: the meshes of a scene become one, each placed where its node puts it.

glTF files are y up and in metres; coordinates are kept as the scene gives them. Vertices are neither merged nor
reordered, and several materials of one mesh share its vertices, as they do in the file.

Written by trimesh, but read here: trimesh visits the nodes in another order, repeats shared vertices, and takes
coordinates that are stored as differences for zeros.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from .._check import FloatArray, IntArray
from ..errors import ShapeFileError
from ..geometry import TriangleMesh
from .contents import Fields, FileContents, Shape, indices
from .gltf_buffers import Buffers, open_gltf

_POINTS, _TRIANGLES, _STRIP, _FAN = 0, 4, 5, 6
_NOT_GLTF = (AttributeError, LookupError, OverflowError, RecursionError, TypeError, ValueError)
"""What looking for things raises where they are missing or something else."""


def read(data: bytes, path: Path) -> FileContents:
    """The vertices and triangles of the scene, depth first in the order of its nodes, then of their primitives.

    Primitives of one mesh that share one list of vertices (as materials divide it) share it here, too. Lines are left
    out; points beside triangles are vertices without a face.
    """
    try:
        buffers = open_gltf(data, path)
        vertices: list[FloatArray] = []
        faces: list[IntArray] = []
        total = 0
        for transform, mesh in _placed_meshes(buffers.tree):
            start_of: dict[int, int] = {}
            for primitive in buffers.tree["meshes"][mesh]["primitives"]:
                accessor = primitive["attributes"]["POSITION"]
                if accessor not in start_of and primitive.get("mode", _TRIANGLES) in (
                    _POINTS,
                    _TRIANGLES,
                    _STRIP,
                    _FAN,
                ):
                    points = buffers.array(accessor, "VEC3").astype(np.float64)
                    start_of[accessor] = total
                    vertices.append(points @ transform[:3, :3].T + transform[:3, 3])
                    total += len(points)
                faces += [corners + start_of[accessor] for corners in _triangles(primitive, buffers, transform)]
    except ShapeFileError:
        raise
    except _NOT_GLTF as error:
        reason = " ".join(str(error).split())[:80].rstrip(".")
        raise ShapeFileError(
            f"is not a complete glTF file ({type(error).__name__}: {reason}). Is it damaged?"
        ) from None
    if not vertices:
        raise ShapeFileError("holds no meshes.")
    return FileContents(np.concatenate(vertices), np.concatenate(faces) if faces else None)


def write(shape: Shape, fields: Fields) -> bytes:
    """A GLB file: single precision, one node."""
    if not isinstance(shape, TriangleMesh):
        raise ShapeFileError("a GLB file holds triangles; few programs show its points. Choose PLY, OFF, XYZ or VTP.")
    from trimesh import Scene, Trimesh
    from trimesh.exchange.gltf import export_glb

    return bytes(export_glb(Scene({shape.name or "shape": Trimesh(shape.vertices, shape.faces, process=False)})))


def _placed_meshes(tree: dict[str, Any]) -> Iterator[tuple[FloatArray, int]]:
    """Each mesh of the scene with its (4, 4) transform; without a scene, all nodes that are nobody's children."""
    nodes = tree.get("nodes", [])
    if tree.get("scenes"):
        roots = tree["scenes"][tree.get("scene", 0)].get("nodes", [])
    else:
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [number for number in range(len(nodes)) if number not in children]
    waiting = [(number, np.eye(4)) for number in reversed(roots)]
    visits = 0
    while waiting:
        number, parent = waiting.pop()
        visits += 1
        if visits > len(nodes):
            raise ShapeFileError("has nodes that are their own ancestors. Is it damaged?")
        node = nodes[number]
        transform = parent @ _local_transform(node)
        if "mesh" in node:
            yield transform, node["mesh"]
        waiting += [(child, transform) for child in reversed(node.get("children", []))]


def _local_transform(node: dict[str, Any]) -> FloatArray:
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T  # stored by columns
    transform = np.eye(4)
    x, y, z, w = (float(part) for part in node.get("rotation", (0, 0, 0, 1)))
    transform[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    transform[:3, :3] *= np.array(node.get("scale", (1, 1, 1)), dtype=np.float64)
    transform[:3, 3] = node.get("translation", (0, 0, 0))
    return transform


def _triangles(primitive: dict[str, Any], buffers: Buffers, transform: FloatArray) -> list[IntArray]:
    """The triangles of a primitive, none if it is of points or lines, numbered within its own vertices."""
    mode = primitive.get("mode", _TRIANGLES)
    if mode not in (_TRIANGLES, _STRIP, _FAN):
        return []
    count = buffers.tree["accessors"][primitive["attributes"]["POSITION"]]["count"]
    corners = np.arange(count) if "indices" not in primitive else indices(buffers.array(primitive["indices"], "SCALAR"))
    if len(corners) and (corners.min() < 0 or corners.max() >= count):
        raise ShapeFileError(f"has a mesh of {count} vertices with a face that uses vertex {corners.max()}.")
    if mode == _TRIANGLES:
        faces = corners[: len(corners) // 3 * 3].reshape(-1, 3)
    elif mode == _STRIP:
        faces = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
        faces[1::2] = faces[1::2, ::-1]
    else:
        faces = np.stack([np.full(max(len(corners) - 2, 0), corners[0]), corners[1:-1], corners[2:]], axis=1)
    if np.linalg.det(transform[:3, :3]) < 0:
        faces = faces[:, ::-1]  # a mirrored node would turn the mesh inside out
    return [faces]
