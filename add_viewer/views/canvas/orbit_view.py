"""A view that a person turns, and points into: orbit, hover, click."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPoint, QPointF, QRect, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QApplication

from .camera import VIEW_ANGLE, OrbitCamera
from .view3d import View3D

FloatArray = NDArray[np.float64]

VIEWS = {"front": (0.0, 0.0), "back": (180.0, 0.0), "left": (90.0, 0.0), "right": (-90.0, 0.0), "top": (0.0, 89.0)}

_ARROWS = {
    Qt.Key.Key_Left: (-1.0, 0.0),
    Qt.Key.Key_Right: (1.0, 0.0),
    Qt.Key.Key_Up: (0.0, 1.0),
    Qt.Key.Key_Down: (0.0, -1.0),
}
"""Where an arrow moves what is seen: right and up."""
_ZOOMS = {Qt.Key.Key_Plus: 1.15, Qt.Key.Key_Equal: 1.15, Qt.Key.Key_Minus: 1 / 1.15}


class OrbitView(View3D):
    """Moves its camera as mouse and keys say, and tells what a person points at. Subclasses say what is there.

    vertex_hovered : the vertex under the cursor or -1. vertex_clicked : vertex (-1 beside the shape) and modifier keys.
    menu_requested : global place and vertex or -1. camera_moved : the picture's axes turned.
    steered : the person moved the camera, by this method of `OrbitCamera` with these arguments.
    reached : whether the keyboard came here by the Tab key.
    """

    vertex_hovered = Signal(int)
    vertex_clicked = Signal(int, object)
    menu_requested = Signal(QPoint, int)
    camera_moved = Signal()
    steered = Signal(str, tuple)
    painted = Signal()
    reached = Signal(bool)

    def __init__(self, parent: Any = None) -> None:
        super().__init__(parent)
        self.camera_model = OrbitCamera()
        self._pressed: QPointF | None = None
        self._last = QPointF()
        self._dragging = False
        self._fitted = True
        self._corners: tuple[QRect, ...] = ()
        self._below = 0
        self._hovered = -1

    @property
    def extent(self) -> FloatArray | None:
        """(n, 3) the points that `fit` brings into view; None if there is nothing."""
        raise NotImplementedError

    def vertex_at(self, place: QPointF) -> int:
        """The vertex under `place` (device-independent pixels of this widget), -1 beside the shape."""
        raise NotImplementedError

    # -- camera -------------------------------------------------------------------------------------------------------

    def look(self, view: str) -> None:
        """Look from "front", "back", "left", "right" (the shape's own) or "top", with the whole shape in view."""
        self.camera_model.azimuth, self.camera_model.elevation = VIEWS[view]
        self.fit()

    def fit(self) -> None:
        """Move so that the whole shape is in view, from the same side."""
        points = self.extent
        if points is not None:
            width, height = max(self.width(), 1), max(self.height(), 1)
            below = min(self._below / height, 0.3)
            for above in (0, *sorted(corner.bottom() for corner in self._corners)):
                self.camera_model.fit(points, width / height, min(above / height, 0.3), below)
                if not self._reaches_corners(points):
                    break
        self._fitted = True
        self._place_camera()

    def leave_room(self, corners: tuple[QRect, ...], below: int) -> None:
        """Where the view is fitted to the shape, keep so many pixels free below it, and stay under those labels at
        the upper `corners` that it would reach."""
        if (corners, below) != (self._corners, self._below):
            self._corners, self._below = corners, below
            if self._fitted:
                self.fit()

    def _reaches_corners(self, points: FloatArray) -> bool:
        x, y = self.camera_model.places(points, self.width(), self.height()).T
        return any(
            bool(((x > room.left()) & (x < room.right()) & (y > room.top()) & (y < room.bottom())).any())
            for room in self._corners
        )

    def steer(self, move: str, arguments: tuple[float, ...]) -> None:
        """Move the camera by a method of `OrbitCamera`: "rotate", "pan" or "zoom"."""
        getattr(self.camera_model, move)(*arguments)
        self._fitted = False
        self._place_camera()

    def stand(
        self, azimuth: float, elevation: float, focal: tuple[float, float, float], distance: float, *, fitted: bool
    ) -> None:
        """Put the eye where it once stood. fitted : as far away as the whole shape needs in this view."""
        self.camera_model.azimuth, self.camera_model.elevation = azimuth, elevation
        if fitted:
            self.fit()
        else:
            self.camera_model.focal, self.camera_model.distance = np.array(focal), distance
            self._fitted = False
            self._place_camera()

    @property
    def is_fitted(self) -> bool:
        """Whether the whole shape is in view, and stays so when the view is resized."""
        return self._fitted

    def face(self, other: OrbitView) -> None:
        """Look from the same side as another view."""
        self.camera_model.face(other.camera_model)
        self.fit()

    def _place_camera(self) -> None:
        model, camera = self.camera_model, self.renderer.GetActiveCamera()
        camera.SetViewAngle(VIEW_ANGLE)
        camera.SetFocalPoint(model.focal)
        camera.SetPosition(model.focal + model.distance * model.direction)
        camera.SetViewUp(model.axes[1])
        self.renderer.ResetCameraClippingRange()
        self.camera_moved.emit()
        self.draw_moving()

    # -- mouse and keys ------------------------------------------------------------------------------------------------

    def focusInEvent(self, event: QFocusEvent) -> None:
        super().focusInEvent(event)
        self.reached.emit(event.reason() in (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason))

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self.reached.emit(False)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        pans = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if event.key() in _ARROWS:
            x, y = _ARROWS[Qt.Key(event.key())]
            self._steer_by_hand("pan" if pans else "rotate", *((0.05 * x, 0.05 * y) if pans else (15.0 * x, -15.0 * y)))
        elif event.key() in _ZOOMS:
            self._steer_by_hand("zoom", _ZOOMS[Qt.Key(event.key())], 0.0, 0.0)
        else:
            super().keyPressEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._pressed = self._last = event.position()
        self._dragging = False
        self.setFocus(Qt.FocusReason.MouseFocusReason)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._pressed is None:
            self._hover(self.vertex_at(event.position()))
            return
        moved = event.position() - self._pressed
        if self._dragging or moved.manhattanLength() >= QApplication.startDragDistance() / 2:
            self._dragging = True
            self._drag(event)
            self._last = event.position()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        was_click = self._pressed is not None and not self._dragging
        self._pressed = None
        self._dragging = False
        if was_click and event.button() == Qt.MouseButton.LeftButton:
            self.vertex_clicked.emit(self.vertex_at(event.position()), event.modifiers())
        elif was_click and event.button() == Qt.MouseButton.RightButton:
            self.menu_requested.emit(event.globalPosition().toPoint(), self.vertex_at(event.position()))

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.mousePressEvent(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        notches = event.angleDelta().y() / 120.0
        x, y = self._from_centre(event.position())
        self._steer_by_hand("zoom", 1.15**notches, x, y)

    def leaveEvent(self, event: QEvent) -> None:
        self._hover(-1)
        super().leaveEvent(event)

    def _drag(self, event: QMouseEvent) -> None:
        step = event.position() - self._last
        height = max(self.height(), 1)
        pans = event.buttons() & Qt.MouseButton.MiddleButton or event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        if event.buttons() & Qt.MouseButton.RightButton:
            self._steer_by_hand("zoom", 4.0 ** (-step.y() / height))
        elif pans:
            self._steer_by_hand("pan", step.x() / height, -step.y() / height)
        else:
            self._steer_by_hand("rotate", 220.0 * step.x() / height, 220.0 * step.y() / height)

    def _steer_by_hand(self, move: str, *arguments: float) -> None:
        self.steer(move, arguments)
        self.steered.emit(move, arguments)

    def _from_centre(self, place: QPointF) -> tuple[float, float]:
        height = max(self.height(), 1)
        return (place.x() - self.width() / 2) / height, (self.height() / 2 - place.y()) / height

    def _hover(self, vertex: int) -> None:
        if vertex != self._hovered:
            self._hovered = vertex
            self.vertex_hovered.emit(vertex)

    # -- painting -----------------------------------------------------------------------------------------------------

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self._fitted:
            self.fit()

    def paintGL(self) -> None:
        super().paintGL()
        self.painted.emit()
