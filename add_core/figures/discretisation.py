"""Figure 5: two triangles of a real mesh with their principal frames, and the same turned by θ."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from .._check import FloatArray, IntArray
from ..drawing.camera import Camera
from ..drawing.colours import SKIN, theta_colour
from ..geometry import TriangleMesh, principal_curvatures
from .drawn import Drawn
from .page import INK, QUIET, blank, fade
from .studio import Studio

THETA = np.radians(35.0)
ELEVATION = np.radians(44.0)
NEARBY = 80
"""Vertices around the source among which the edge is chosen."""


def draw(studio: Studio) -> Drawn:
    """The hinge of faces ijk and ijh, drawn from the mesh around the cast's source."""
    studio.expect(1)
    mesh = studio.person(studio.cast.hero)
    hinge = _hinge(mesh, studio.cast.source)
    camera, size = _camera(mesh, hinge), float(np.linalg.norm(mesh.vertices[hinge[0]] - mesh.vertices[hinge[1]]))
    figure = Figure(figsize=(7.2, 4.4))
    axes = blank(figure, (0.1, 0.1, 7.0, 4.2))
    middle = camera.seen(mesh.vertices[hinge].mean(axis=0))[:2]
    wide = 3.0 * size
    axes.set(
        xlim=(middle[0] - wide / 2, middle[0] + wide / 2),
        ylim=(middle[1] - 0.26 * wide, middle[1] + 0.34 * wide),
        aspect="equal",
    )
    _patch(axes, camera, mesh, hinge)
    _hinge_lines(axes, camera, mesh.vertices[hinge], size)
    angle = _frames(axes, camera, mesh, hinge, size)
    fade(axes, share=0.14, sides=True)
    studio.done()
    return Drawn(figure, _caption(mesh, hinge, angle))


def _hinge(mesh: TriangleMesh, source: int) -> IntArray:
    """Vertices i, j, k, h: the edge ij near `source` whose faces ijk and jih are most nearly equilateral."""
    distance = np.linalg.norm(mesh.vertices - mesh.vertices[source], axis=1)
    near = np.isin(np.arange(len(distance)), np.argsort(distance)[:NEARBY])
    best, found = -1.0, None
    opposite = {}
    for face in mesh.faces[near[mesh.faces].all(axis=1)]:
        for turn in range(3):
            i, j, k = np.roll(face, -turn)
            opposite[(int(i), int(j))] = int(k)
    for (i, j), k in opposite.items():
        h = opposite.get((j, i))
        if h is not None and i < j:
            shape = min(_roundness(mesh.vertices[[i, j, k]]), _roundness(mesh.vertices[[j, i, h]]))
            if shape > best:
                best, found = shape, np.array([i, j, k, h])
    assert found is not None, "a patch of a closed mesh has inner edges"
    return found


def _roundness(corners: FloatArray) -> float:
    """1 for an equilateral triangle, 0 for a flat one."""
    sides = corners - np.roll(corners, 1, axis=0)
    area = 0.5 * np.linalg.norm(np.cross(sides[0], sides[1]))
    return float(4 * np.sqrt(3) * area / np.sum(sides**2))


def _camera(mesh: TriangleMesh, hinge: IntArray) -> Camera:
    """Looks along the edge from i to j, from above: k lies left, h right, normals point up."""
    i, j, k, h = mesh.vertices[hinge]
    normal = _unit(np.cross(j - i, k - i) + np.cross(i - j, h - j))
    along = _unit((j - i) - normal * ((j - i) @ normal))
    eye = np.sin(ELEVATION) * normal - np.cos(ELEVATION) * along
    right = np.cross(along, normal)
    return Camera(np.stack([right, np.cross(eye, right), eye]))


def _patch(axes: Axes, camera: Camera, mesh: TriangleMesh, hinge: IntArray) -> None:
    """Neighbouring faces, fading with the distance from the hinge."""
    centre = mesh.vertices[hinge].mean(axis=0)
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    reach = 2.1 * np.linalg.norm(mesh.vertices[hinge[0]] - mesh.vertices[hinge[1]])
    distance = np.linalg.norm(middles - centre, axis=1)
    faces = np.flatnonzero((distance < reach) & (mesh.face_normals @ camera.axes[2] > 0))
    faces = faces[np.argsort(camera.seen(middles[faces])[:, 2])]
    fade = np.clip(1.5 * (1.0 - distance[faces] / reach), 0.0, 1.0)
    light = 0.62 + 0.42 * np.clip(mesh.face_normals[faces] @ (camera.axes.T @ [-0.3, 0.6, 0.74]), 0.0, 1.0)
    fill = np.column_stack([np.clip(np.outer(light, SKIN), 0, 1), 0.75 * fade])
    lines = np.column_stack([np.full((len(faces), 3), 0.45), 0.35 * fade])
    polygons = camera.seen(mesh.vertices[mesh.faces[faces]])[..., :2]
    axes.add_collection(PolyCollection(list(polygons), facecolors=fill, edgecolors=lines, linewidths=0.6))


def _hinge_lines(axes: Axes, camera: Camera, corners: FloatArray, size: float) -> None:
    """The two triangles, the names of their corners, and the angles opposite the edge."""
    i, j, k, h = corners
    axes.add_collection(PolyCollection([camera.seen(np.array([i, k, j, h]))[:, :2]], facecolors="#ffffff80"))
    for loop in ((i, j, k), (i, j, h)):
        outline = camera.seen(np.array([*loop, loop[0]]))[:, :2]
        axes.plot(*outline.T, color=INK, lw=1.5, solid_joinstyle="round")
    centre = corners.mean(axis=0)
    for point, name in ((i, "i"), (j, "j"), (k, "k"), (h, "h")):
        x, y = camera.seen(point)[:2] + 0.13 * size * _unit(camera.seen(point - centre)[:2])
        axes.text(x, y, f"${name}$", ha="center", va="center", fontsize=13)
        axes.plot(*camera.seen(point)[:2], "o", ms=4, color=INK)
    for apex, name in ((k, r"\alpha_{ij}"), (h, r"\beta_{ij}")):
        one, two = _unit(i - apex), _unit(j - apex)
        share = np.linspace(0, 1, 20)[:, None]
        arc = (1 - share) * one + share * two
        arc = apex + 0.24 * size * arc / np.linalg.norm(arc, axis=1, keepdims=True)
        axes.plot(*camera.seen(arc)[:, :2].T, color=QUIET, lw=1.2)
        x, y = camera.seen(apex + 0.33 * size * _unit(one + two))[:2]
        axes.text(x, y, f"${name}$", ha="center", va="center", fontsize=11, color=QUIET)


def _frames(axes: Axes, camera: Camera, mesh: TriangleMesh, hinge: IntArray, size: float) -> float:
    """The frames of both faces, those of ijk named, and turned; the angle between the two u_M, in degrees."""
    frames = principal_curvatures(mesh)
    axis = []
    for opposite in (2, 3):
        number = _face(mesh, hinge[[0, 1, opposite]])
        u_max, normal = frames.max_direction[number], frames.normals[number]
        # Of an axis either direction may be drawn: the one that, turned, does not hide the normal.
        turned = np.cos(THETA) * u_max + np.sin(THETA) * np.cross(normal, u_max)
        u_max = -u_max if turned @ camera.axes[1] > 0 else u_max
        origin = mesh.vertices[mesh.faces[number]].mean(axis=0)
        _frame(axes, camera, origin, np.array([u_max, np.cross(normal, u_max), normal]), size, named=opposite == 2)
        axis.append(u_max)
    return float(np.degrees(np.arccos(min(abs(float(axis[0] @ axis[1])), 1.0))))


def _frame(axes: Axes, camera: Camera, origin: FloatArray, frame: FloatArray, size: float, *, named: bool) -> None:
    """Rows of `frame` (3, 3) are u_M, u_m and the normal; black as they are, coloured turned by θ about the normal."""
    u_max, u_min, normal = frame
    cos, sin = np.cos(THETA), np.sin(THETA)
    red = tuple(theta_colour(THETA))
    arrows = (
        (normal, INK, r"\hat{\mathbf{n}}"),
        (u_max, INK, r"\hat{\mathbf{u}}_M"),
        (u_min, INK, r"\hat{\mathbf{u}}_m"),
        (cos * u_max + sin * u_min, red, r"\mathbf{R}_\theta\hat{\mathbf{u}}_M"),
        (cos * u_min - sin * u_max, red, r"\mathbf{R}_\theta\hat{\mathbf{u}}_m"),
    )
    for direction, colour, name in arrows:
        _arrow(axes, camera, origin, direction, (0.4 if named else 0.17) * size, colour, name if named else "")
    if named:
        turn = np.linspace(0, THETA, 20)[:, None]
        arc = camera.seen(origin + 0.27 * size * (np.cos(turn) * u_max + np.sin(turn) * u_min))[:, :2]
        axes.plot(*arc.T, color=red, lw=1.2, zorder=5)
        x, y = camera.seen(origin + 0.345 * size * (np.cos(THETA / 2) * u_max + np.sin(THETA / 2) * u_min))[:2]
        axes.text(x, y, r"$\theta$", ha="center", va="center", fontsize=12, color=red, zorder=6)


def _arrow(
    axes: Axes, camera: Camera, origin: FloatArray, direction: FloatArray, length: float, colour: Any, name: str
) -> None:
    start, end = camera.seen(np.array([origin, origin + length * direction]))[:, :2]
    look = {"arrowstyle": "-|>,head_width=0.2,head_length=0.42", "shrinkA": 0, "shrinkB": 0, "lw": 1.9}
    axes.annotate("", (end[0], end[1]), (start[0], start[1]), arrowprops=look | {"color": colour}, zorder=5)
    if name:
        across, up = _unit(end - start)
        # Beyond the tip, but above a level arrow: there its neighbour begins.
        x, y = (end - (0.12 * length, -0.22 * length)) if abs(up) < 0.3 else end + 0.3 * length * np.array([across, up])
        halo = [withStroke(linewidth=3.5, foreground="#f3f2f0")]
        axes.text(x, y, f"${name}$", ha="center", va="center", fontsize=13, color=colour, zorder=6, path_effects=halo)


def _face(mesh: TriangleMesh, corners: IntArray) -> int:
    return int(np.flatnonzero(np.isin(mesh.faces, corners).all(axis=1))[0])


def _unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.linalg.norm(vector))


def _caption(mesh: TriangleMesh, hinge: IntArray, angle: float) -> str:
    i, j, k, h = hinge.tolist()
    return (
        f"Discretisation, section 6, on two faces of a mesh of {mesh.vertex_count:,} vertices (i, j, k, h = {i}, {j}, "
        f"{k}, {h}): each face has its frame of principal directions û_M, û_m and normal n̂, black, and the frame "
        f"turned by θ = {np.degrees(THETA):.0f}° about n̂, in colour. û_M of the two faces differ by {angle:.1f}°. The "
        "stiffness of the edge ij comes from both faces, eq. (24)."
    )
