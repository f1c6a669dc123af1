"""Whatever a file holds, it is read or explained in one line; never a traceback, never gigabytes."""

import gzip
import os
import tracemalloc
import zipfile

import numpy as np
import pytest
from scipy.io import savemat

from add_core.cli import main
from add_core.errors import AddError, GeometryError, ShapeFileError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import sphere
from add_core.io import extensions, load_shape, save_shape

HUGE = "99999999999"
PLY = "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
PLY_FACES = "element face {}\nproperty list uchar int vertex_indices\nend_header\n"
VTK = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n"
VTP = '<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="{}" NumberOfPolys="{}">'
NOISE = np.random.default_rng(0).integers(0, 256, 5000, dtype=np.uint8).tobytes()

MALFORMED = {
    "empty.off": (b"", "is empty"),
    "blank.obj": (b"\n  \n\n", "is empty"),
    "zeros.stl": (bytes(200), "is empty"),
    "only a header.off": (b"OFF\n", "ends before the numbers of vertices and faces"),
    "truncated.off": (b"OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n", "claims 4 vertices and 2 faces, but only 3 lines follow"),
    "huge.off": (f"OFF\n{HUGE} {HUGE} 0\n0 0 0\n".encode(), f"claims {HUGE} vertices"),
    "1-based.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 1 2 3\n", "Are they 1-based?"),
    "nan.off": (b"OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "1 of 3 vertices is not finite (first: 0)"),
    "infinite.obj": (b"v 0 0 1e999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "1 of 3 vertices is not finite (first: 0)"),
    "words.off": (b"OFF\n3 1 0\n0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n", "could not convert string to float: 'zero'"),
    "two numbers.off": (b"OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "rows of different length"),
    "an edge.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "face 0 has 2 corners"),
    "a long face.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99 0 1 2\n", "has faces with fewer corners than they claim"),
    "negative.off": (b"OFF\n-3 1 0\n", "should hold the numbers of vertices and faces, but instead it reads '-3 1 0'"),
    "planar.off": (b"nOFF\n2\n3 1 0\n", "another dimension than three"),
    "noise.off": (NOISE, "an OFF file starts with the word OFF"),
    "noise.obj": (NOISE, "holds no vertices"),
    "noise.ply": (NOISE, "has no line end_header"),
    "noise.stl": (NOISE, "triangles, but holds 98. Is it cut off, or not an STL file?"),
    "noise.vtk": (NOISE, "should say ASCII or BINARY on its third line"),
    "noise.vtp": (NOISE, "is not well-formed XML"),
    "noise.glb": (NOISE, "has no readable glTF description"),
    "noise.xyz": (NOISE, "is not an XYZ file that can be read (could not convert string"),
    "noise.mat": (NOISE, "has no complete MATLAB header"),
    "hdf.mat": (b"MATLAB 7.3 MAT-file".ljust(128), "is a MATLAB file of version 7.3. Save it again with -v7"),
    "noise.npz": (NOISE, "is not a readable NPZ archive"),
    "zero.obj": (
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n",
        "line 4 holds a face with vertex 0, but OBJ files count from 1",
    ),
    "beyond.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n", "face 1 uses vertex 9, but the file holds 3"),
    "backwards.obj": (b"v 0 0 0\nf -1 -2 -3\n", "vertex -2, but only 1 come before it"),
    "half.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "face 0 has 2 corners"),
    "no end.ply": (PLY.format("ascii", 3).encode(), "has no line end_header"),
    "huge text.ply": (
        (PLY.format("ascii", HUGE) + PLY_FACES.format(1)).encode() + b"0 0 0\n",
        f"claims {HUGE} rows of vertex",
    ),
    "huge.ply": (
        (PLY.format("binary_big_endian", HUGE) + PLY_FACES.format(1)).encode(),
        f"claims {HUGE} rows of vertex",
    ),
    "truncated.ply": (
        (PLY.format("binary_little_endian", 3) + PLY_FACES.format(2)).encode()
        + bytes(36)
        + b"\3"
        + bytes(12)
        + b"\3"
        + bytes(4),
        "claims 2 rows of face, but the file ends before",
    ),
    "huge list.ply": (
        (PLY.format("ascii", 3) + PLY_FACES.format(1)).encode() + b"0 0 0 1 0 0 0 1 0 " + HUGE.encode(),
        "claims 1 rows of face, but the file ends before",
    ),
    "unknown.ply": (PLY.format("ebcdic", 3).encode() + b"end_header\n", "a header line that no PLY file has"),
    "flat.ply": (
        b"ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n1\n",
        "has no vertices with x, y and z",
    ),
    "long and short.off": (
        b"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n3 0 1 2 2\n",
        "has faces with fewer corners than they claim",
    ),
    "negative face.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", "face 0 has -3 corners"),
    "counts.off": (b"OFF\nthree one\n", "should hold the numbers of vertices and faces, but instead it reads 'three"),
    "digits.off": (b"OFF\n" + b"9" * 5000 + b" 1 0\n", "should hold the numbers of vertices and faces"),
    "noff.off": (b"NOFF\n2 0 0\n0 0 0 0 0 1\n1 0 0\n", "is not an OFF file that can be read"),
    "one column.xyz": (b"0\n1\n", "holds points of 1 numbers, which should be 3"),
    "comments.xyz": (b"# nothing\n", "holds no points"),
    "half a solid.stl": (
        b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        b"endsolid a\nsolid b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
        "holds 4 corners, but only 3 before the word endsolid",
    ),
    "words.stl": (
        b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 up\nendsolid\n",
        "is not an STL file that can be read",
    ),
    "nothing.stl": (b"solid a\nfacet\nendsolid a\n", "holds no triangles"),
    "nan.stl": (
        b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 nan\nendsolid\n",
        "1 of 3 vertices is not finite",
    ),
    "huge.stl": (bytes(80) + b"\xff\xff\xff\x7f" + bytes(50) + b"\1", "claims 2147483647 triangles, but holds 1"),
    "short.stl": (b"binary STL", "inside the header of 84"),
    "truncated.stl": (
        b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n",
        "holds 2 corners, but only 0 before the word endsolid. Is it cut off?",
    ),
    "huge.vtk": (
        (VTK + f"POINTS {HUGE} double\n0 0 0\n").encode(),
        "claims 299999999997 numbers, but only 6 bytes follow",
    ),
    "truncated.vtk": ((VTK + "POINTS 3 float\n0 0 0 1 0 0 0\n").encode(), "claims 9 numbers, but only 7 follow"),
    "volume.vtk": ((VTK.replace("POLYDATA", "STRUCTURED_POINTS")).encode(), "not a surface or points"),
    "huge.vtp": (
        (VTP.format(HUGE, 0) + '<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0').encode()
        + b"</DataArray></Points></Piece></PolyData></VTKFile>",
        f"claims {HUGE} rows of unnamed, but holds 1",
    ),
    "truncated.vtp": (VTP.format(3, 1).encode(), "is not well-formed XML"),
    "entities.vtp": (
        b'<?xml version="1.0"?><VTKFile type="PolyData"><!ENTITY a "b"></VTKFile>',
        "defines XML entities",
    ),
    "truncated.glb": (b"glTF\2\0\0\0\xff\0\0\0", "claims 255 bytes, but has 12"),
    "words.xyz": (b"0 0 0\n1 0 0\none two three\n", "could not convert string 'one' to float64 at row 2"),
    "ragged.xyz": (b"0 0 0\n1 0 0 4\n", "the number of columns changed from 3 to 4 at row 2"),
    "renamed.off": (
        (PLY.format("ascii", 0) + "end_header\n").encode(),
        "looks like a PLY file. Rename it to end in .ply",
    ),
    "renamed.ply": (b"OFF\n0 0 0\n", "looks like an OFF file. Rename it to end in .off"),
    "page.off": (b"<!DOCTYPE html><html><title>404</title></html>", "looks like an HTML file"),
    "pointer.obj": (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "only a Git LFS pointer"),
    "packed.off": (gzip.compress(b"OFF\n0 0 0\n"), "is compressed with gzip. Unpack it first"),
    "packed.off.gz": (gzip.compress(b"OFF\n0 0 0\n"), "is compressed with gzip. Unpack it first"),
    "shape.blend": (b"BLENDER-v300", "the extension '.blend' is not supported. Supported are .off, .obj, .ply"),
    "shape.mesh": (b"OFF\n0 0 0\n", "It looks like OFF: rename it to end in .off"),
    "shape": (b"OFF\n0 0 0\n", "the name has no extension"),
}


def one_line(capsys, path) -> str:
    """What `add-core info` says about a file that it cannot open."""
    with pytest.raises(SystemExit) as stop:
        main(["info", str(path)])
    said = capsys.readouterr()
    assert stop.value.code == 2
    assert said.out == ""
    assert said.err.startswith("add-core: ")
    assert said.err.count("\n") == 1
    return said.err


@pytest.mark.parametrize("name", MALFORMED)
def test_a_malformed_file_is_explained_in_one_line(tmp_path, capsys, name):
    content, expected = MALFORMED[name]
    (tmp_path / name).write_bytes(content)
    tracemalloc.start()
    try:
        said = one_line(capsys, tmp_path / name)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert expected in said
    assert str(tmp_path / name) in said
    assert peak < 50e6


def test_npz_archives_of_other_things_are_explained_in_one_line(tmp_path, capsys):
    ball = sphere(1)
    np.savez(tmp_path / "number.npz", vertices=ball.vertices, faces=3)
    with zipfile.ZipFile(tmp_path / "junk.npz", "w") as archive:
        archive.writestr("vertices.npy", b"junk")
    np.savez(tmp_path / "good.npz", vertices=ball.vertices, faces=ball.faces)
    data = bytearray((tmp_path / "good.npz").read_bytes())
    data[data.find(b"PK\1\2") + 8] |= 1
    (tmp_path / "secret.npz").write_bytes(data)
    assert "faces must have shape (m, 3)" in one_line(capsys, tmp_path / "number.npz")
    assert "must hold real numbers" in one_line(capsys, tmp_path / "junk.npz")
    assert "is encrypted" in one_line(capsys, tmp_path / "secret.npz")


def test_a_missing_file_a_folder_and_a_pipe_are_explained(tmp_path, capsys):
    assert "there is no such file" in one_line(capsys, tmp_path / "missing.off")
    (tmp_path / "folder.off").mkdir()
    assert "is a folder, not a file" in one_line(capsys, tmp_path / "folder.off")
    os.mkfifo(tmp_path / "pipe.off")
    assert "is not a regular file" in one_line(capsys, tmp_path / "pipe.off")
    (tmp_path / "file").touch()
    assert "Not a directory" in one_line(capsys, tmp_path / "file" / "a.off")
    (tmp_path / "loop.off").symlink_to("loop.off")
    assert "cannot be read" in one_line(capsys, tmp_path / "loop.off")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_an_unreadable_file_is_explained(tmp_path, capsys):
    (tmp_path / "a.off").write_text("OFF\n0 0 0\n")
    (tmp_path / "a.off").chmod(0)
    assert "cannot be read (Permission denied)" in one_line(capsys, tmp_path / "a.off")


def test_a_file_that_the_system_refuses_is_explained(tmp_path, capsys, monkeypatch):
    def refuse(path):
        raise PermissionError(13, "Permission denied")

    (tmp_path / "a.off").write_text("OFF\n0 0 0\n")
    monkeypatch.setattr("pathlib.Path.read_bytes", refuse)
    assert "cannot be read (Permission denied)" in one_line(capsys, tmp_path / "a.off")


def test_the_kind_of_error_tells_a_bad_file_from_a_bad_shape(tmp_path):
    for name, error in (("truncated.off", ShapeFileError), ("nan.off", GeometryError)):
        (tmp_path / name).write_bytes(MALFORMED[name][0])
        with pytest.raises(error, match=name):
            load_shape(tmp_path / name)


@pytest.mark.parametrize("extension", [*(ext for ext in extensions(writable=True) if ext != ".xyz"), ".mat"])
def test_damaged_files_are_read_or_explained(tmp_path, extension):
    """Cut anywhere, or with bytes changed: a shape with finite vertices, or an error raised on purpose."""
    rng = np.random.default_rng(5)
    path = tmp_path / f"a{extension}"
    mesh = TriangleMesh(rng.normal(size=(12, 3)), rng.permutation(12).reshape(4, 3))
    if extension == ".mat":
        savemat(path, {"surface": {"VERT": mesh.vertices, "TRIV": mesh.faces + 1}})
    else:
        save_shape(mesh, path)
    whole = path.read_bytes()
    for attempt in range(150):
        data = bytearray(whole[: rng.integers(1, len(whole))] if attempt % 2 else whole)
        for _ in range(attempt % 5):
            data[rng.integers(len(data))] = rng.integers(256)
        path.write_bytes(data)
        try:
            vertices = load_shape(path).vertices
        except AddError as error:
            vertices = np.zeros(0)
            explained = str(error)
            assert "\n" not in explained
        assert np.isfinite(vertices).all()
