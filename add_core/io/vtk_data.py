"""VTK's own formats, legacy .vtk and XML .vtp, through VTK itself.

VTK prints its complaints; here they become part of the error.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ..errors import ShapeFileError
from ..geometry import PointCloud
from .contents import Fields, FileContents, Shape, fan_triangles

_LEGACY_COUNTS = re.compile(
    rb"^[ \t]*(?:POINTS|VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS|CELLS|CELL_TYPES|POINT_DATA|CELL_DATA|FIELD[ \t]+\S+"
    rb"|METADATA|OFFSETS|CONNECTIVITY|\S+[ \t]+\d+(?=[ \t]+\d+[ \t]+(?:float|double|u?int|vtk\w+)))"
    rb"[ \t]+(\d+)(?:[ \t]+(\d+))?",
    re.MULTILINE | re.IGNORECASE,
)
_XML_COUNTS = re.compile(rb"\bNumberOf(?:Points|Verts|Lines|Strips|Polys|Tuples)\s*=\s*[\"'](\d+)")
_ZLIB_RATIO = 1040
"""Deflate never packs tighter than this."""
_SURFACE_CELLS = (5, 7, 9)
"""VTK's numbers for triangle, polygon and quad."""


def read_legacy(data: bytes) -> FileContents:
    """The points, polygons and point data of a legacy VTK file that holds polygons or an unstructured grid of them."""
    _check_counts(data, _LEGACY_COUNTS, len(data))
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader

    reader: Any = vtkGenericDataObjectReader()
    reader.ReadFromInputStringOn()
    reader.SetBinaryInputString(data, len(data))
    for read_all in ("Scalars", "Vectors", "Normals", "Tensors", "TCoords", "Fields"):
        getattr(reader, f"ReadAll{read_all}On")()
    return _contents(reader)


def read_xml(data: bytes) -> FileContents:
    """The points, polygons and point data of a VTP file."""
    _check_counts(data, _XML_COUNTS, len(data) * _ZLIB_RATIO)
    if re.search(rb"<!(DOCTYPE|ENTITY)", data[:4096]):
        raise ShapeFileError("defines XML entities, which no VTP file needs.")
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader: Any = vtkXMLPolyDataReader()
    reader.ReadFromInputStringOn()
    reader.SetInputString(data)
    return _contents(reader)


def write_legacy(shape: Shape, fields: Fields) -> bytes:
    """A binary legacy VTK file in double precision, with `fields` as point data."""
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter

    writer = vtkPolyDataWriter()
    writer.SetInputData(_poly_data(shape, fields))
    writer.SetFileTypeToBinary()
    writer.WriteToOutputStringOn()
    with _complaints() as said:
        done = writer.Write()
    if not done:
        raise ShapeFileError(f"VTK could not write it: {said() or 'it gave no reason'}.")
    # VTK hands the bytes over as a string if they happen to be one.
    written: str | bytes = writer.GetOutputStdString()
    return written.encode() if isinstance(written, str) else written


def write_xml(shape: Shape, fields: Fields) -> bytes:
    """A VTP file in double precision, with `fields` as point data."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(_poly_data(shape, fields))
    writer.WriteToOutputStringOn()
    with _complaints() as said:
        done = writer.Write()
    if not done:
        raise ShapeFileError(f"VTK could not write it: {said() or 'it gave no reason'}.")
    return str(writer.GetOutputString()).encode("latin-1")


def _check_counts(data: bytes, pattern: re.Pattern[bytes], most: int) -> None:
    """VTK allocates whatever a file claims and ends the process if there is not enough memory."""
    for match in pattern.finditer(data):
        for claim in match.groups():
            if claim is not None and int(claim) > most:
                raise ShapeFileError(f"claims {int(claim)} values, but has only {len(data)} bytes. Is it damaged?")


def _contents(reader: Any) -> FileContents:
    with _complaints() as said:
        reader.Update()
        output = reader.GetOutput()
    if said():
        raise ShapeFileError(f"VTK cannot read it: {said()}.")
    if output is None or not output.IsA("vtkPointSet") or output.IsA("vtkStructuredGrid"):
        kind = output.GetClassName().removeprefix("vtk") if output is not None else "nothing"
        raise ShapeFileError(f"holds {kind}, not a surface or points.")
    if output.GetNumberOfPoints() == 0:
        raise ShapeFileError("holds no points.")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    vertices = vtk_to_numpy(output.GetPoints().GetData()).astype(np.float64)
    attributes = output.GetPointData()
    normals = attributes.GetNormals()
    return FileContents(
        vertices,
        _triangles(output, len(vertices)),
        None if normals is None else vtk_to_numpy(normals).astype(np.float64),
        _fields(attributes, len(vertices), normals),
    )


def _triangles(output: Any, vertex_count: int) -> np.ndarray | None:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if output.IsA("vtkPolyData"):
        if output.GetNumberOfStrips():
            raise ShapeFileError("holds triangle strips. Export it with triangles.")
        cells = output.GetPolys()
    else:
        kinds = {output.GetCellType(k) for k in range(output.GetNumberOfCells())}
        if not kinds <= set(_SURFACE_CELLS):
            raise ShapeFileError(
                "holds an unstructured grid with other cells than polygons. Extract its surface first."
            )
        cells = output.GetCells()
    if cells is None or cells.GetNumberOfCells() == 0:
        return None
    offsets = vtk_to_numpy(cells.GetOffsetsArray()).astype(np.int64)
    corners = vtk_to_numpy(cells.GetConnectivityArray()).astype(np.int64)
    counts = np.diff(offsets)
    if offsets[0] != 0 or (counts < 0).any() or offsets[-1] != len(corners):
        raise ShapeFileError("has polygons whose offsets do not fit their corners. Is it damaged?")
    return fan_triangles(corners, counts)


def _fields(attributes: Any, count: int, normals: Any) -> Fields:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    fields: Fields = {}
    for k in range(attributes.GetNumberOfArrays()):
        array = attributes.GetArray(k)  # None for an array of strings
        if array is None or array is normals or array.GetNumberOfTuples() != count:
            continue
        fields[array.GetName() or f"array {k}"] = vtk_to_numpy(array).astype(np.float64)
    return fields


def _poly_data(shape: Shape, fields: Fields) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    def array(values: np.ndarray, name: str) -> Any:
        converted = numpy_to_vtk(np.ascontiguousarray(values, dtype=np.float64), deep=True)
        converted.SetName(name)
        return converted

    points = vtkPoints()
    points.SetData(array(shape.vertices, "Points"))
    data = vtkPolyData()
    data.SetPoints(points)
    is_cloud = isinstance(shape, PointCloud)
    # Points need a cell each to be seen in ParaView.
    corners = np.arange(shape.vertex_count)[:, None] if isinstance(shape, PointCloud) else shape.faces
    offsets = np.arange(0, corners.size + 1, corners.shape[1])
    cells = vtkCellArray()
    cells.SetData(*(numpy_to_vtkIdTypeArray(part.astype(np.int64).ravel(), deep=True) for part in (offsets, corners)))
    (data.SetVerts if is_cloud else data.SetPolys)(cells)
    if isinstance(shape, PointCloud) and shape.normals is not None:
        data.GetPointData().SetNormals(array(shape.normals, "Normals"))
    for name, field in fields.items():
        data.GetPointData().AddArray(array(field, name))
    return data


@contextmanager
def _complaints() -> Iterator[Any]:
    """Collects what VTK would print. Yields a function that gives the first complaint in one line, or ""."""
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

    usual, listening = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(listening)
    try:
        yield lambda: _first_complaint(listening.GetOutput())
    finally:
        vtkOutputWindow.SetInstance(usual)


def _first_complaint(text: str) -> str:
    """VTK's "ERROR: In file.cxx, line 7\\nvtkReader (0x55…): reason" without where it stands in VTK's source."""
    for line in text.splitlines():
        _, marker, reason = line.partition("): ")
        if marker and reason.strip():
            return reason.strip().rstrip(".")
    return " ".join(text.split())[:200].rstrip(".")
