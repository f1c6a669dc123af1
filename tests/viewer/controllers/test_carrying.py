"""Picks that follow a correspondence to other shapes. No Qt."""

from dataclasses import replace

import numpy as np
import pytest

from add_core.geometry import TriangleMesh
from add_viewer.controllers.carrying import CarryingController, carried_vertex, true_match
from add_viewer.controllers.opening import read_shape
from add_viewer.models.results import Results
from add_viewer.models.session import Session


@pytest.fixture
def parts(torus, make_torus):
    session, results = Session(), Results()
    controller = CarryingController(session, results)
    session.add_shape(make_torus("second"))
    session.add_shape(torus)
    return session, results, controller


def carried(results):
    return {key: [(pick.vertex, pick.slot) for pick in picks] for key, picks in results.carried.items()}


def test_shapes_that_share_their_faces_correspond_vertex_by_vertex(parts):
    session, results, _ = parts
    session.pick(7)
    session.pick(9, add=True)
    assert carried(results) == {"second": [(7, 0), (9, 1)]}
    session.pick(3, add=True, shape="second")  # now the source has its own picks, and the other its own
    assert carried(results) == {}


def test_shapes_of_other_faces_correspond_by_the_map_that_was_found_or_not_at_all(parts, torus):
    session, results, _ = parts
    mesh = torus.shape
    session.add_shape(replace(torus, key="third", shape=TriangleMesh(mesh.vertices, mesh.faces[::-1])))
    session.show_shape("torus")
    session.pick(7)
    assert set(results.carried) == {"second"}
    session.choose_field(kind="transfer")
    session.match(method="zoomout")
    assert results.carried == {}
    results.set_map("torus", "third", (np.arange(torus.vertex_count) + 1) % torus.vertex_count)
    assert carried(results) == {"third": [(6, 0)]}


def test_a_matching_moves_picks_only_while_it_is_in_sight_and_where_no_truth_is_known(parts, torus):
    session, results, _ = parts
    mesh, turned = torus.shape, (np.arange(torus.vertex_count) + 1) % torus.vertex_count
    session.add_shape(replace(torus, key="third", shape=TriangleMesh(mesh.vertices, mesh.faces[::-1])))
    session.show_shape("torus")
    session.pick(7)
    session.match(method="nearest")
    for target in ("second", "third"):
        results.set_map("torus", target, turned)
    assert carried(results) == {"second": [(7, 0)], "third": [(6, 0)]}
    session.choose_field(kind="error")
    assert carried(results) == {"second": [(6, 0)], "third": [(6, 0)]}
    session.choose_field(kind="heat")
    assert carried(results) == {"second": [(7, 0)], "third": [(6, 0)]}


def test_a_vertex_that_nothing_matches_goes_where_its_nearest_neighbour_goes():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    assert carried_vertex(1, vertices, np.array([2, 0, -1, 0])) in (0, 1)
    assert carried_vertex(2, vertices, np.array([0, 0, -1, 1])) == 3


def test_shipped_people_correspond_whatever_their_meshing():
    person, other, cloud = (read_shape(name) for name in ("humans/0", "remeshed/0", "clouds/11"))
    assert true_match(person, cloud).tolist() == cloud.places.tolist()
    assert true_match(cloud, other).shape == (other.vertex_count,)
    back = cloud.places[true_match(cloud, person)]
    neutral = person.shape.vertices
    assert np.linalg.norm(neutral[back] - neutral, axis=1).max() < 0.03  # of the geodesic diameter
    assert true_match(person, read_shape("dogs/0")) is None


def test_clouds_correspond_only_if_somebody_says_so(torus):
    from add_core.geometry import PointCloud

    cloud = replace(torus, shape=PointCloud(torus.shape.vertices))
    assert true_match(cloud, cloud) is None
    assert true_match(cloud, torus) is None
