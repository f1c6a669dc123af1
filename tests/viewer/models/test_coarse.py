"""The stand-in of a large shape: where the shape is, facing as it does, and never for small ones."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.geometry import PointCloud
from add_core.geometry.shapes import torus
from add_viewer.models import coarse
from add_viewer.models.coarse import coarse_of

LARGE = torus(major=1.0, minor=0.4, around=160, through=80)


@pytest.fixture(autouse=True)
def lower(monkeypatch):
    monkeypatch.setattr(coarse, "MOST_DRAWN", 1000)
    monkeypatch.setattr(coarse, "_WANTED", 800)


def test_a_mesh_keeps_its_surface_with_far_fewer_vertices():
    found = coarse_of(LARGE)
    assert 400 < found.shape.vertex_count < 1600
    assert_array_equal(found.shape.vertices, LARGE.vertices[found.kept])
    assert found.shape.face_areas.sum() == pytest.approx(LARGE.face_areas.sum(), rel=0.1)
    agree = (found.shape.vertex_normals * LARGE.vertex_normals[found.kept]).sum(axis=1)
    assert np.median(agree) > 0.95


def test_a_cloud_keeps_points_with_their_normals():
    cloud = PointCloud(LARGE.vertices, normals=LARGE.vertex_normals)
    found = coarse_of(cloud)
    assert_array_equal(found.shape.points, cloud.points[found.kept])
    assert_allclose(found.shape.normals, cloud.normals[found.kept], atol=1e-12)


def test_small_shapes_are_drawn_themselves():
    assert coarse_of(torus(major=1.0, minor=0.4, around=20, through=10)) is None
