"""Pictures of shapes: what is nearest is seen, at its place, in its colour."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.drawing.camera import Camera
from add_core.drawing.level_lines import level_lines, seen_faces
from add_core.drawing.picture import draw_shape
from add_core.drawing.raster import rasterise
from add_core.drawing.skylight import sky_share
from add_core.errors import ParameterError
from add_core.geometry import PointCloud, TriangleMesh
from add_core.geometry.shapes import sphere

FRONT = Camera.facing("+z", "-y")


def test_a_triangle_covers_the_pixels_whose_centres_it_holds_each_weighted_to_its_place():
    places = np.array([[0.0, 0.0, 0.0], [0.0, 10.0, 1.0], [10.0, 0.0, 2.0]])
    seen = rasterise(places, np.array([[0, 1, 2]]), 10, 10)
    row, column = np.divmod(seen.pixels, 10)
    assert {(r, c) for r, c in zip(row, column, strict=True)} == {
        (r, c) for r in range(10) for c in range(10) if r + c + 1 <= 10
    }
    assert_allclose(seen.weights @ places[:, :2], np.stack([column, row], axis=1) + 0.5, atol=1e-12)
    assert_allclose(seen.depth[seen.pixels], seen.weights @ places[:, 2], atol=1e-12)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_the_nearest_triangle_is_seen_whichever_comes_first(order):
    square = np.array([[0.0, 0.0, 0.0], [0.0, 8.0, 0.0], [8.0, 0.0, 0.0]])
    places = np.concatenate([square, square + np.array([0.0, 0.0, 1.0])])
    faces = np.array([[0, 1, 2], [3, 4, 5]])[list(order)]
    seen = rasterise(places, faces, 8, 8)
    assert set(seen.faces) == {order.index(1)}


def test_the_back_of_a_triangle_is_seen_on_request_only():
    places = np.array([[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]])
    face = np.array([[0, 1, 2]])
    assert len(rasterise(places, face, 8, 8).pixels) == 0
    assert len(rasterise(places, face, 8, 8, back_faces=True).pixels) > 20


def test_parts_outside_the_picture_are_cut_off():
    places = np.array([[-50.0, -50.0, 0.0], [-50.0, 60.0, 0.0], [60.0, -50.0, 0.0]])
    assert len(rasterise(places, np.array([[0, 1, 2]]), 4, 3).pixels) == 12


def test_a_face_looks_at_the_camera_with_its_left_on_the_right():
    """Shipped people look along -y with their left at +x."""
    right, up, near = FRONT.seen(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]))
    assert_allclose(right, [1, 0, 0], atol=1e-15)
    assert_allclose(up, [0, 1, 0], atol=1e-15)
    assert_allclose(near, [0, 0, 1], atol=1e-15)
    turned = Camera.facing("+z", "-y", azimuth=90, elevation=30)
    assert_allclose(turned.axes @ turned.axes.T, np.eye(3), atol=1e-15)
    assert turned.seen(np.array([1.0, 0.0, 0.0]))[2] == pytest.approx(np.cos(np.radians(30)))
    assert turned.seen(np.array([0.0, 0.0, 1.0]))[0] == pytest.approx(0.0)


def test_a_ball_is_a_disc_of_its_own_area_at_its_own_place():
    picture = draw_shape(sphere(), FRONT, resolution=60)
    left, right, bottom, top = picture.extent
    height, width = picture.rgba.shape[:2]
    assert (right - left) / width == pytest.approx(1 / 60)
    assert (top - bottom) / height == pytest.approx(1 / 60)
    cover = picture.rgba[..., 3] / 255
    assert cover.sum() / 60**2 == pytest.approx(np.pi, rel=0.01)
    columns = left + (np.arange(width) + 0.5) / 60
    assert (cover.sum(axis=0) @ columns) / cover.sum() == pytest.approx(0.0, abs=0.01)


def test_colours_and_places_on_a_map_come_out_where_the_vertices_are():
    mesh = sphere()
    east = mesh.vertices[:, 0] > 0
    red_east = np.where(east[:, None], [0.9, 0.1, 0.1], [0.1, 0.1, 0.9])
    ramp = np.array([[0.1, 0.1, 0.9], [0.9, 0.1, 0.1]])
    by_colour = draw_shape(mesh, FRONT, resolution=30, colours=red_east).rgba.astype(int)
    by_place = draw_shape(mesh, FRONT, resolution=30, positions=east.astype(float), colour_map=ramp).rgba.astype(int)
    middle, width = by_colour.shape[0] // 2, by_colour.shape[1]
    for picture in (by_colour, by_place):
        assert picture[middle, width // 4, 2] > 2 * picture[middle, width // 4, 0]
        assert picture[middle, 3 * width // 4, 0] > 2 * picture[middle, 3 * width // 4, 2]


def test_a_cloud_hides_its_far_side():
    """Blue in front, red behind: through the gaps between the discs nothing red is seen."""
    mesh = sphere(3)
    cloud = PointCloud(mesh.vertices, mesh.vertex_normals)
    colours = np.where(mesh.vertices[:, 1:2] < 0, [0.1, 0.1, 0.9], [0.9, 0.1, 0.1])
    rgba = draw_shape(cloud, FRONT, resolution=80, colours=colours).rgba.astype(int)
    inner = rgba[40:-40, 40:-40][rgba[40:-40, 40:-40, 3] > 200]
    assert len(inner) > 1000
    assert (inner[:, 2] > inner[:, 0]).all()


def test_a_convex_body_sees_the_whole_sky_and_a_cup_does_not():
    convex = sphere(3)
    assert sky_share(convex, directions=32).min() > 0.9
    inside = TriangleMesh(convex.vertices, convex.faces[:, ::-1])
    assert sky_share(inside, directions=32).max() < 0.2


def test_level_lines_run_where_the_value_is_and_on_the_seen_side():
    mesh = sphere(3)
    height = mesh.vertices[:, 2]
    lines = level_lines(mesh, height, 0.3, seen_faces(mesh, FRONT))
    assert_allclose(lines[..., 2], 0.3, atol=1e-12)
    assert lines[..., 1].max() < 0.25  # the camera is at -y
    length = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum()
    assert length == pytest.approx(np.pi * np.sqrt(1 - 0.3**2), rel=0.05)


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        ({"resolution": 0}, "resolution must be finite and greater than 0"),
        ({"resolution": 1e6}, "Choose a lower one."),
        ({"colours": np.zeros((3, 3))}, "must be given for 162 vertices, but there are 3."),
        ({"positions": np.full(162, np.nan)}, "positions must be finite"),
        ({"positions": np.zeros(162), "colours": np.zeros((162, 3))}, "but both were given."),
    ],
)
def test_what_cannot_be_drawn_is_refused_with_the_reason(options, complaint):
    with pytest.raises(ParameterError, match=complaint.replace("(", r"\(").replace(".", r"\.")):
        draw_shape(sphere(2), FRONT, **{"resolution": 10} | options)


def test_an_axis_that_is_none_is_refused():
    with pytest.raises(ParameterError, match="up must be one of '\\+x'"):
        Camera.facing("z", "-y")
