"""What lies on the shape: markers of picked points and the needles of the direction field."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from add_core.drawing.colours import MARKERS, theta_colour

from ...models.picks import Pick
from ...models.results import DirectionField

FloatArray = NDArray[np.float64]

_WHITE, _INK = (1.0, 1.0, 1.0), (0.12, 0.13, 0.15)
_BALL = 0.0095
_NEEDLE_WIDTH, _NEEDLE_LENGTH, _NEEDLE_LIFT = 0.19, 0.90, 0.0026


def marker_actors(picks: tuple[Pick, ...], vertices: FloatArray, normals: FloatArray | None) -> list[pv.Actor]:
    """A ball for each pick and a ring for each mirror point, both rimmed in white so that they show on any colour."""
    actors = []
    for pick in picks:
        normal = np.array([0.0, 0.0, 1.0]) if normals is None else normals[pick.vertex]
        place, colour = vertices[pick.vertex], MARKERS[pick.slot]
        if pick.is_mirror:
            actors.append(_ring(place + 0.35 * _BALL * normal, normal, 1.25 * _BALL, 0.0036, _WHITE))
            actors.append(_ring(place + 0.60 * _BALL * normal, normal, 1.25 * _BALL, 0.0024, colour))
        else:
            actors.append(_ring(place + 0.45 * _BALL * normal, normal, 1.0 * _BALL, 0.0028, _WHITE))
            actors.append(_ball(place + 0.55 * _BALL * normal, _BALL, colour))
    return actors


def best_actors(best: tuple[int, ...], vertices: FloatArray, normals: FloatArray | None) -> list[pv.Actor]:
    """Small white balls with a dark rim at the best matches, the first one larger."""
    actors = []
    for rank, vertex in enumerate(best):
        size = (0.80 if rank == 0 else 0.50) * _BALL
        normal = np.array([0.0, 0.0, 1.0]) if normals is None else normals[vertex]
        place = vertices[vertex] + 0.4 * size * normal
        actors.append(_ring(place, normal, size, 0.28 * size, _INK))
        actors.append(_ball(place, 0.95 * size, _WHITE))
    return actors


def _ball(place: FloatArray, radius: float, colour: tuple[float, float, float]) -> pv.Actor:
    return _flat_actor(pv.Sphere(radius=radius, center=place, theta_resolution=24, phi_resolution=16), colour)


def _ring(
    place: FloatArray, normal: FloatArray, radius: float, thickness: float, colour: tuple[float, float, float]
) -> pv.Actor:
    ring = pv.ParametricTorus(ringradius=radius, crosssectionradius=thickness, u_res=40, v_res=12, w_res=12)
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = _frame(normal), place
    return _flat_actor(ring.transform(frame, inplace=False), colour)


def _frame(normal: FloatArray) -> FloatArray:
    """(3, 3) rotation whose third column is `normal`."""
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    first = np.cross(helper, normal)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first), normal], axis=1)


def _flat_actor(dataset: pv.PolyData, colour: tuple[float, float, float]) -> pv.Actor:
    actor = pv.Actor(mapper=pv.DataSetMapper(dataset))
    actor.mapper.SetScalarVisibility(False)
    actor.prop.color = colour
    actor.prop.ambient, actor.prop.diffuse = 0.62, 0.40
    return actor


class Needles:
    """The directions of heat: slim diamonds that lie just above the skin and turn with θ."""

    def __init__(self, field: DirectionField) -> None:
        self._field = field
        self._across = np.cross(field.normals, field.max_directions)
        count = len(field.positions)
        corners = 4 * np.arange(count)[:, None]
        faces = (corners + np.array([0, 1, 2, 0, 2, 3])).reshape(-1, 3)
        self.dataset = pv.PolyData.from_regular_faces(np.zeros((4 * count, 3), dtype=np.float32), faces)
        self.actor = _flat_actor(self.dataset, (0.0, 0.0, 0.0))
        self.actor.prop.ambient, self.actor.prop.diffuse = 1.0, 0.0
        self.turn(0.0)

    def turn(self, theta: float) -> None:
        """Point along the direction of maximum curvature turned by `theta`, in the hue of `theta`."""
        field = self._field
        along = np.cos(theta) * field.max_directions + np.sin(theta) * self._across
        across = np.cross(field.normals, along)
        reach, breadth = 0.5 * _NEEDLE_LENGTH * field.spacing, 0.5 * _NEEDLE_WIDTH * field.spacing
        middle = field.positions + _NEEDLE_LIFT * field.normals
        corners = np.stack(
            [middle + reach * along, middle + breadth * across, middle - reach * along, middle - breadth * across],
            axis=1,
        )
        self.dataset.points[:] = corners.reshape(-1, 3)
        self.dataset.GetPoints().Modified()
        self.actor.prop.color = tuple(theta_colour(theta))
