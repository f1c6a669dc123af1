"""Distances on planes and spheres, where they are known, and on meshes with one defect each."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ParameterError
from add_core.geometry import PointCloud, TriangleMesh, geodesic_distances, subsample
from add_core.geometry.shapes import rectangle, sphere
from add_core.io import humans


def straight(shape, source):
    return np.linalg.norm(shape.vertices - shape.vertices[source], axis=1)


def test_distances_on_a_plane_are_straight_lines():
    mesh = rectangle(2.0, 1.0, n=8)
    assert_allclose(geodesic_distances(mesh, 5)[0], straight(mesh, 5), atol=1e-12)


def test_distances_on_a_sphere_are_angles():
    mesh = sphere(4)
    expected = np.arccos(np.clip(mesh.vertices[[3, 900]] @ mesh.vertices.T, -1, 1))
    assert_allclose(geodesic_distances(mesh, [3, 900]), expected, atol=3e-3)


def test_paths_along_edges_stay_within_their_stated_error():
    mesh = sphere(4)
    expected = np.arccos(np.clip(mesh.vertices[3] @ mesh.vertices.T, -1, 1))
    assert_allclose(geodesic_distances(mesh, 3, method="edges")[0], expected, rtol=0.08)


def test_distances_on_a_cloud_follow_the_surface():
    cloud = PointCloud(sphere(4).vertices)
    expected = np.arccos(np.clip(cloud.points[7] @ cloud.points.T, -1, 1))
    assert_allclose(geodesic_distances(cloud, 7)[0], expected, rtol=0.03)


def test_paths_on_a_cloud_do_not_jump_between_walls_that_face_each_other():
    sheet = rectangle(n=12).vertices
    folded = np.vstack([sheet, sheet + np.array([0, 0, 0.05])])  # nearer than neighbours on one sheet are
    cloud = PointCloud(folded, np.repeat([[0, 0, 1.0], [0, 0, -1.0]], len(sheet), axis=0))
    assert np.isinf(geodesic_distances(cloud, 0)[0, len(sheet) :]).all()


def test_paths_on_a_cloud_of_a_person_take_no_short_cuts():
    """He walks: hands and feet come near other parts, and 4,000 points are as far apart as his fingers are thick."""
    mesh = humans()[33]
    sample = subsample(mesh, 4000)
    sources = np.arange(0, 4000, 500)
    exact = geodesic_distances(mesh, sample.indices[sources])[:, sample.indices]
    error = (geodesic_distances(sample.cloud, sources) - exact) / exact.max()
    assert error.min() > -0.04
    assert np.quantile(np.abs(error), 0.95) < 0.02


def test_points_of_a_cloud_in_one_place_are_no_distance_apart():
    ball = sphere(2).vertices
    distances = geodesic_distances(PointCloud(np.vstack([ball, ball[:9]])), [5, 167])
    assert_array_equal(distances[0], distances[1])
    assert_array_equal(distances[:, 167], [0, 0])


def test_each_source_has_a_row():
    mesh = sphere(2)
    both = geodesic_distances(mesh, [4, 11])
    assert both.shape == (2, 162)
    assert both[0, 11] == pytest.approx(both[1, 4], rel=1e-12)
    assert_array_equal(both[1], geodesic_distances(mesh, np.int64(11))[0])


@pytest.mark.parametrize("unit", [1e-6, 1e6])
@pytest.mark.parametrize("method", ["exact", "edges"])
def test_distances_scale_with_the_unit_of_length(unit, method):
    mesh = sphere(2)
    scaled = TriangleMesh(unit * mesh.vertices + unit, mesh.faces)
    expected = unit * geodesic_distances(mesh, 0, method=method)
    assert_allclose(geodesic_distances(scaled, 0, method=method), expected, rtol=1e-9, atol=1e-9 * unit)


@pytest.mark.parametrize("method", ["exact", "edges"])
def test_no_path_leads_to_other_components_and_unreferenced_vertices(method):
    ball = sphere(2)
    vertices = np.vstack([[[9.0, 9.0, 9.0]], ball.vertices, ball.vertices + 5.0])
    mesh = TriangleMesh(vertices, np.vstack([ball.faces + 1, ball.faces + 163]))
    distances = geodesic_distances(mesh, [0, 1, 163], method=method)
    assert_array_equal(np.isfinite(distances[0]), np.arange(325) == 0)
    assert_array_equal(np.isfinite(distances[1]), (np.arange(325) >= 1) & (np.arange(325) < 163))
    assert_array_equal(np.isfinite(distances[2]), np.arange(325) >= 163)
    assert_allclose(distances[2, 163:], distances[1, 1:163], rtol=1e-9)


def with_defect(defect):
    sheet = rectangle(n=6)
    vertices, faces, n = sheet.vertices, sheet.faces, sheet.vertex_count
    a, b, c = faces[20]
    rest = np.delete(faces, 20, axis=0)
    if defect == "duplicate face":
        return vertices, np.vstack([faces, faces[3:4]])
    if defect == "flipped face":
        return vertices, np.vstack([rest, [[a, c, b]]])
    if defect == "face of one repeated vertex":
        return vertices, np.vstack([faces, [[a, a, b]]])
    if defect == "collinear face":
        middle = (vertices[a] + vertices[b]) / 2
        return np.vstack([vertices, middle]), np.vstack([rest, [[a, n, c], [n, b, c], [a, b, n]]])
    if defect == "two vertices in one place":
        return np.vstack([vertices, vertices[a]]), np.vstack([rest, [[a, b, n], [n, b, c], [a, n, c]]])
    raise AssertionError(defect)


@pytest.mark.parametrize(
    "defect",
    ["duplicate face", "flipped face", "face of one repeated vertex", "collinear face", "two vertices in one place"],
)
def test_defects_that_leave_the_plane_a_plane_leave_its_distances(defect):
    mesh = TriangleMesh(*with_defect(defect))
    assert_allclose(geodesic_distances(mesh, 3)[0], straight(mesh, 3), atol=1e-9)


def test_where_three_faces_share_an_edge_paths_follow_edges(caplog):
    sheet = rectangle(n=20)
    fin = np.array([[0.5, 0.5, 0.4]])
    mesh = TriangleMesh(np.vstack([sheet.vertices, fin]), np.vstack([sheet.faces, [[220, 221, 441]]]))
    distances = geodesic_distances(mesh, 0)[0]
    assert "no manifold" in caplog.text
    assert_allclose(distances[:441], straight(mesh, 0)[:441], rtol=0.09)
    assert_array_equal(distances, geodesic_distances(mesh, 0, method="edges")[0])


def test_a_path_leads_through_a_vertex_that_alone_joins_two_sheets():
    sheet = rectangle(n=6).vertices
    faces = rectangle(n=6).faces
    other = np.where(faces == 0, 48, faces + 48)  # the second sheet's first corner is the first one's last
    mesh = TriangleMesh(np.vstack([sheet, sheet[1:] + np.array([1.0, 1.0, 0.0])]), np.vstack([faces, other]))
    assert_allclose(geodesic_distances(mesh, 0)[0, -1], 2 * np.sqrt(2.0), rtol=0.09)


@st.composite
def ruined_meshes(draw):
    """Good and bad meshes: faces at random, doubled, turned, left out, of coinciding vertices, flat, in any unit."""
    rng = np.random.default_rng(draw(st.integers(0, 2**31)))
    mesh = draw(st.sampled_from([rectangle(n=3), sphere(1)]))
    vertices, faces = mesh.vertices.copy(), mesh.faces.copy()
    if draw(st.booleans()):
        faces[rng.integers(len(faces), size=2)] = rng.integers(0, len(vertices), (2, 3))
    if draw(st.booleans()):
        faces = faces[rng.random(len(faces)) < 0.7]
    if draw(st.booleans()):
        turned = rng.random(len(faces)) < 0.3
        faces[turned] = faces[turned][:, ::-1]
    if draw(st.booleans()):
        vertices[rng.integers(0, len(vertices), 5)] = vertices[rng.integers(0, len(vertices), 5)]
    vertices *= draw(st.sampled_from([(1, 1, 1), (1, 1, 0), (1, 1e-9, 0), (1, 0, 0), (0, 0, 0)]))
    return TriangleMesh(vertices * draw(st.sampled_from([1e-6, 1.0, 1e6])), np.vstack([faces, [[0, 1, 2]]]))


@settings(max_examples=200, deadline=None)
@given(mesh=ruined_meshes())
def test_any_mesh_has_sound_distances(mesh):
    exact, along = (geodesic_distances(mesh, [0, 5], method=method) for method in ("exact", "edges"))
    size = np.ptp(mesh.vertices, axis=0).max()
    assert_array_equal(np.isfinite(exact), np.isfinite(along))
    assert (exact <= along + 1e-6 * size).all()
    for row, source in enumerate([0, 5]):
        assert (exact[row] >= straight(mesh, source) - 1e-6 * size).all()


def test_a_triangle_is_a_mesh_too():
    mesh = TriangleMesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    assert_allclose(geodesic_distances(mesh, [0, 1, 2]), [[0, 3, 4], [3, 0, 5], [4, 5, 0]], atol=1e-12)


@pytest.mark.parametrize(
    ("sources", "message"),
    [
        (162, "sources must be from 0 to 161, but it is 162"),
        ([3, -1], "sources must be from 0 to 161, but it is -1"),
        ("all", "sources must be a vertex number, but it is 'all'"),
        ([], "sources must name at least one vertex, but it is empty"),
        (1.5, "sources must be a vertex number, but it is 1.5"),
    ],
)
def test_sources_must_be_vertices(sources, message):
    with pytest.raises(ParameterError, match=message):
        geodesic_distances(sphere(2), sources)


def test_an_unknown_method_is_refused():
    with pytest.raises(ParameterError, match="method must be one of 'exact', 'edges', but it is 'dijkstra'"):
        geodesic_distances(sphere(1), 0, method="dijkstra")


def test_importing_the_geometry_loads_no_geodesic_library():
    code = "import sys, add_core.geometry; print([m for m in sys.modules if 'pygeodesic' in m])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
