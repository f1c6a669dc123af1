"""The shape itself: bare skin, or a field drawn on it in place."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkLookupTable

from add_core.drawing.colour_maps import Tones, tone_map
from add_core.geometry import TriangleMesh

from ...models.coarse import Coarse
from ...models.shapes import Shape
from .picker import CloudPicker, MeshPicker

FloatArray = NDArray[np.float64]
_FIELD, _COLOURS = "field", "colours"
USUAL_HEIGHT = 700.0
"""Of a view, in pixels."""


class Surface:
    """One shape in the scene. `show_field` only writes numbers into the array that VTK already draws.

    coarse : drawn in its place while the camera moves; None draws it always.
    """

    def __init__(self, shape: Shape, coarse: Coarse | None = None) -> None:
        self.shape = shape
        self._coarse = coarse
        self._stand_in = None if coarse is None else Surface(coarse.shape)
        self.dataset = _dataset(shape)
        self._tones: Tones = "kernel"
        self.dataset.point_data[_FIELD] = np.zeros(shape.vertex_count, dtype=np.float32)
        self.dataset.point_data.active_scalars_name = _FIELD
        self.picker = MeshPicker(self.dataset) if isinstance(shape, TriangleMesh) else CloudPicker(self.dataset)
        self.actor = self._make_actor()
        self.show_moving(False)

    @property
    def actors(self) -> list[pv.Actor]:
        """Everything that belongs into the scene."""
        return [self.actor] if self._stand_in is None else [self.actor, self._stand_in.actor]

    def show_moving(self, on: bool) -> None:
        """Draw the stand-in, or the shape itself."""
        if self._stand_in is not None:
            self.actor.SetVisibility(not on)
            self._stand_in.actor.SetVisibility(on)

    def show_field(self, position: FloatArray | None, tones: Tones = "kernel") -> None:
        """Colour by `position` (n,) in [0, 1] on the map of `tones`; None is bare skin."""
        if self._stand_in is not None and self._coarse is not None:
            self._stand_in.show_field(None if position is None else position[self._coarse.kept], tones)
        if position is None:
            tones = "kernel"
        if tones != self._tones:
            self._tones = tones
            self.actor.mapper.SetLookupTable(_lookup_table(tones))
        self.actor.mapper.SelectColorArray(_FIELD)
        self.actor.mapper.SetColorModeToMapScalars()
        self._write(_FIELD, 0.0 if position is None else position)

    def show_colours(self, colours: FloatArray) -> None:
        """Colour by `colours` (n, 3), sRGB in [0, 1]."""
        if self._stand_in is not None and self._coarse is not None:
            self._stand_in.show_colours(colours[self._coarse.kept])
        if _COLOURS not in self.dataset.point_data:
            self.dataset.point_data.set_array(np.zeros((self.shape.vertex_count, 3), dtype=np.uint8), _COLOURS)
        self.actor.mapper.SelectColorArray(_COLOURS)
        self.actor.mapper.SetColorModeToDirectScalars()
        self._write(_COLOURS, np.round(255.0 * np.clip(colours, 0.0, 1.0)).astype(np.uint8))

    def _write(self, name: str, values: object) -> None:
        self.dataset.point_data[name][:] = values
        self.dataset.GetPointData().GetArray(name).Modified()
        self.dataset.Modified()

    def show_point_size(self, factor: float) -> None:
        """Draw the discs of a cloud `factor` times their usual size."""
        if not isinstance(self.shape, TriangleMesh):
            self.actor.prop.point_size = factor * _point_size(self.shape)
            if self._stand_in is not None:
                self._stand_in.show_point_size(factor)

    def show_wireframe(self, on: bool) -> None:
        """Draw the triangles' edges over the surface."""
        self.actor.prop.show_edges = on and isinstance(self.shape, TriangleMesh)
        self.actor.prop.edge_color = (0.35, 0.35, 0.37)
        self.actor.prop.line_width = 0.5

    def _make_actor(self) -> pv.Actor:
        mapper = pv.DataSetMapper(self.dataset)
        mapper.SetLookupTable(_lookup_table(self._tones))
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(_FIELD)
        mapper.SetScalarRange(0.0, 1.0)
        mapper.SetScalarVisibility(True)
        mapper.SetUseLookupTableScalarRange(True)
        # Interpolating values and not colours keeps the map's own colours between vertices far apart.
        mapper.SetInterpolateScalarsBeforeMapping(True)
        actor = pv.Actor(mapper=mapper)
        prop = actor.prop
        prop.ambient, prop.diffuse, prop.specular, prop.specular_power = 0.34, 0.70, 0.05, 16.0
        if isinstance(self.shape, TriangleMesh):
            prop.interpolation = "Phong"
        else:
            prop.style, prop.point_size, prop.render_points_as_spheres = "points", _point_size(self.shape), True
        return actor


def _dataset(shape: Shape) -> pv.PolyData:
    if isinstance(shape, TriangleMesh):
        dataset = pv.PolyData.from_regular_faces(shape.vertices.astype(np.float32), shape.faces)
        normals: FloatArray | None = shape.vertex_normals
    else:
        dataset = pv.PolyData(shape.vertices.astype(np.float32))
        normals = shape.normals
    if normals is not None:
        dataset.GetPointData().SetNormals(_vtk_array("normals", normals))
    return dataset


def _vtk_array(name: str, values: FloatArray):  # type: ignore[no-untyped-def]
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=np.float32), deep=True)
    array.SetName(name)
    return array


def _lookup_table(tones: Tones) -> vtkLookupTable:
    colours = tone_map(tones)
    table = vtkLookupTable()
    table.SetNumberOfTableValues(len(colours))
    table.SetTableRange(0.0, 1.0)
    for index, (red, green, blue) in enumerate(colours):
        table.SetTableValue(index, red, green, blue, 1.0)
    return table


def _point_size(shape: Shape) -> float:
    """Neighbouring discs touch on a picture of the usual height."""
    return float(np.clip(0.9 * USUAL_HEIGHT / np.sqrt(shape.vertex_count), 2.0, 14.0))
