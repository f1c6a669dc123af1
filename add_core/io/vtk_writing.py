"""Writing VTK's own formats, legacy .vtk and XML .vtp, through VTK itself."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ..errors import ShapeFileError
from ..geometry import PointCloud
from .contents import Fields, Shape


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
    from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow

    # VTK complains twice: to its window, and to stderr through its logger.
    usual, listening = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
    verbosity = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    vtkOutputWindow.SetInstance(listening)
    try:
        yield lambda: _first_complaint(listening.GetOutput())
    finally:
        vtkOutputWindow.SetInstance(usual)
        vtkLogger.SetStderrVerbosity(verbosity)


def _first_complaint(text: str) -> str:
    """VTK's "ERROR: In file.cxx, line 7\\nvtkReader (0x55…): reason" without where it stands in VTK's source."""
    for line in text.splitlines():
        _, marker, reason = line.partition("): ")
        if marker and reason.strip():
            return reason.strip().rstrip(".")
    return " ".join(text.split())[:200].rstrip(".")
