"""Vertices come back in the order and number of the file, whatever the format makes of them."""

import base64
import io
import json
import logging
import struct

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ParameterError, ShapeFileError
from add_core.geometry import PointCloud, TriangleMesh
from add_core.io import extensions, load_fields, load_shape, save_shape

DOUBLE = (".off", ".obj", ".ply", ".vtp", ".vtk", ".npz")
"""Formats that keep vertices, and all their digits."""


@pytest.fixture
def awkward() -> TriangleMesh:
    """Vertex 0 and 6 in no face, 5 at the place of 1, 4 used before 2, and one face without area."""
    vertices = np.random.default_rng(1).normal(size=(8, 3))
    vertices[5] = vertices[1]
    return TriangleMesh(vertices, [[7, 4, 1], [1, 4, 2], [2, 4, 5], [3, 1, 5]], "awkward")


@pytest.mark.parametrize("extension", DOUBLE)
def test_a_mesh_returns_bit_by_bit(awkward, tmp_path, extension):
    path = tmp_path / f"awkward{extension}"
    save_shape(awkward, path)
    loaded = load_shape(path)
    assert_array_equal(loaded.vertices, awkward.vertices)
    assert_array_equal(loaded.faces, awkward.faces)
    assert loaded.name == "awkward"


def test_glb_returns_a_mesh_in_single_precision(awkward, tmp_path):
    save_shape(awkward, tmp_path / "awkward.glb")
    loaded = load_shape(tmp_path / "awkward.glb")
    assert_array_equal(loaded.vertices, awkward.vertices.astype(np.float32))
    assert_array_equal(loaded.faces, awkward.faces)


@pytest.mark.parametrize("kind", ["stl", "stl_ascii"])
def test_stl_corners_become_vertices_by_first_appearance(awkward, tmp_path, kind):
    mesh = trimesh.Trimesh(awkward.vertices, awkward.faces, process=False)
    exported = mesh.export(file_type=kind)
    (tmp_path / "shape.stl").write_bytes(exported.encode() if isinstance(exported, str) else exported)
    loaded = load_shape(tmp_path / "shape.stl")
    # Vertices 1 and 5 have the same coordinates, so STL cannot tell them apart.
    assert_array_equal(loaded.faces, [[0, 1, 2], [2, 1, 3], [3, 1, 2], [4, 2, 2]])
    assert_allclose(loaded.vertices, awkward.vertices[[7, 4, 1, 2, 3]], rtol=1e-6)


def test_stl_has_the_same_surface_after_writing(tmp_path, awkward):
    save_shape(awkward, tmp_path / "shape.stl")
    assert_allclose(load_shape(tmp_path / "shape.stl").area, awkward.area, rtol=1e-6)


@pytest.mark.parametrize("extension", [*DOUBLE, ".xyz"])
@pytest.mark.parametrize("normals", [None, np.eye(3)[[0, 1, 2, 2, 1]]])
def test_points_alone_become_a_cloud(tmp_path, extension, normals):
    cloud = PointCloud(np.random.default_rng(2).normal(size=(5, 3)), normals)
    save_shape(cloud, tmp_path / f"cloud{extension}")
    loaded = load_shape(tmp_path / f"cloud{extension}")
    assert isinstance(loaded, PointCloud)
    assert_array_equal(loaded.points, cloud.points)
    if normals is not None and extension != ".off":
        assert_array_equal(loaded.normals, normals)


@pytest.mark.parametrize("extension", extensions(holding_fields=True))
def test_fields_return_bit_by_bit(awkward, tmp_path, extension):
    rng = np.random.default_rng(3)
    fields = {"kernel": rng.normal(size=8), "direction": rng.normal(size=(8, 3)), "signature": rng.normal(size=(8, 12))}
    save_shape(awkward, tmp_path / f"f{extension}", fields=fields)
    loaded = load_fields(tmp_path / f"f{extension}")
    assert loaded.keys() == fields.keys()
    for name, field in fields.items():
        assert_array_equal(loaded[name], field)
    assert_array_equal(load_shape(tmp_path / f"f{extension}").vertices, awkward.vertices)


@pytest.mark.parametrize("extension", [".off", ".obj", ".stl", ".glb"])
def test_fields_are_refused_where_they_would_be_lost(awkward, tmp_path, extension):
    with pytest.raises(ShapeFileError, match=r"hold no fields. Choose one of .ply, .vtp, .vtk, .npz"):
        save_shape(awkward, tmp_path / f"f{extension}", fields={"u": np.zeros(8)})
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("fields", "complaint"),
    [
        ({"u": np.zeros(7)}, r"field 'u' must have shape \(8,\) or \(8, k\), but it has \(7,\)"),
        ({"u": ["a"] * 8}, "field 'u' must hold real numbers"),
        ({" ": np.zeros(8)}, "a field must have a name"),
    ],
)
def test_fields_must_fit_the_shape(awkward, tmp_path, fields, complaint):
    with pytest.raises(ParameterError, match=complaint):
        save_shape(awkward, tmp_path / "f.ply", fields=fields)


def test_a_ply_field_may_not_replace_a_coordinate(awkward, tmp_path):
    with pytest.raises(ShapeFileError, match="two properties 'x'"):
        save_shape(awkward, tmp_path / "f.ply", fields={"x": np.zeros(8)})


@pytest.mark.parametrize("extension", [".stl", ".glb"])
def test_points_are_refused_by_formats_of_triangles(tmp_path, extension):
    with pytest.raises(ShapeFileError, match=r"Choose PLY, OFF, XYZ or VTP"):
        save_shape(PointCloud(np.eye(3)), tmp_path / f"c{extension}")


def test_writing_leaves_the_old_file_when_it_fails(awkward, tmp_path):
    path = tmp_path / "shape.ply"
    save_shape(awkward, path)
    before = path.read_bytes()
    with pytest.raises(ParameterError):
        save_shape(awkward, path, fields={"u": np.zeros(3)})
    assert path.read_bytes() == before
    assert [found.name for found in tmp_path.iterdir()] == ["shape.ply"]


def test_writing_into_a_missing_folder_says_so(awkward, tmp_path):
    with pytest.raises(ShapeFileError, match=r"shape\.off: cannot be written \(No such file or directory\)"):
        save_shape(awkward, tmp_path / "missing" / "shape.off")


OBJ = """# cube corner with everything that makes other readers renumber
mtllib none.mtl
o first
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 9 9 9
vt 0 0
vt 1 1
vn 0 0 1
vn 0 1 0
usemtl red
f 1/1/1 2/2/1 3/1/1
g second
usemtl blue
f 1/2/2 3/1/2 4/2/2
o third
v 0 0 1
v 1 0 1
f -2//1 -1//2 \\
  -7//1
l 1 2
"""


def test_obj_keeps_its_numbers_through_groups_materials_and_texture_seams(tmp_path):
    (tmp_path / "a.obj").write_text(OBJ)
    mesh = load_shape(tmp_path / "a.obj")
    assert_array_equal(mesh.vertices[[4, 6]], [[9, 9, 9], [1, 0, 1]])
    assert mesh.vertex_count == 7
    assert_array_equal(mesh.faces, [[0, 1, 2], [0, 2, 3], [5, 6, 0]])


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.off", "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n.5 2 0\n4 0 1 2 3\n3 3 2 4\n"),
        (
            "a.off",
            "# made by hand\nOFF 5 2 7 # counts\n0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n.5 2 0\n4 0 1 2 3 255 0 0\n3 3 2 4\n",
        ),
        ("a.off", "OFF5 2 0\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n.5 2 0\r\n4 0 1 2 3\r\n3 3 2 4\r\n"),
        (
            "a.off",
            "COFF\n5 2 0\n0 0 0 1 1 1\n1 0 0 1 1 1\n1 1 0 1 1 1\n0 1 0 1 1 1\n.5 2 0 1 1 1\n4 0 1 2 3\n3 3 2 4",
        ),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 2 0\nf 1 2 3 4\nf 4 3 5\n"),
        (
            "a.ply",
            "ply\nformat ascii 1.0\ncomment quads\nelement vertex 5\nproperty float x\nproperty float y\n"
            "property float z\n"
            "property uchar red\nelement face 2\nproperty uchar flag\nproperty list uchar int vertex_index\n"
            "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
            "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n.5 2 0 9\n7 4 0 1 2 3\n7 3 3 2 4\n0 1\n",
        ),
    ],
)
def test_polygons_are_split_into_fans_and_it_is_said(tmp_path, caplog, name, text):
    (tmp_path / name).write_text(text)
    with caplog.at_level(logging.INFO):
        mesh = load_shape(tmp_path / name)
    assert_array_equal(mesh.faces, [[0, 1, 2], [0, 2, 3], [3, 2, 4]])
    assert mesh.area == pytest.approx(1.5)
    assert "1 of 2 faces have more than three corners" in caplog.text


def _binary_ply(order: str) -> bytes:
    """Quads and triangles mixed, unusual types, a list at the vertices, a table in between."""
    word = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    header = (
        f"ply\nformat {word} 1.0\nobj_info none\nelement vertex 5\nproperty double y\nproperty float x\n"
        "property short z\n"
        "property uint8 quality\nproperty float nx\nproperty float ny\nproperty float nz\nelement material 2\n"
        "property list uchar float weights\nelement face 2\nproperty list ushort uint vertex_indices\n"
        "property uchar red\nend_header\n"
    )
    vertex = np.dtype(
        [(k, order + t) for k, t in zip("yxzqabc", ["f8", "f4", "i2", "u1", "f4", "f4", "f4"], strict=True)]
    )
    rows = np.zeros(5, vertex)
    rows["x"], rows["y"], rows["q"] = [0, 1, 1, 0, 0.5], [0, 0, 1, 1, 2], [1, 2, 3, 4, 255]
    material = bytes([2]) + np.zeros(2, order + "f4").tobytes() + bytes([0])
    faces = b"".join(
        np.array([len(face)], order + "u2").tobytes() + np.array(face, order + "u4").tobytes() + b"\x07"
        for face in ([0, 1, 2, 3], [3, 2, 4])
    )
    return header.encode() + rows.tobytes() + material + faces


@pytest.mark.parametrize("order", ["<", ">"])
def test_binary_ply_of_either_byte_order(tmp_path, order):
    (tmp_path / "a.ply").write_bytes(_binary_ply(order))
    mesh = load_shape(tmp_path / "a.ply")
    assert_array_equal(mesh.vertices[[1, 4]], [[1, 0, 0], [0.5, 2, 0]])
    assert_array_equal(mesh.faces, [[0, 1, 2], [0, 2, 3], [3, 2, 4]])
    fields = load_fields(tmp_path / "a.ply")
    assert_array_equal(fields["quality"], [1, 2, 3, 4, 255])
    assert list(fields) == ["quality"]


@pytest.mark.parametrize("encoding", ["ascii", "binary_little_endian"])
def test_ply_of_another_writer(awkward, tmp_path, encoding):
    mesh = trimesh.Trimesh(awkward.vertices, awkward.faces, process=False)
    (tmp_path / "a.ply").write_bytes(mesh.export(file_type="ply", encoding=encoding.split("_")[0]))
    assert_array_equal(load_shape(tmp_path / "a.ply").faces, awkward.faces)


@pytest.mark.parametrize("mode", [0, 1, 2])
@pytest.mark.parametrize("compressor", ["ZLib", "LZMA", None])
@pytest.mark.parametrize("header", [32, 64])
def test_vtp_as_vtk_writes_it(awkward, tmp_path, mode, compressor, header):
    """Text, base64 and appended bytes, compressed or not."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(_vtk_mesh(awkward))
    writer.SetDataMode(mode)
    writer.SetHeaderType(header)
    writer.SetEncodeAppendedData(mode == 2 and header == 64)
    writer.SetBlockSize(64)
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    writer.SetFileName(str(tmp_path / "a.vtp"))
    writer.Write()
    _check_vtk(awkward, tmp_path / "a.vtp")


@pytest.mark.parametrize("kind", [1, 2])
@pytest.mark.parametrize("version", [42, 51])
def test_legacy_vtk_as_vtk_writes_it(awkward, tmp_path, kind, version):
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter

    writer = vtkPolyDataWriter()
    writer.SetInputData(_vtk_mesh(awkward))
    writer.SetFileType(kind)
    writer.SetFileVersion(version)
    writer.SetFileName(str(tmp_path / "a.vtk"))
    writer.Write()
    _check_vtk(awkward, tmp_path / "a.vtk", rtol=1e-9)


def test_vtk_reads_what_is_written(awkward, tmp_path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOLegacy import vtkPolyDataReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    for extension, reader in ((".vtk", vtkPolyDataReader()), (".vtp", vtkXMLPolyDataReader())):
        save_shape(awkward, tmp_path / f"a{extension}", fields={"u": np.arange(8.0)})
        reader.SetFileName(str(tmp_path / f"a{extension}"))
        reader.Update()
        output = reader.GetOutput()
        assert_array_equal(vtk_to_numpy(output.GetPoints().GetData()), awkward.vertices)
        assert_array_equal(vtk_to_numpy(output.GetPolys().GetConnectivityArray()).reshape(-1, 3), awkward.faces)
        assert_array_equal(vtk_to_numpy(output.GetPointData().GetArray("u")), np.arange(8.0))


def test_an_unstructured_grid_of_polygons_is_a_mesh(tmp_path):
    (tmp_path / "a.vtk").write_text(
        "# vtk DataFile Version 3.0\ngrid\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n"
        "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n9\nPOINT_DATA 4\nSCALARS u float 1\nLOOKUP_TABLE default\n1 2 3 4\n"
        "VECTORS w float\n1 0 0 0 1 0 0 0 1 1 1 1\n"
    )
    assert load_shape(tmp_path / "a.vtk").area == pytest.approx(1.0)
    fields = load_fields(tmp_path / "a.vtk")
    assert_array_equal(fields["u"], [1, 2, 3, 4])
    assert_array_equal(fields["w"][2], [0, 0, 1])


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


def test_noise_around_numbers_is_tolerated(tmp_path):
    (tmp_path / "a.xyz").write_bytes("\ufeff# a scan, Größe in mm\n0,0,0\n1;0;0\n\n0\t1 0\n".encode())
    assert_array_equal(load_shape(tmp_path / "a.xyz").points, [[0, 0, 0], [1, 0, 0], [0, 1, 0]])


def test_columns_that_are_no_unit_normals_are_left_out(tmp_path):
    (tmp_path / "a.xyz").write_text("0 0 0 255 0 0\n1 0 0 0 255 0\n")
    assert load_shape(tmp_path / "a.xyz").normals is None


def test_upper_case_extensions_are_the_same(awkward, tmp_path):
    buffer = io.BytesIO()
    np.savez(buffer, vertices=awkward.vertices, faces=awkward.faces)
    (tmp_path / "A.NPZ").write_bytes(buffer.getvalue())
    assert load_shape(tmp_path / "A.NPZ").vertex_count == 8


def test_an_archive_with_objects_is_not_unpickled(tmp_path):
    class Bomb:
        def __reduce__(self):
            return (exit, (3,))

    np.savez(tmp_path / "a.npz", vertices=np.array([Bomb()], dtype=object))
    with pytest.raises(ShapeFileError, match=r"a\.npz: is not a readable NPZ archive \(Object arrays cannot be loaded"):
        load_shape(tmp_path / "a.npz")


def _vtk_mesh(mesh):
    from add_core.io.vtk_writing import _poly_data

    return _poly_data(mesh, {"direction field": mesh.vertices, "u": mesh.vertices[:, 0]})


def _check_vtk(mesh, path, rtol=1e-12):
    loaded = load_shape(path)
    assert_allclose(loaded.vertices, mesh.vertices, rtol=rtol)
    assert_array_equal(loaded.faces, mesh.faces)
    fields = load_fields(path)
    assert_allclose(fields["direction field"], mesh.vertices, rtol=rtol)
    assert_allclose(fields["u"], mesh.vertices[:, 0], rtol=rtol)
