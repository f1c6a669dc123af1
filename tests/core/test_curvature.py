"""Curvature tensors and principal frames against surfaces whose curvature is known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.geometry import TriangleMesh, principal_curvatures
from add_core.geometry.curvature import dihedral_angles
from add_core.geometry.shapes import cylinder, ellipsoid, rectangle, sphere, torus


def degrees_between_axes(a, b):
    cosine = np.abs(np.einsum("ij,ij->i", a, b)) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
    return np.degrees(np.arccos(np.clip(cosine, 0, 1)))


def face_centres(mesh):
    return mesh.vertices[mesh.faces].mean(axis=1)


def shaken_torus(amount, seed=0):
    """A torus whose vertices are moved at random along the surface: triangles of every form."""
    regular = torus(around=96, through=40)
    x, y, z = regular.vertices.T
    rng = np.random.default_rng(seed)
    u = np.arctan2(y, x) + amount * rng.uniform(-1, 1, len(x)) * 2 * np.pi / 96
    v = np.arctan2(z, np.hypot(x, y) - 1) + amount * rng.uniform(-1, 1, len(x)) * 2 * np.pi / 40
    ring = 1 + 0.4 * np.cos(v)
    return TriangleMesh(np.stack([ring * np.cos(u), ring * np.sin(u), 0.4 * np.sin(v)], axis=1), regular.faces)


def torus_truth(mesh):
    """Direction of maximum curvature (through the tube) and both curvatures at the faces' centres."""
    x, y, z = face_centres(mesh).T
    u, v = np.arctan2(y, x), np.arctan2(z, np.hypot(x, y) - 1)
    through = np.stack([-np.sin(v) * np.cos(u), -np.sin(v) * np.sin(u), np.cos(v)], axis=1)
    return through, 1 / 0.4, np.cos(v) / (1 + 0.4 * np.cos(v))


def test_a_cylinder_bends_around_and_not_along():
    """An edge bends across itself: reading the tensor's axes the other way round would swap the two directions."""
    frames = principal_curvatures(cylinder(radius=2.0, around=96))
    assert_allclose(frames.min_direction[:, 2] ** 2, 1, atol=1e-12)
    assert_allclose(frames.max_direction[:, 2], 0, atol=1e-12)
    assert_allclose(frames.max_curvature, 0.5, rtol=1e-3)
    assert_allclose(frames.min_curvature, 0, atol=1e-12)
    assert frames.confidence.min() > 0.99


@pytest.mark.parametrize(("amount", "worst_angle", "worst_curvature"), [(0.0, 2.0, 0.02), (0.2, 6.0, 0.06)])
def test_a_torus_has_its_directions_and_curvatures_on_every_face(amount, worst_angle, worst_curvature):
    """On every face, not on average: averaging vectors without aligning their signs turns single faces far away."""
    mesh = shaken_torus(amount)
    through, most, least = torus_truth(mesh)
    frames = principal_curvatures(mesh)
    assert degrees_between_axes(frames.max_direction, through).max() < worst_angle
    assert_allclose(frames.max_curvature, most, rtol=worst_curvature)
    assert np.abs(frames.min_curvature - least).mean() < 0.06


def test_directions_and_curvatures_converge_on_an_ellipsoid():
    """Mean curvature of an ellipsoid is known in closed form; halving the edges must bring the error down."""
    errors = []
    for subdivisions in (3, 4, 5):
        mesh = ellipsoid(1.0, 0.8, 0.6, subdivisions=subdivisions)
        frames = principal_curvatures(mesh)
        squares = np.array([1.0, 0.64, 0.36])
        p = face_centres(mesh)
        p = p / np.sqrt((p**2 / squares).sum(axis=1, keepdims=True))
        w = (p**2 / squares**2).sum(axis=1)
        mean = ((p**2).sum(axis=1) - squares.sum()) / (-2 * squares.prod() * w**1.5)
        errors.append(np.abs((frames.max_curvature + frames.min_curvature) / 2 / mean - 1).mean())
    assert errors[0] > 1.7 * errors[1] > 2.5 * errors[2]
    assert errors[2] < 0.01


def test_a_ball_is_convex_and_its_inside_is_not():
    outside = sphere(4, radius=2.0)
    inside = TriangleMesh(outside.vertices, outside.faces[:, ::-1])
    assert_allclose(principal_curvatures(outside).max_curvature, 0.5, rtol=0.03)
    assert_allclose(principal_curvatures(inside).max_curvature, -0.5, rtol=0.03)
    assert (dihedral_angles(outside) > 0).all()


@pytest.mark.parametrize("mesh", [torus(), cylinder(), rectangle(n=6), sphere(3), ellipsoid(subdivisions=3)], ids=repr)
def test_frames_are_orthonormal_right_handed_and_tangent(mesh):
    frames = principal_curvatures(mesh)
    triad = np.stack([frames.max_direction, frames.min_direction, frames.normals], axis=1)
    assert_allclose(triad @ triad.transpose(0, 2, 1), np.broadcast_to(np.eye(3), triad.shape), atol=1e-12)
    assert_allclose(np.linalg.det(triad), 1, atol=1e-12)
    assert_allclose(frames.normals, mesh.face_normals)
    assert (np.abs(frames.max_curvature) >= np.abs(frames.min_curvature)).all()
    assert ((frames.confidence >= 0) & (frames.confidence <= 1)).all()


def test_directions_are_ordered_by_absolute_curvature_where_a_surface_is_hollow():
    """Inside a torus's hole the curvature around is negative, and at the innermost circle it is -1/(R - r)."""
    mesh = torus(major=1.0, minor=0.7, around=120, through=80)  # |−1/0.3| beats 1/0.7 at the inside
    inner = np.hypot(*face_centres(mesh)[:, :2].T) < 0.32
    frames = principal_curvatures(mesh)
    assert (frames.max_curvature[inner] < 0).all()
    assert (frames.min_curvature[inner] > 0).all()
    assert np.abs(frames.max_direction[inner, 2]).max() < 0.1  # around the axis


def test_curvature_scales_as_one_over_length_and_directions_turn_with_the_shape():
    mesh = ellipsoid(subdivisions=3)
    rotation = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    rotation *= np.linalg.det(rotation)
    moved = TriangleMesh(1000.0 * mesh.vertices @ rotation.T + [5, -3, 2], mesh.faces)
    before, after = principal_curvatures(mesh), principal_curvatures(moved)
    assert_allclose(after.max_curvature, before.max_curvature / 1000, rtol=1e-8)
    assert_allclose(after.confidence, before.confidence, atol=1e-8)
    sure = before.confidence > 0.1
    turned = before.max_direction[sure] @ rotation.T
    assert degrees_between_axes(after.max_direction[sure], turned).max() < 1e-4


def test_a_boundary_does_not_flatten_what_bends_there():
    """Half a cylinder, cut along its axis: the faces at the cut lack one bent edge each."""
    whole = cylinder(around=96, along=24)
    half = whole.vertices[whole.faces][:, :, 0].min(axis=1) > -1e-9
    frames = principal_curvatures(TriangleMesh(whole.vertices, whole.faces[half]))
    assert_allclose(frames.max_curvature, 1, rtol=1e-3)


def test_a_plane_gets_one_direction_and_no_confidence():
    frames = principal_curvatures(rectangle(2.0, 3.0, n=8))
    assert frames.confidence.max() < 1e-6
    assert_allclose(np.abs(frames.max_direction @ [0, 1, 0]), 1, atol=1e-6)  # its longest axis


def test_flat_ends_continue_the_direction_of_the_bend_between_them():
    """A strip bent into a quarter cylinder with flat ends: the directions run on into the flat parts."""
    flat = rectangle(4.0, 1.0, n=12)
    s = flat.vertices[:, 0] - 2
    angle = np.clip(s, -np.pi / 4, np.pi / 4)
    rest = s - angle
    x = np.sin(angle) + rest * np.cos(angle)
    z = np.cos(angle) - rest * np.sin(angle)
    mesh = TriangleMesh(np.stack([x, flat.vertices[:, 1], z], axis=1), flat.faces)
    frames = principal_curvatures(mesh)
    assert (frames.confidence < 0.1).any()
    assert np.abs(frames.max_direction[:, 1]).max() < 0.02


def test_faces_without_area_have_no_frame_and_spoil_no_neighbour():
    mesh = cylinder(around=48)
    faces = np.concatenate([mesh.faces, [[0, 1, 1], [5, 6, 5]]])
    frames = principal_curvatures(TriangleMesh(mesh.vertices, faces))
    assert not frames.max_direction[-2:].any()
    assert not frames.confidence[-2:].any()
    assert_allclose(frames.max_curvature[:-2], principal_curvatures(mesh).max_curvature, rtol=1e-9)
