"""VTK's formats are read as VTK writes them, and written as VTK reads them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.geometry import PointCloud, TriangleMesh
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


@pytest.mark.parametrize("extension", [".vtk", ".vtp"])
def test_vtk_reads_what_is_written(awkward, tmp_path, extension):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    fields = {"heat <kernel> & more": np.arange(8.0), "direction": awkward.vertices}
    save_shape(awkward, tmp_path / f"a{extension}", fields=fields)
    output = _as_vtk_reads(tmp_path / f"a{extension}")
    assert_array_equal(vtk_to_numpy(output.GetPoints().GetData()), awkward.vertices)
    assert_array_equal(vtk_to_numpy(output.GetPolys().GetConnectivityArray()).reshape(-1, 3), awkward.faces)
    for name, field in fields.items():
        assert_array_equal(vtk_to_numpy(output.GetPointData().GetArray(name)), field)


@pytest.mark.parametrize("extension", [".vtk", ".vtp"])
def test_vtk_shows_the_points_of_a_cloud_and_their_normals(tmp_path, extension):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    save_shape(PointCloud(np.eye(3), np.eye(3)[::-1], "three"), tmp_path / f"a{extension}")
    output = _as_vtk_reads(tmp_path / f"a{extension}")
    assert output.GetNumberOfVerts() == 3
    assert_array_equal(vtk_to_numpy(output.GetPointData().GetNormals()), np.eye(3)[::-1])


def _as_vtk_reads(path):
    from vtkmodules.vtkIOLegacy import vtkPolyDataReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkPolyDataReader() if path.suffix == ".vtk" else vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


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
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    def array(values, name):
        converted = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        converted.SetName(name)
        return converted

    points, cells, data = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(array(mesh.vertices, "Points"))
    ends = np.arange(0, mesh.faces.size + 1, 3)
    cells.SetData(*(numpy_to_vtkIdTypeArray(part.ravel().copy(), deep=True) for part in (ends, mesh.faces)))
    data.SetPoints(points)
    data.SetPolys(cells)
    for name, field in (("direction field", mesh.vertices), ("u", mesh.vertices[:, 0])):
        data.GetPointData().AddArray(array(field, name))
    return data


def _check_vtk(mesh, path, rtol=1e-12):
    loaded = load_shape(path)
    assert_allclose(loaded.vertices, mesh.vertices, rtol=rtol)
    assert_array_equal(loaded.faces, mesh.faces)
    fields = load_fields(path)
    assert_allclose(fields["direction field"], mesh.vertices, rtol=rtol)
    assert_allclose(fields["u"], mesh.vertices[:, 0], rtol=rtol)
