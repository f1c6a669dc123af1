"""glTF scenes: nodes in order, transforms, shared vertices, and every way of keeping the numbers."""

import base64
import json
import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ShapeFileError
from add_core.geometry import TriangleMesh
from add_core.io import load_shape


@pytest.fixture
def awkward() -> TriangleMesh:
    """Vertex 0 and 6 in no face, 5 at the place of 1, 4 used before 2, and one face without area."""
    vertices = np.random.default_rng(1).normal(size=(8, 3))
    vertices[5] = vertices[1]
    return TriangleMesh(vertices, [[7, 4, 1], [1, 4, 2], [2, 4, 5], [3, 1, 5]], "awkward")


def _gltf(positions: np.ndarray, materials: list[list[int]], nodes: list[dict]) -> tuple[dict, bytes]:
    """A scene whose only mesh is one list of vertices with a list of corners for each of its materials."""
    parts = [positions.astype("<f4").tobytes(), *(np.array(corners, "<u4").tobytes() for corners in materials)]
    starts = np.cumsum([0] + [len(part) for part in parts]).tolist()
    views = [{"buffer": 0, "byteOffset": at, "byteLength": len(part)} for at, part in zip(starts, parts, strict=False)]
    accessors = [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3"}]
    for number, corners in enumerate(materials, start=1):
        accessors.append({"bufferView": number, "componentType": 5125, "count": len(corners), "type": "SCALAR"})
    primitives = [{"attributes": {"POSITION": 0}, "indices": k} for k in range(1, len(materials) + 1)]
    tree = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": [{"primitives": primitives}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": starts[-1]}],
    }
    return tree, b"".join(parts)


def _write_gltf(folder, kind: str, tree: dict, blob: bytes):
    path = folder / f"a.{'glb' if kind == 'glb' else 'gltf'}"
    if kind == "glb":
        text = json.dumps(tree).encode()
        text += b" " * (-len(text) % 4)
        body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(blob), b"BIN\0") + blob
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body)
        return path
    (folder / "numbers 1.bin").write_bytes(blob)
    within = "data:application/octet-stream;base64," + base64.b64encode(blob).decode()
    tree["buffers"][0]["uri"] = within if kind == "within" else "numbers%201.bin"
    path.write_text(json.dumps(tree))
    return path


@pytest.mark.parametrize("kind", ["glb", "beside", "within"])
def test_gltf_meshes_are_placed_by_their_nodes_in_order(awkward, tmp_path, kind):
    half = np.sqrt(0.5)
    nodes = [
        {"children": [2, 1], "translation": [1, 2, 3]},
        {"mesh": 0, "scale": [-1, 1, 1]},
        {"mesh": 0, "rotation": [0, 0, half, half], "children": [3]},
        {"mesh": 0, "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 5, 1]},
    ]
    corners = awkward.faces.ravel().tolist()
    mesh = load_shape(_write_gltf(tmp_path, kind, *_gltf(awkward.vertices, [corners[:6], corners[6:]], nodes)))
    assert mesh.vertex_count == 24  # one list of vertices for both materials, three times
    x, y, z = awkward.vertices.T
    assert_allclose(mesh.vertices[:8], np.stack([1 - y, 2 + x, 3 + z], axis=1), atol=1e-6)
    assert_allclose(mesh.vertices[8:16], np.stack([1 - 2 * y, 2 + 2 * x, 3 + 2 * z + 5], axis=1), atol=1e-6)
    assert_allclose(mesh.vertices[16:], np.stack([1 - x, 2 + y, 3 + z], axis=1), atol=1e-6)
    assert_array_equal(mesh.faces[:8], np.concatenate([awkward.faces, awkward.faces + 8]))
    # The mirrored node turns its faces, so that outside stays outside.
    assert_allclose(mesh.face_normals[8:11], awkward.face_normals[:3] * [-1, 1, 1], atol=1e-5)


@pytest.mark.parametrize(
    ("mode", "faces"), [(5, [[0, 1, 2], [3, 2, 1], [2, 3, 4]]), (6, [[0, 1, 2], [0, 2, 3], [0, 3, 4]])]
)
def test_gltf_strips_and_fans(awkward, tmp_path, mode, faces):
    tree, blob = _gltf(awkward.vertices, [[0, 1, 2, 3, 4]], [{"mesh": 0}])
    tree["meshes"][0]["primitives"][0]["mode"] = mode
    assert_array_equal(load_shape(_write_gltf(tmp_path, "glb", tree, blob)).faces, faces)


@pytest.mark.parametrize(
    ("spoil", "complaint"),
    [
        (lambda tree: tree["nodes"][0].update(children=[0]), "nodes that are their own ancestors"),
        (lambda tree: tree["accessors"][0].update(count=10**12), "claims 1000000000000 rows of numbers"),
        (lambda tree: tree["accessors"][0].pop("bufferView"), "stores vertices as differences"),
        (lambda tree: tree.update(extensionsRequired=["KHR_draco_mesh_compression"]), "is compressed by KHR_draco"),
        (lambda tree: tree["buffers"][0].update(uri="../secret.bin"), "outside its own folder"),
        (lambda tree: tree["buffers"][0].update(uri="missing.bin"), "'missing.bin', which cannot be read"),
        (lambda tree: tree.pop("accessors"), r"not a complete glTF file \(KeyError: 'accessors'\)"),
        (lambda tree: tree["scenes"][0].update(nodes=[]), "holds no meshes"),
    ],
)
def test_gltf_that_cannot_be_read_is_explained(awkward, tmp_path, spoil, complaint):
    tree, blob = _gltf(awkward.vertices, [[0, 1, 2]], [{"mesh": 0}])
    spoil(tree)
    with pytest.raises(ShapeFileError, match=complaint):
        load_shape(_write_gltf(tmp_path, "glb", tree, blob))
