"""What lies on the shape: markers of picked points and the needles of the direction field."""

from __future__ import annotations

from functools import cache

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from add_core.drawing.colours import MARKERS, theta_colour

from ...models.picks import Pick
from ...models.results import DirectionField

FloatArray = NDArray[np.float64]
Colour = tuple[float, float, float]

_WHITE, _INK = (1.0, 1.0, 1.0), (0.12, 0.13, 0.15)
_BALL = 0.0095
_NEEDLE_WIDTH, _NEEDLE_LENGTH, _NEEDLE_LIFT = 0.19, 0.90, 0.0026


class Marks:
    """Balls and rings on one view's shape. What is drawn once is moved later: making an actor takes milliseconds."""

    def __init__(self, renderer: pv.Renderer) -> None:
        self._renderer = renderer
        self._mappers: dict[float, pv.DataSetMapper] = {}
        self._actors: list[pv.Actor] = []
        self._used = 0

    def show_picks(self, picks: tuple[Pick, ...], vertices: FloatArray, normals: FloatArray | None) -> None:
        """A ball for each pick, a ring for each mirror point, both rimmed in white so that they show on any colour."""
        self.clear()
        for pick in picks:
            normal = np.array([0.0, 0.0, 1.0]) if normals is None else normals[pick.vertex]
            place, colour = vertices[pick.vertex], MARKERS[pick.slot]
            if pick.is_mirror:
                self._ring(place + 0.35 * _BALL * normal, normal, 1.25 * _BALL, 0.0036, _WHITE)
                self._ring(place + 0.60 * _BALL * normal, normal, 1.25 * _BALL, 0.0024, colour)
            else:
                self._ring(place + 0.45 * _BALL * normal, normal, 1.0 * _BALL, 0.0028, _WHITE)
                self._ball(place + 0.55 * _BALL * normal, _BALL, colour)

    def show_best(self, best: tuple[int, ...], vertices: FloatArray, normals: FloatArray | None) -> None:
        """Small white balls with a dark rim at the best matches, the first one larger."""
        self.clear()
        for rank, vertex in enumerate(best):
            size = (0.80 if rank == 0 else 0.50) * _BALL
            normal = np.array([0.0, 0.0, 1.0]) if normals is None else normals[vertex]
            place = vertices[vertex] + 0.4 * size * normal
            self._ring(place, normal, size, 0.28 * size, _INK)
            self._ball(place, 0.95 * size, _WHITE)

    def clear(self) -> None:
        """Take all marks away."""
        for actor in self._actors[: self._used]:
            actor.visibility = False
        self._used = 0

    def _ball(self, place: FloatArray, radius: float, colour: Colour) -> None:
        self._draw(0.0, radius * np.eye(3), place, colour)

    def _ring(self, place: FloatArray, normal: FloatArray, radius: float, thickness: float, colour: Colour) -> None:
        self._draw(round(thickness / radius, 2), radius * _frame(normal), place, colour)

    def _draw(self, roundness: float, frame: FloatArray, place: FloatArray, colour: Colour) -> None:
        """The next mark: a ring whose tube has `roundness` of its radius, or a ball if that is 0."""
        if self._used == len(self._actors):
            self._actors.append(_flat_actor(self._mapper(roundness), colour))
            self._renderer.AddActor(self._actors[-1])
        actor = self._actors[self._used]
        self._used += 1
        actor.mapper, actor.prop.color, actor.visibility = self._mapper(roundness), colour, True
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = frame, place
        actor.user_matrix = matrix

    def _mapper(self, roundness: float) -> pv.DataSetMapper:
        """Of this view alone: a mapper shared with another view would move its triangles to and fro."""
        if roundness not in self._mappers:
            self._mappers[roundness] = pv.DataSetMapper(_ring_of(roundness) if roundness else _unit_ball())
        return self._mappers[roundness]


@cache
def _unit_ball() -> pv.PolyData:
    return pv.Sphere(radius=1.0, theta_resolution=24, phi_resolution=16)


@cache
def _ring_of(roundness: float) -> pv.PolyData:
    return pv.ParametricTorus(ringradius=1.0, crosssectionradius=roundness, u_res=40, v_res=12, w_res=12)


def _frame(normal: FloatArray) -> FloatArray:
    """(3, 3) rotation whose third column is `normal`."""
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    first = np.cross(helper, normal)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first), normal], axis=1)


def _flat_actor(mapper: pv.DataSetMapper, colour: Colour) -> pv.Actor:
    actor = pv.Actor(mapper=mapper)
    actor.mapper.SetScalarVisibility(False)
    actor.prop.color = colour
    actor.prop.ambient, actor.prop.diffuse = 0.62, 0.40
    return actor


class Needles:
    """The directions of heat: slim diamonds that lie just above the skin and turn with θ.

    height : of the skin above the field's places; the balls of a cloud would hide what lies within them.
    """

    def __init__(self, field: DirectionField, height: float = 0.0) -> None:
        self._field, self._height, self._theta = field, height, 0.0
        self._across = np.cross(field.normals, field.max_directions)
        count = len(field.positions)
        corners = 4 * np.arange(count)[:, None]
        faces = (corners + np.array([0, 1, 2, 0, 2, 3])).reshape(-1, 3)
        self.dataset = pv.PolyData.from_regular_faces(np.zeros((4 * count, 3), dtype=np.float32), faces)
        self.actor = _flat_actor(pv.DataSetMapper(self.dataset), (0.0, 0.0, 0.0))
        self.actor.prop.ambient, self.actor.prop.diffuse = 1.0, 0.0
        self.turn(0.0)

    def lift(self, height: float) -> None:
        """Lie on a skin that is `height` above the field's places."""
        self._height = height
        self.turn(self._theta)

    def turn(self, theta: float) -> None:
        """Point along the direction of maximum curvature turned by `theta`, in the hue of `theta`."""
        field, self._theta = self._field, theta
        along = np.cos(theta) * field.max_directions + np.sin(theta) * self._across
        across = np.cross(field.normals, along)
        reach, breadth = 0.5 * _NEEDLE_LENGTH * field.spacing, 0.5 * _NEEDLE_WIDTH * field.spacing
        middle = field.positions + (self._height + _NEEDLE_LIFT) * field.normals
        corners = np.stack(
            [middle + reach * along, middle + breadth * across, middle - reach * along, middle - breadth * across],
            axis=1,
        )
        self.dataset.points[:] = corners.reshape(-1, 3)
        self.dataset.GetPoints().Modified()
        self.actor.prop.color = tuple(theta_colour(theta))
