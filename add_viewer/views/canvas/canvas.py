"""What is drawn in a view, and which of its vertices lies where."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from PySide6.QtCore import QPointF
from PySide6.QtGui import QImage, QResizeEvent

from add_core.geometry import TriangleMesh

from ...models.fields import ShapeField
from ...models.picks import Pick
from ...models.results import DirectionField
from ...models.shapes import OpenShape, Shape
from ..theme import LIGHT, Theme
from .marks import Marks, Needles
from .orbit_view import OrbitView
from .picker import POINT_REACH, CloudPicker
from .picture import take_picture
from .surface import USUAL_HEIGHT, Surface

FloatArray = NDArray[np.float64]


class Canvas(OrbitView):
    """One shape, its field, its markers: draws what it is told."""

    def __init__(self, parent: object = None) -> None:
        super().__init__(parent)
        self._body: Surface | None = None
        self._outline: FloatArray = np.zeros((0, 3))
        self._needles: Needles | None = None
        self._marks, self._best = Marks(self.renderer), Marks(self.renderer)
        self._point_size = 1.0
        _add_lights(self)
        self.show_theme(LIGHT)

    # -- what is shown ------------------------------------------------------------------------------------------------

    def show_shape(self, opened: OpenShape | None, up: str, front: str) -> None:
        """Replace the shape; the camera looks it in the face."""
        self.show_directions(None)
        self._marks.clear()
        self._best.clear()
        if self._body is not None:
            for actor in self._body.actors:
                self.renderer.RemoveActor(actor)
        self._body = None if opened is None else Surface(opened.shape, opened.coarse)
        if opened is not None and self._body is not None:
            for actor in self._body.actors:
                self.renderer.AddActor(actor)
            self._outline = opened.outline
            self.camera_model.orient(up, front)
            self.look("front")
            self._step_aside()
        self.update()

    def show_field(self, field: ShapeField | None) -> None:
        """Colour the shape by a field and mark its best vertices; None is bare skin."""
        if self._body is None:
            return
        if field is not None and field.colors is not None:
            self._body.show_colours(field.colors)
        else:
            self._body.show_field(None if field is None else field.position, "kernel" if field is None else field.tones)
        shape = self._body.shape
        self._best.show_best(() if field is None else field.best, *_places(shape))
        self.draw_moving()

    def show_picks(self, picks: tuple[Pick, ...]) -> None:
        """Mark the picked points."""
        if self._body is not None:
            shape = self._body.shape
            self._marks.show_picks(picks, *_places(shape))
            self.draw_soon()  # a field that follows from them is on its way

    def show_directions(self, field: DirectionField | None) -> None:
        """Draw the direction field, or take it away."""
        if self._needles is not None:
            self.renderer.RemoveActor(self._needles.actor)
        self._needles = None if field is None else Needles(field, self._ball)
        if self._needles is not None:
            self.renderer.AddActor(self._needles.actor)
        self.update()

    def turn_directions(self, theta: float) -> None:
        """Turn the direction field to `theta`."""
        if self._needles is not None:
            self._needles.turn(theta)
            self.draw_moving()

    def show_wireframe(self, on: bool) -> None:
        """Draw the triangles' edges."""
        if self._body is not None:
            self._body.show_wireframe(on)
            self.update()

    def show_point_size(self, factor: float) -> None:
        """Draw the discs of a cloud `factor` times as large as they need to be to touch each other."""
        self._point_size = factor
        self._size_points()
        if self._needles is not None:
            self._needles.lift(self._ball)
        self.update()

    @property
    def _ball(self) -> float:
        """Radius of what is drawn for a point of the shown cloud; 0 for a mesh."""
        return 0.0 if self.shown is None else self._point_size * _ball_radius(self.shown)

    def _size_points(self, finer: int = 1) -> None:
        """In pixels: on a picture `finer` times as fine, a disc has as many times more across."""
        if self._body is not None:
            pixels = finer * self.devicePixelRatioF() * self.height()
            self._body.show_point_size(self._point_size * pixels / USUAL_HEIGHT)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.show_point_size(self._point_size)

    def show_theme(self, theme: Theme) -> None:
        """Soft background, a little lighter at the top."""
        self.set_background(theme.canvas_bottom, top=theme.canvas_top)
        self.update()

    def _step_aside(self) -> None:
        """A shape much deeper than wide shows little of itself from the front: look at it from three quarters."""
        width, _, depth = np.ptp(self._outline @ self.camera_model.axes.T, axis=0)
        if depth > 1.5 * width:
            self.camera_model.azimuth = 55.0
            self.fit()

    @property
    def shown(self) -> Shape | None:
        return None if self._body is None else self._body.shape

    @property
    def extent(self) -> FloatArray | None:
        return None if self._body is None else self._outline

    # -- picking ------------------------------------------------------------------------------------------------------

    def vertex_at(self, place: QPointF) -> int:
        """The vertex under `place` (device-independent pixels of this widget), -1 beside the shape."""
        if self._body is None:
            return -1
        ratio = self.devicePixelRatioF()
        x, y = ratio * place.x(), ratio * (self.height() - place.y())
        picker = self._body.picker
        if isinstance(picker, CloudPicker):
            found = picker.vertex_near(self._to_screen(), x, y, ratio * POINT_REACH)
        else:
            found = picker.vertex_at(self._to_world(x, y, 0.0), self._to_world(x, y, 1.0))
        return -1 if found is None else found

    def place_of(self, vertex: int) -> QPointF:
        """Where `vertex` is drawn, in device-independent pixels of this widget."""
        assert self.shown is not None
        self.renderer.SetWorldPoint(*self.shown.vertices[vertex], 1.0)
        self.renderer.WorldToDisplay()
        x, y, _ = self.renderer.GetDisplayPoint()
        ratio = self.devicePixelRatioF()
        return QPointF(x / ratio, self.height() - y / ratio)

    def _to_world(self, x: float, y: float, depth: float) -> FloatArray:
        self.renderer.SetDisplayPoint(x, y, depth)
        self.renderer.DisplayToWorld()
        point = np.array(self.renderer.GetWorldPoint())
        world: FloatArray = point[:3] / point[3]
        return world

    def _to_screen(self) -> FloatArray:
        width, height = self.render_window.GetSize()
        matrix = self.renderer.GetActiveCamera().GetCompositeProjectionTransformMatrix(width / height, 0.0, 1.0)
        project = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
        window = np.array([[width / 2, 0, 0, width / 2], [0, height / 2, 0, height / 2], [0, 0, 1, 0], [0, 0, 0, 1]])
        screen: FloatArray = window @ project
        return screen

    # -- painting -----------------------------------------------------------------------------------------------------

    def show_moving(self, on: bool) -> None:
        if self._body is not None:
            self._body.show_moving(on)

    def picture(self, scale: float, *, transparent: bool) -> QImage:
        """The scene alone at `scale` times the widget's size in device-independent pixels."""
        self.show_moving(False)
        self.grabFramebuffer()  # a hidden or stale widget paints first
        factor = max(1, round(scale / self.devicePixelRatioF()))
        self._size_points(factor)
        image = take_picture(self, factor, transparent=transparent)
        self._size_points()
        self.update()
        return image


def _places(shape: Shape) -> tuple[FloatArray, FloatArray | None]:
    """Where marks go, (n, 3), and what they stand on."""
    if isinstance(shape, TriangleMesh):
        return shape.vertices, shape.vertex_normals
    if shape.normals is None:
        return shape.vertices, None
    return shape.vertices + _ball_radius(shape) * shape.normals, shape.normals


def _ball_radius(shape: Shape) -> float:
    """The discs of a cloud are balls to the eye: as high as wide."""
    if isinstance(shape, TriangleMesh):
        return 0.0
    return float(0.5 * np.ptp(shape.vertices, axis=0).max() / np.sqrt(shape.vertex_count))


def _add_lights(view: OrbitView) -> None:
    """A gentle key from the upper left and a weak fill from the right; both move with the eye: no side is black."""
    for place, intensity in (((-0.5, 0.7, 1.0), 0.66), ((1.0, 0.1, 0.5), 0.30), ((0.0, 0.0, 1.0), 0.26)):
        light = pv.Light(position=place, focal_point=(0, 0, 0), light_type="camera light", intensity=intensity)
        view.add_light(light)
