"""Principal frames: where the surface bends most and least, how much, and how far to trust that."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from .._check import BoolArray, FloatArray, IntArray, instance_of, read_only
from .cloud import PointCloud
from .cloud_curvature import point_curvature_tensors
from .curvature import face_curvature_tensors
from .direction_field import ComplexArray, TangentBasis, fill_axes
from .fan_curvature import fan_curvature_tensors, trust_in_fans
from .mesh import TriangleMesh
from .orientation import orientation

_log = logging.getLogger(__name__)

TRUSTED = 0.1
"""Confidence below which a direction is taken from its neighbours."""
FLAT = 1e-2
"""A surface that bends less than this over its own size (the radius of the sphere of its area) counts as flat."""


@dataclass(frozen=True, eq=False)
class PrincipalFrames:
    """Orthonormal principal frames, one per face of a mesh or per point of a cloud; m rows.

    max_direction, min_direction : (m, 3), unit, tangent: directions of maximum and minimum ABSOLUTE normal
        curvature, u_M and u_m. Only their axes count, not their signs. (max_direction, min_direction, normals) is
        right-handed.
    normals : (m, 3), unit, outward.
    max_curvature, min_curvature : (m,), signed, 1/length, |max| ≥ |min|; positive where the surface is convex (a
        ball's are 1/r).
    confidence : (m,), from 0 (flat, umbilic, or equally curved both ways: no direction) to 1 (a cylinder). Where it
        is below `TRUSTED` the directions are filled in from confident neighbours; the curvatures stay as measured.

    Faces without area have zero vectors, zero curvature and zero confidence.

    on_fans : of a cloud, frames of the triangles of its fans, which conduct its heat as faces do a mesh's. None of a
        mesh, or of frames of your own.
    """

    max_direction: FloatArray
    min_direction: FloatArray
    normals: FloatArray
    max_curvature: FloatArray
    min_curvature: FloatArray
    confidence: FloatArray
    on_fans: PrincipalFrames | None = None


def principal_curvatures(shape: TriangleMesh | PointCloud) -> PrincipalFrames:
    """Principal frames per face of a mesh (Cohen-Steiner and Morvan 2003) or per point of a cloud (section 6).

    Those of a cloud's points come from its normals, smoothed over neighbours; those of its fans (`on_fans`), by which
    heat runs, from the angles between triangles where these are well shaped, in as much detail as a mesh's.

    Boundaries, several components and faces without area are allowed. Faces turned against their neighbours are
    taken the way most of their piece is turned, and a warning says so: θ would run the other way on them.
    Raises ParameterError for what is no shape.
    """
    instance_of("shape", shape, TriangleMesh, PointCloud)
    return _cloud_frames(shape) if isinstance(shape, PointCloud) else _mesh_frames(shape)


def frames_from_tensors(
    tensors: FloatArray,
    normals: FloatArray,
    positions: FloatArray,
    *,
    neighbours: IntArray,
    size: float,
    usable: BoolArray | None = None,
) -> PrincipalFrames:
    """Frames from curvature tensors (m, 3, 3) whose largest |eigenvalue| belongs to the direction of MINIMUM
    curvature.

    normals : (m, 3), unit. positions : (m, 3). neighbours : (p, 2) pairs of adjacent rows, along which uncertain
        directions
    are filled in. size : a length that says what counts as flat. usable : (m,), False where there is no tangent
        plane.
    """
    usable = np.ones(len(normals), dtype=bool) if usable is None else usable

    def filled(axes: ComplexArray, basis: TangentBasis, trusted: BoolArray) -> ComplexArray:
        return fill_axes(axes, basis, trusted=trusted, usable=usable, neighbours=neighbours)

    return _frames(tensors, TangentBasis.of(normals, positions), size, usable, filled)


def _frames(
    tensors: FloatArray,
    basis: TangentBasis,
    size: float,
    usable: BoolArray,
    filled: Callable[[ComplexArray, TangentBasis, BoolArray], ComplexArray],
) -> PrincipalFrames:
    """filled : (axes, basis, trusted) -> axes, all (m,): those that are not trusted from elsewhere."""
    t11 = np.einsum("fi,fij,fj->f", basis.first, tensors, basis.first)
    t12 = np.einsum("fi,fij,fj->f", basis.first, tensors, basis.second)
    t22 = np.einsum("fi,fij,fj->f", basis.second, tensors, basis.second)
    mean, radius = (t11 + t22) / 2, np.hypot((t11 - t22) / 2, t12)
    sign = np.where(mean < 0, -1.0, 1.0)
    max_curvature, min_curvature = mean + sign * radius, mean - sign * radius
    # cos 2φ, sin 2φ of the axis along which the tensor is largest in absolute value: an edge bends across itself.
    double_angle = -sign * ((t11 - t22) / 2 + 1j * t12)
    confidence = np.where(usable, _confidence(mean, radius, max_curvature, size), 0.0)
    double_angle = filled(double_angle, basis, confidence >= TRUSTED)
    max_direction = np.where(usable[:, None], basis.axes(double_angle), 0.0)
    return PrincipalFrames(
        max_direction=read_only(max_direction),
        min_direction=read_only(np.cross(basis.normals, max_direction)),
        normals=read_only(basis.normals.copy()),
        max_curvature=read_only(np.where(usable, max_curvature, 0.0)),
        min_curvature=read_only(np.where(usable, min_curvature, 0.0)),
        confidence=read_only(confidence),
    )


def _mesh_frames(mesh: TriangleMesh) -> PrincipalFrames:
    mesh = mesh if mesh.is_oriented else _agreeing(mesh)
    return frames_from_tensors(
        face_curvature_tensors(mesh),
        mesh.face_normals,
        mesh.vertices[mesh.faces].mean(axis=1),
        neighbours=mesh.inner_edges.faces,
        size=float(np.sqrt(mesh.area / (4 * np.pi))),
        usable=mesh.has_area,
    )


def _cloud_frames(cloud: PointCloud) -> PrincipalFrames:
    first, place = cloud.distinct.first, cloud.distinct.place
    corners = place[cloud.fans.triangles]
    pairs = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    touched = np.zeros(len(first), dtype=bool)
    touched[corners] = True
    frames = frames_from_tensors(
        point_curvature_tensors(cloud.tangent_planes),
        cloud.outward_normals[first],
        cloud.points[first],
        neighbours=np.unique(pairs, axis=0),
        size=float(np.sqrt(cloud.area / (4 * np.pi))),
        usable=touched,
    )
    names = [field.name for field in fields(frames) if field.name != "on_fans"]
    rows = {name: read_only(getattr(frames, name)[place]) for name in names}
    return replace(frames, **rows, on_fans=_fan_frames(cloud, corners, frames) if len(corners) else None)


def _fan_frames(cloud: PointCloud, corners: IntArray, of_points: PrincipalFrames) -> PrincipalFrames:
    """Frames of the triangles (t, 3) of the fans, numbered among the distinct points: of the mean of their corners'
    tensors.

    These come from the angles between the triangles as far as they are well shaped, as of evenly spread points: then
    heat runs as on the mesh that joins the points, and a network reads both. Elsewhere they come from the normals,
    exact where these are. Directions that are not confident are those of the points, filled in there.
    """
    points = cloud.points[cloud.distinct.first]
    trust = trust_in_fans(points, corners)[:, None, None]
    of_normals = point_curvature_tensors(cloud.tangent_planes, rounds=0 if cloud.normals is not None else 1)
    tensors = of_normals + trust * (fan_curvature_tensors(points, corners, cloud.fans.weights) - of_normals)
    a, b, c = (points[corners[:, corner]] for corner in range(3))
    upright = np.cross(b - a, c - a)
    upright /= np.linalg.norm(upright, axis=1, keepdims=True)

    def filled(axes: ComplexArray, basis: TangentBasis, trusted: BoolArray) -> ComplexArray:
        there = sum(basis.double_angles(of_points.max_direction[corners[:, corner]]) for corner in range(3))
        return np.where(trusted | (there == 0), axes, there)

    size, everywhere = float(np.sqrt(cloud.area / (4 * np.pi))), np.ones(len(corners), dtype=bool)
    return _frames(tensors[corners].mean(axis=1), TangentBasis.of(upright, (a + b + c) / 3), size, everywhere, filled)


def _agreeing(mesh: TriangleMesh) -> TriangleMesh:
    """The same faces in the same order, none turned against its neighbours where that can be."""
    found = orientation(mesh)
    turned = found.disagreeing
    if turned.any():
        _log.warning(
            "%d of %d faces of %r were turned to agree with their neighbours (first: %d).",
            turned.sum(),
            len(turned),
            mesh,
            turned.argmax(),
        )
    if found.one_sided.any():
        _log.warning("%r has a piece with one side only, so the sense of θ jumps somewhere on it.", mesh)
    faces = np.where(turned[:, None], mesh.faces[:, ::-1], mesh.faces)
    return TriangleMesh(mesh.vertices, faces, mesh.name)


def _confidence(mean: FloatArray, radius: FloatArray, max_curvature: FloatArray, size: float) -> FloatArray:
    """(|κ_M| − |κ_m|)/(|κ_M| + |κ_m|), faded out where the surface is flat."""
    least, most = np.minimum(np.abs(mean), radius), np.maximum(np.abs(mean), radius)
    contrast = np.divide(least, most, out=np.zeros_like(most), where=most > 0)
    bend = (max_curvature * size) ** 2
    return np.asarray(contrast * bend / (bend + FLAT**2))
