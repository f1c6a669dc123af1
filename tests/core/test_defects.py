"""Imperfect shapes get a finite, correct answer or an explanation: never NaN, never another order of vertices."""

import logging

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from add_core.errors import GeometryError
from add_core.geometry import PointCloud, TriangleMesh, inspect, normalize, principal_curvatures
from add_core.geometry.shapes import cylinder, ellipsoid, sphere, torus
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import HeatFlow, compute_spectrum

BASES = {
    "ellipsoid": ellipsoid(subdivisions=2),
    "cylinder": cylinder(around=12, along=6),
    "torus": torus(around=16, through=8),
}


def unreferenced_vertex(mesh, k):
    return TriangleMesh(np.insert(mesh.vertices, k, [5.0, 5.0, 5.0], axis=0), mesh.faces + (mesh.faces >= k))


def face_with_a_repeated_vertex(mesh, k):
    i, j = mesh.faces[k % len(mesh.faces), :2]
    return TriangleMesh(mesh.vertices, np.insert(mesh.faces, k % len(mesh.faces), [i, i, j], axis=0))


def coincident_vertices(mesh, k):
    i, j, _ = mesh.faces[k % len(mesh.faces)]
    return TriangleMesh(
        np.vstack([mesh.vertices, mesh.vertices[i]]), np.vstack([mesh.faces, [i, mesh.vertex_count, j]])
    )


def collinear_face(mesh, k):
    i, j, _ = mesh.faces[k % len(mesh.faces)]
    middle = (mesh.vertices[i] + mesh.vertices[j]) / 2
    return TriangleMesh(np.vstack([mesh.vertices, middle]), np.vstack([mesh.faces, [i, mesh.vertex_count, j]]))


def duplicate_face(mesh, k):
    return TriangleMesh(mesh.vertices, np.vstack([mesh.faces, mesh.faces[k % len(mesh.faces)]]))


def flipped_face(mesh, k):
    faces = mesh.faces.copy()
    faces[k % len(faces)] = faces[k % len(faces), ::-1]
    return TriangleMesh(mesh.vertices, faces)


def fin_on_an_edge(mesh, k):
    i, j, _ = mesh.faces[k % len(mesh.faces)]
    return TriangleMesh(np.vstack([mesh.vertices, [0, 0, 3.0]]), np.vstack([mesh.faces, [i, j, mesh.vertex_count]]))


def two_components(mesh, k):
    return TriangleMesh(
        np.vstack([mesh.vertices, mesh.vertices + 5]), np.vstack([mesh.faces, mesh.faces + mesh.vertex_count])
    )


def hole(mesh, k):
    return TriangleMesh(mesh.vertices, np.delete(mesh.faces, k % len(mesh.faces), axis=0))


def tiny_unit(mesh, k):
    return TriangleMesh(1e-6 * mesh.vertices, mesh.faces)


def huge_unit(mesh, k):
    return TriangleMesh(1e6 * mesh.vertices, mesh.faces)


DEFECTS = (
    unreferenced_vertex, face_with_a_repeated_vertex, coincident_vertices, collinear_face, duplicate_face, flipped_face,
    fin_on_an_edge, two_components, hole, tiny_unit, huge_unit,
)  # fmt: skip


@settings(max_examples=120)
@given(
    base=st.sampled_from(sorted(BASES)),
    defect=st.sampled_from(DEFECTS),
    place=st.integers(0, 90),
    alpha=st.floats(0, 1e3),
    theta=st.floats(-7, 7),
    conductivity=st.sampled_from(["curvature", "constant"]),
)
def test_one_defect_leaves_everything_finite_and_true(base, defect, place, alpha, theta, conductivity):
    mesh = defect(BASES[base], place)
    logging.disable(logging.WARNING)
    laplacian = AnisotropicLaplacian(mesh, alpha=alpha, conductivity=conductivity)
    logging.disable(logging.NOTSET)
    stiffness = laplacian.stiffness(theta).toarray()
    assert_allclose(stiffness, stiffness.T, atol=1e-12 * np.abs(stiffness).max())
    assert np.linalg.eigvalsh(stiffness)[0] > -1e-11 * np.abs(stiffness).max()
    area = laplacian.mass.sum()
    source = int(np.argmax(laplacian.mass))
    kernel = HeatFlow(laplacian).kernel(source, theta=theta, time=0.01 * area)
    assert np.isfinite(kernel).all()
    assert_allclose(laplacian.mass @ kernel, 1, atol=1e-9)
    spectrum = compute_spectrum(laplacian, theta=theta, count=12)
    gram = spectrum.eigenfunctions.T @ (spectrum.mass[:, None] * spectrum.eigenfunctions)
    assert_allclose(gram, np.eye(12), atol=1e-8)
    assert np.array_equal(normalize(mesh).faces, mesh.faces)
    assert str(inspect(mesh))


@pytest.mark.parametrize(
    ("defect", "word"),
    [
        (unreferenced_vertex, "(first: vertex 7)"),
        (face_with_a_repeated_vertex, "area"),
        (duplicate_face, "repeated faces: 1 (first: face 320)"),
        (flipped_face, "turned"),
        (fin_on_an_edge, "more than two faces"),
    ],
)
def test_every_defect_is_reported_with_its_place(defect, word):
    report = inspect(defect(BASES["ellipsoid"], 7))
    assert any(word in str(found) for found in report.defects), [str(found) for found in report.defects]


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: TriangleMesh(np.full((3, 3), np.nan), [[0, 1, 2]]), "3 of 3 vertices are not finite"),
        (lambda: TriangleMesh(np.eye(3), [[0, 1, 3]]), r"faces must index into 3 vertices \(0 to 2\)"),
        (lambda: TriangleMesh(np.eye(3), [[1, 2, 3]]), "Are they 1-based"),
        (lambda: TriangleMesh(np.eye(4)[:, :3], [[0, 1, 2, 3]]), "Split quads into triangles"),
        (lambda: TriangleMesh(np.eye(3), np.zeros((0, 3), dtype=int)), "at least one triangle"),
        (lambda: TriangleMesh(np.eye(3), [[0.0, 1.0, 2.0]]), "faces must hold integers"),
        (lambda: TriangleMesh(1e100 * np.eye(3), [[0, 1, 2]]), "smaller than 1e"),
        (lambda: TriangleMesh(np.zeros((5, 2)), [[0, 1, 2]]), r"vertices must have shape \(n, 3\)"),
        (lambda: PointCloud([[np.inf, 0, 0]]), "1 of 1 points is not finite"),
        (lambda: PointCloud(np.eye(3), np.eye(3)[:2]), "one row for each of the 3 points"),
        (lambda: PointCloud(np.eye(3), np.zeros((3, 3))), "normals must have a length"),
        (lambda: AnisotropicLaplacian(TriangleMesh(np.zeros((3, 3)), [[0, 1, 2]])), "has no area"),
        (lambda: AnisotropicLaplacian(PointCloud(np.ones((20, 3)))), "has no area"),
        (lambda: normalize(PointCloud(np.ones((20, 3)))), "no extent"),
    ],
)
def test_what_cannot_be_mended_is_explained(build, message):
    with pytest.raises(GeometryError, match=message):
        build()


def test_the_smallest_shapes_work():
    triangle = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    assert compute_spectrum(AnisotropicLaplacian(triangle), count=3).eigenvalues[0] == 0
    cloud = PointCloud(sphere(0).vertices[:10])
    assert np.isfinite(principal_curvatures(cloud).max_direction).all()
    assert np.isfinite(compute_spectrum(AnisotropicLaplacian(cloud), count=10).eigenfunctions).all()
