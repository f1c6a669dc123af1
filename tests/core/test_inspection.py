"""One defect at a time: it is found, counted, and its first place named; repairing changes faces alone."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from add_core.errors import GeometryError
from add_core.geometry import PointCloud, TriangleMesh, inspect, repair
from add_core.geometry.shapes import rectangle, sphere

BALL = sphere(2)
SHEET = rectangle(2.0, 1.0, n=4)


def moebius(n: int = 12) -> TriangleMesh:
    """A strip of n quads, closed after half a turn."""
    angle = np.arange(n) * 2 * np.pi / n
    side = (
        np.stack([np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)], axis=1) / 3
    )
    middle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    k = np.arange(n)
    low, high = k, k + n
    low_next, high_next = np.where(k + 1 < n, k + 1, n), np.where(k + 1 < n, k + 1 + n, 0)
    faces = np.concatenate([np.stack([low, low_next, high], axis=1), np.stack([high, low_next, high_next], axis=1)])
    return TriangleMesh(np.concatenate([middle - side, middle + side]), faces)


def with_faces(mesh, faces) -> TriangleMesh:
    return TriangleMesh(mesh.vertices, faces)


def turned(mesh, which) -> TriangleMesh:
    faces = mesh.faces.copy()
    faces[which] = faces[which][:, ::-1]
    return with_faces(mesh, faces)


def two_tetrahedra(shared: int) -> TriangleMesh:
    """Two tetrahedra that share one vertex, or two and the edge between them."""
    solid = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    # Turned about the shared edge, or mirrored in the shared vertex, which turns the faces inside out.
    others = (corners * ([1, -1, -1] if shared == 2 else [-1, -1, -1]))[shared:]
    number = np.concatenate([np.arange(shared), np.arange(4, 8 - shared)])
    other_faces = number[solid if shared == 2 else solid[:, ::-1]]
    return TriangleMesh(np.concatenate([corners, others]), np.concatenate([solid, other_faces]))


def fan_of_three() -> TriangleMesh:
    """Three triangles at one edge."""
    corners = [[0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 1, 0], [-1, -1, 0]]
    return TriangleMesh(corners, [[0, 1, 2], [0, 1, 3], [0, 1, 4]])


DEFECTS = {
    "unreferenced vertices": (
        TriangleMesh(np.vstack([BALL.vertices, [9, 9, 9]]), BALL.faces),
        1,
        "vertex",
        len(BALL.vertices),
    ),
    "faces without area": (with_faces(SHEET, np.vstack([SHEET.faces, [0, 1, 2]])), 1, "face", len(SHEET.faces)),
    "repeated faces": (with_faces(BALL, np.vstack([BALL.faces, BALL.faces[7, [1, 2, 0]]])), 1, "face", len(BALL.faces)),
    "edges of more than two faces": (fan_of_three(), 1, "edge", 0),
    "pinched vertices": (two_tetrahedra(1), 1, "vertex", 0),
    "faces turned against their neighbours": (turned(BALL, [4, 9]), 2, "face", 4),
    "faces turned inward": (turned(BALL, np.arange(len(BALL.faces))), len(BALL.faces), "face", 0),
    "faces without two sides": (moebius(), 24, "face", 0),
    "vertices at the place of an earlier one": (
        TriangleMesh(
            np.vstack([SHEET.vertices, SHEET.vertices + np.array([2, 0, 0])]),
            np.vstack([SHEET.faces, SHEET.faces + SHEET.vertex_count]),
        ),
        5,
        "vertex",
        None,
    ),
}


@pytest.mark.parametrize("kind", DEFECTS)
def test_a_single_defect_is_found_and_counted(kind):
    mesh, count, element, first = DEFECTS[kind]
    found = {defect.kind: defect for defect in inspect(mesh).defects}
    assert kind in found
    assert (found[kind].count, found[kind].element) == (count, element)
    if first is not None:
        assert found[kind].first == first
    assert str(found[kind]).startswith(f"{kind}: {count} (first: {element}")


@pytest.mark.parametrize(
    "kind", ["unreferenced vertices", "pinched vertices", "faces turned inward", "faces without two sides"]
)
def test_one_defect_is_not_reported_as_another(kind):
    assert [defect.kind for defect in inspect(DEFECTS[kind][0]).defects] == [kind]


@pytest.mark.parametrize("mesh", [BALL, SHEET])
def test_a_sound_mesh_has_no_defects_and_repairing_returns_it(mesh):
    assert inspect(mesh).defects == ()
    assert repair(mesh).mesh is mesh
    assert repair(mesh).messages == ()


def test_counts_and_measures_of_a_sheet():
    report = inspect(SHEET)
    assert (report.components, report.boundary_loops, report.boundary_edges) == (1, 1, 24)
    assert report.euler_characteristic == 1
    assert report.area == pytest.approx(2.0)
    assert report.volume is None
    assert report.diagonal == pytest.approx(np.sqrt(5.0))


def test_two_pieces_and_a_loose_vertex_are_two_components():
    vertices = np.vstack([BALL.vertices, BALL.vertices + 5, [99, 0, 0]])
    report = inspect(TriangleMesh(vertices, np.vstack([BALL.faces, BALL.faces + len(BALL.vertices)])))
    assert report.components == 2
    assert report.volume == pytest.approx(2 * inspect(BALL).volume)


def test_volume_is_negative_inside_out_and_independent_of_place():
    far = TriangleMesh(BALL.vertices + 1e4, BALL.faces[:, ::-1])
    assert inspect(far).volume == pytest.approx(-inspect(BALL).volume, rel=1e-6)


def test_a_cloud_reports_coincident_points():
    report = inspect(PointCloud([[0, 0, 0], [1, 0, 0], [0, 0, 0]]))
    assert report.faces is None
    assert [(defect.count, defect.first) for defect in report.defects] == [(1, 2)]


@pytest.mark.parametrize("seed", range(5))
def test_repairing_undoes_any_mixture_of_turned_flat_and_repeated_faces(seed):
    rng = np.random.default_rng(seed)
    faces = np.vstack(
        [BALL.faces, BALL.faces[rng.integers(0, 80, 5)], np.repeat(rng.integers(0, 40, (4, 1)), 3, axis=1)]
    )
    which = rng.random(len(BALL.faces)) < 0.7
    which = np.concatenate([which, np.zeros(9, dtype=bool)])
    spoilt = TriangleMesh(BALL.vertices, np.where(which[:, None], faces[:, [0, 2, 1]], faces))
    done = repair(spoilt)
    assert_array_equal(done.mesh.vertices, BALL.vertices)
    assert (done.flat_faces, done.repeated_faces) == (4, 5)
    assert inspect(done.mesh).volume == pytest.approx(inspect(BALL).volume)
    assert done.remaining == ()
    assert done.messages[0] == "4 faces without area dropped."


@pytest.mark.parametrize("which", [0, 3])
def test_repairing_turns_the_fewer_faces_of_an_open_sheet(which):
    done = repair(turned(SHEET, [which]))
    assert_array_equal(np.sort(done.mesh.faces), np.sort(SHEET.faces))
    assert done.turned_faces == 1
    assert (done.mesh.face_normals[:, 2] > 0).all()


def test_repairing_leaves_what_needs_a_choice():
    strip = moebius()
    done = repair(strip)
    assert done.mesh is strip
    assert [defect.kind for defect in done.remaining] == ["faces without two sides"]


def test_repairing_needs_one_face_with_an_area():
    line = TriangleMesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    with pytest.raises(GeometryError, match="none of the 1 faces has an area"):
        repair(line)


def test_a_report_is_plain_values():
    import json

    assert (
        json.loads(json.dumps(inspect(two_tetrahedra(2)).as_dict()))["defects"][0]["kind"]
        == "edges of more than two faces"
    )
