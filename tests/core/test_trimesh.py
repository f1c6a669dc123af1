"""What trimesh does not keep of a file, which is why some formats are read or written without it.

When one of these tests fails, trimesh has learnt it: use it there, too.
"""

import io
import json
import struct

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_array_equal
from trimesh.exchange.gltf import export_glb
from trimesh.exchange.obj import load_obj
from trimesh.exchange.off import load_off
from trimesh.exchange.ply import load_ply
from trimesh.exchange.xyz import load_xyz

CORNER = "v 0 0 0\nv 1 0 0\nv 1 1 0\n"


def _faces_of_obj(text: str) -> tuple[np.ndarray, np.ndarray]:
    loaded = load_obj(io.StringIO(text), maintain_order=True, group_material=False, skip_materials=True)
    (mesh,) = loaded["geometry"].values()
    return mesh["vertices"], mesh["faces"]


def test_obj_loses_unreferenced_vertices_beside_texture_coordinates():
    vertices, _ = _faces_of_obj(CORNER + "v 9 9 9\nvt 0 0\nf 1/1 2/1 3/1\n")
    assert len(vertices) == 3


def test_obj_counts_relative_numbers_from_the_end_of_the_file():
    _, faces = _faces_of_obj(CORNER + "f -3 -2 -1\nv 5 5 5\nv 6 6 6\nv 7 7 7\n")
    assert_array_equal(faces, [[3, 4, 5]])


def test_obj_takes_vertex_0_for_vertex_1():
    _, faces = _faces_of_obj(CORNER + "f 0 2 3\n")
    assert_array_equal(faces, [[0, 1, 2]])


def test_binary_ply_may_not_mix_triangles_with_quads():
    header = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    )
    corners = b"".join(bytes([len(face)]) + np.array(face, "<i4").tobytes() for face in ([0, 1, 2, 3], [0, 1, 2]))
    with pytest.raises(ValueError, match="unexpected length"):
        load_ply(io.BytesIO(header.encode() + bytes(48) + corners))


def test_a_ply_text_that_is_cut_off_becomes_a_smaller_shape():
    header = (
        "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    )
    assert len(load_ply(io.BytesIO(header.encode() + b"0 0 0\n1 0 0\n"))["vertices"]) == 2


def test_xyz_takes_normals_for_colours():
    loaded = load_xyz(io.StringIO("0 0 0 0 0.6 0.8\n1 0 0 0 0 1\n"))
    assert_array_equal(loaded["colors"][:, :3], [[0, 0, 0], [0, 0, 1]])


def test_off_reads_the_lines_before_a_comment_twice():
    """Here the counts become the first vertex, so comments are taken out before."""
    loaded = load_off(io.StringIO("OFF\n3 1 0 # counts\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"))
    assert_array_equal(loaded["vertices"], [[3, 1, 0], [0, 0, 0], [1, 0, 0]])


def test_off_fails_on_triangles_with_pentagons_and_loses_faces_of_two():
    points = "0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 2 0\n"
    with pytest.raises(TypeError, match="string"):
        load_off(io.StringIO(f"OFF\n5 2 0\n{points}5 0 1 2 3 4\n3 0 1 2\n"))
    assert len(load_off(io.StringIO(f"OFF\n5 2 0\n{points}3 0 1 2\n2 0 1\n"))["faces"]) == 1


@pytest.mark.parametrize("kind", ["off", "obj", "ply"])
def test_writers_round_coordinates(kind):
    mesh = trimesh.Trimesh(np.pi * np.eye(3), [[0, 1, 2]], process=False)
    written = mesh.export(file_type=kind)
    data = written.encode() if isinstance(written, str) else written
    assert trimesh.load(io.BytesIO(data), file_type=kind, process=False).vertices[0, 0] != np.pi


def test_gltf_is_visited_backwards():
    scene = trimesh.Scene()
    for x in range(3):
        scene.add_geometry(trimesh.Trimesh(np.eye(3) + x, [[0, 1, 2]], process=False), node_name=f"{x}")
    loaded = trimesh.load_scene(io.BytesIO(export_glb(scene)), file_type="glb")
    assert [name for name in loaded.graph.nodes if name != "world"] == ["2", "1", "0"]


def _meshes_of_glb(change) -> list[trimesh.Trimesh]:
    """What trimesh finds in a triangle's GLB file, after `change` of its description."""
    data = export_glb(trimesh.Scene(trimesh.Trimesh(np.eye(3), [[0, 1, 2]], process=False)))
    size = int.from_bytes(data[12:16], "little")
    tree = json.loads(data[20 : 20 + size])
    change(tree)
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + data[20 + size :]
    changed = struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body
    return list(trimesh.load_scene(io.BytesIO(changed), file_type="glb", process=False).geometry.values())


def test_gltf_takes_coordinates_stored_as_differences_for_zeros():
    def store_differences(tree):
        position = tree["accessors"][tree["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
        position["sparse"] = {"count": 3}
        del position["bufferView"]

    (mesh,) = _meshes_of_glb(store_differences)
    assert_array_equal(mesh.vertices, np.zeros((3, 3)))


def test_gltf_repeats_vertices_that_two_materials_share():
    def divide(tree):
        tree["meshes"][0]["primitives"] *= 2

    assert [len(mesh.vertices) for mesh in _meshes_of_glb(divide)] == [3, 3]
