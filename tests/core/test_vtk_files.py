"""VTK's formats are read as VTK writes them, and written as VTK reads them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.geometry import TriangleMesh
from add_core.io import load_fields, load_shape, save_shape


@pytest.fixture
def awkward() -> TriangleMesh:
    """Vertex 0 and 6 in no face, 5 at the place of 1, 4 used before 2, and one face without area."""
    vertices = np.random.default_rng(1).normal(size=(8, 3))
    vertices[5] = vertices[1]
    return TriangleMesh(vertices, [[7, 4, 1], [1, 4, 2], [2, 4, 5], [3, 1, 5]], "awkward")


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
