"""Vertices come back in the order and number of the file, whatever the format makes of them."""

import io
import logging

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
        ({"u": 1j * np.arange(8)}, "field 'u' must hold real numbers"),
        ({" ": np.zeros(8)}, "a field must have a name"),
    ],
)
def test_fields_must_fit_the_shape(awkward, tmp_path, fields, complaint):
    with pytest.raises(ParameterError, match=complaint):
        save_shape(awkward, tmp_path / "f.ply", fields=fields)


def test_meshlab_finds_the_first_scalar_field_as_quality(awkward, tmp_path):
    fields = {"direction": awkward.vertices, "heat kernel": np.arange(8.0), "other": np.zeros(8)}
    save_shape(awkward, tmp_path / "f.ply", fields=fields)
    raw = trimesh.load(tmp_path / "f.ply", process=False).metadata["_ply_raw"]["vertex"]["data"]
    assert_array_equal(raw["quality"], np.arange(8.0))
    assert list(load_fields(tmp_path / "f.ply")) == ["direction", "heat_kernel", "other"]
    save_shape(awkward, tmp_path / "g.ply", fields={"other": np.zeros(8), "quality": np.arange(8.0)})
    assert_array_equal(load_fields(tmp_path / "g.ply")["quality"], np.arange(8.0))


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


def test_noise_around_numbers_is_tolerated(tmp_path):
    (tmp_path / "a.xyz").write_bytes("\ufeff# a scan, Größe in mm\n0,0,0\n1;0;0\n\n0\t1 0\n".encode())
    assert_array_equal(load_shape(tmp_path / "a.xyz").points, [[0, 0, 0], [1, 0, 0], [0, 1, 0]])


def test_columns_that_are_no_unit_normals_are_left_out(tmp_path):
    (tmp_path / "a.xyz").write_text("0 0 0 255 0 0\n1 0 0 0 255 0\n")
    assert load_shape(tmp_path / "a.xyz").normals is None


def test_polygons_of_every_size_are_fans_in_off(tmp_path):
    rows = "0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 2 0\n-1 1 0\n9 9 9\n"
    (tmp_path / "a.off").write_text(f"OFF\n7 4 0\n{rows}6 0 1 2 3 4 5\n3 0 1 6\n5 0 1 2 3 4\n4 0 1 2 3\n")
    mesh = load_shape(tmp_path / "a.off")
    assert mesh.vertex_count == 7
    assert_array_equal(mesh.faces[:4], [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])
    assert_array_equal(mesh.faces[4:], [[0, 1, 6], [0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 1, 2], [0, 2, 3]])


def test_normals_of_an_off_file_of_points_are_kept(tmp_path):
    (tmp_path / "a.off").write_text("NOFF\n2 0 0\n0 0 0 0 0 1 # up\n1 0 0 0 0.6 -0.8\n")
    cloud = load_shape(tmp_path / "a.off")
    assert_array_equal(cloud.points, [[0, 0, 0], [1, 0, 0]])
    assert_array_equal(cloud.normals, [[0, 0, 1], [0, 0.6, -0.8]])


SOLID = """solid a vertex of the solid facet
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0.1 1 1e-30
endloop
endfacet
endsolid a vertex of the solid facet
"""


@pytest.mark.parametrize("change", [str, str.upper, lambda text: text.replace("\n", "\r\n")])
def test_stl_text_keeps_double_precision_and_joins_its_solids(tmp_path, change):
    (tmp_path / "a.stl").write_text(
        change(SOLID + SOLID.replace("0 0 0", "1 1 0").replace(" a ", " Größe ")), newline=""
    )
    mesh = load_shape(tmp_path / "a.stl")
    assert_array_equal(mesh.vertices, [[0, 0, 0], [1, 0, 0], [0.1, 1, 1e-30], [1, 1, 0]])
    assert_array_equal(mesh.faces, [[0, 1, 2], [3, 1, 2]])


def test_damaged_normals_in_stl_text_do_not_matter(tmp_path, caplog):
    (tmp_path / "a.stl").write_text(SOLID.replace("normal 0 0 1", "normal 0 0 none"))
    assert load_shape(tmp_path / "a.stl").vertex_count == 3
    assert not caplog.records


def test_bytes_after_the_triangles_of_an_stl_file_are_ignored(awkward, tmp_path):
    path = tmp_path / "a.stl"
    save_shape(awkward, path)
    before = load_shape(path)
    path.write_bytes(b"\xff\0 of a program".ljust(80) + path.read_bytes()[80:] + b"\0\0")
    assert_array_equal(load_shape(path).vertices, before.vertices)


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
