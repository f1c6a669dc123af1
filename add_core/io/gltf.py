"""glTF and GLB through trimesh: a scene of meshes becomes one, each placed where its node puts it.

glTF files are y up and in metres; coordinates are kept as the scene gives them.
"""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ShapeFileError
from ..geometry import TriangleMesh
from .contents import Fields, FileContents, Shape

_UNREADABLE = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    LookupError,
    MemoryError,
    NameError,
    NotImplementedError,
    OSError,
    RecursionError,
    TypeError,
    ValueError,
)
"""What trimesh and its imports raise on files that are not what they claim."""


def read(data: bytes, path: Path) -> FileContents:
    """The vertices and triangles of all meshes, in the order of the scene's nodes.

    Pieces of one mesh that share one list of vertices (as materials divide it) share it here, too.
    """
    _check_claims(data)
    try:
        import trimesh

        kind = "glb" if data[:4] == b"glTF" else "gltf"
        resolver = trimesh.resolvers.FilePathResolver(str(path))
        scene = trimesh.load_scene(io.BytesIO(data), file_type=kind, resolver=resolver, process=False)
        pieces = [_placed(scene, node) for node in scene.graph.nodes_geometry]
    except _UNREADABLE as error:
        reason = " ".join(str(error).split())[:160].rstrip(".")
        raise ShapeFileError(f"is not a readable glTF file ({type(error).__name__}: {reason}).") from None
    return _joined(pieces)


def write(shape: Shape, fields: Fields) -> bytes:
    """A GLB file: single precision."""
    if not isinstance(shape, TriangleMesh):
        raise ShapeFileError("a GLB file holds triangles; viewers rarely show its points. Choose PLY, OFF, XYZ or VTP.")
    import trimesh

    mesh = trimesh.Trimesh(shape.vertices, shape.faces, process=False)
    return bytes(mesh.export(file_type="glb"))


def _placed(scene: Any, node: str) -> tuple[np.ndarray, np.ndarray | None]:
    transform, name = scene.graph[node]
    geometry = scene.geometry[name]
    points = np.asarray(geometry.vertices, dtype=np.float64)
    if not np.array_equal(transform, np.eye(4)):
        points = points @ transform[:3, :3].T + transform[:3, 3]
    faces = getattr(geometry, "faces", None)
    if faces is not None and np.linalg.det(transform[:3, :3]) < 0:
        faces = faces[:, ::-1]  # a mirrored node would turn the mesh inside out
    return points, None if faces is None else np.asarray(faces, dtype=np.int64)


def _joined(pieces: list[tuple[np.ndarray, np.ndarray | None]]) -> FileContents:
    if any(faces is not None for _, faces in pieces):
        pieces = [piece for piece in pieces if piece[1] is not None]  # lines and points beside meshes are decoration
    if not pieces:
        raise ShapeFileError("holds no meshes.")
    vertices: list[np.ndarray] = []
    faces: list[np.ndarray] = []
    start = total = 0
    for points, corners in pieces:
        if not vertices or not np.array_equal(points, vertices[-1]):
            start = total
            vertices.append(points)
            total += len(points)
        if corners is not None:
            faces.append(corners + start)
    return FileContents(np.concatenate(vertices), np.concatenate(faces) if faces else None)


def _check_claims(data: bytes) -> None:
    """Accessors that claim more numbers than a file of this size can hold would be allocated as zeros."""
    text = data
    if data[:4] == b"glTF":
        length = int.from_bytes(data[12:16], "little")
        text = data[20 : 20 + length]
        if len(data) < 20 or int.from_bytes(data[8:12], "little") > len(data):
            raise ShapeFileError(
                f"claims {int.from_bytes(data[8:12], 'little')} bytes, but has {len(data)}. Is it cut off?"
            )
    try:
        tree = json.loads(text)
        accessors = tree.get("accessors", [])
        claims = [accessor["count"] for accessor in accessors if "bufferView" not in accessor]
        compressed = {"KHR_draco_mesh_compression", "EXT_meshopt_compression"} & set(tree.get("extensionsRequired", []))
    except (ValueError, AttributeError, KeyError, TypeError, RecursionError):
        raise ShapeFileError("has no readable glTF description. Is it damaged?") from None
    if compressed:
        raise ShapeFileError(f"is compressed with {sorted(compressed)[0]}. Export it without compression.")
    if any(not isinstance(claim, int) or claim > len(data) for claim in claims):
        raise ShapeFileError(f"claims more values than its {len(data)} bytes can hold. Is it damaged?")
