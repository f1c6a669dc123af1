"""The shapes that ship: closed, turned outward, in metres, standing upright, with exact maps between them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import ParameterError
from add_core.geometry import inspect
from add_core.io import clouds, dogs, humans, known_matches, poses, remeshed, shipped_place

COLLECTIONS = {"humans": (humans, 100, 6890), "poses": (poses, 71, 12166), "dogs": (dogs, 40, 6890)}


@pytest.fixture(params=COLLECTIONS)
def shipped(request):
    make, shapes, vertices = COLLECTIONS[request.param]
    return make(), shapes, vertices


def test_counts_and_names(shipped):
    collection, shapes, vertices = shipped
    assert len(collection) == shapes == len(set(collection.names))
    assert collection[3].vertex_count == vertices
    assert collection[3].name == collection.names[3]
    assert collection[-1].name == collection.names[-1]
    assert humans().names[3] == "person 1, walk"
    assert humans().subjects[99] == "person 10"


def test_the_surface_is_closed_oriented_and_without_defects(shipped):
    collection, shapes, _ = shipped
    report = inspect(collection[0])
    assert report.defects == ()
    assert report.volume > 0
    assert (report.boundary_edges, report.components, report.euler_characteristic) == (0, 1, 2)
    # The others have the same faces; their areas and volumes are left to see.
    for index in range(1, shapes):
        mesh = collection[index]
        assert_array_equal(mesh.faces, collection[0].faces)
        assert mesh.has_area.all()
        corners = mesh.vertices[mesh.faces]
        volume = np.linalg.det(corners).sum() / 6
        assert 0.5 * report.volume < volume < 2.0 * report.volume


def test_every_shape_stands_upright_in_metres(shipped):
    collection, _, _ = shipped
    assert (collection.unit, collection.up) == ("m", "+z")
    size = np.ptp(collection[0].vertices, axis=0)
    if collection.title == "dogs":
        assert collection.front == "+x"
        assert 0.5 < size[2] < 1.0 < size[0] < 1.5
    else:
        assert collection.front == "-y"
        assert 1.6 < size[2] < 2.0
    assert collection[0].vertices[:, 2].min() == pytest.approx(0.0, abs=1e-3)


def test_people_look_along_their_front():
    """Toes are the part of a standing person's feet that is farthest from the shins."""
    vertices = humans()[0].vertices
    shins, feet = (
        vertices[(low < vertices[:, 2]) & (vertices[:, 2] < high), 1] for low, high in ((0.2, 0.3), (0.0, 0.05))
    )
    assert shins.mean() - feet.min() > 2 * (feet.max() - shins.mean())


def test_dogs_look_along_their_front():
    vertices = dogs()[0].vertices
    assert vertices[vertices[:, 2] > 0.75, 0].mean() > vertices[:, 0].mean() + 0.2


def test_the_mirror_map_is_an_involution_that_keeps_the_faces(shipped):
    collection, _, vertices = shipped
    mirror = collection.symmetry
    assert_array_equal(mirror[mirror], np.arange(vertices))
    faces = {frozenset(face) for face in collection[0].faces.tolist()}
    assert {frozenset(face) for face in mirror[collection[0].faces].tolist()} == faces


def test_the_mirror_map_exchanges_left_and_right_of_a_symmetric_pose():
    mesh, mirror = dogs()[0], dogs().symmetry
    assert_allclose(mesh.vertices[mirror] * [1, -1, 1], mesh.vertices, atol=3e-5)


def test_correspondence_keeps_the_place_on_the_body(shipped):
    collection, _, vertices = shipped
    assert_array_equal(collection.correspondence(0, 5), np.arange(vertices))


def test_splits_are_disjoint_and_complete(shipped):
    collection, shapes, _ = shipped
    train, test = collection.split("train"), collection.split("test")
    assert_array_equal(np.sort(np.concatenate([train, test])), np.arange(shapes))


def test_people_are_split_by_subject_and_poses_as_scape_is():
    subjects = np.array(humans().subjects)
    assert set(subjects[humans().split("train")]) == {f"person {k}" for k in range(1, 9)}
    assert set(subjects[humans().split("test")]) == {"person 9", "person 10"}
    assert_array_equal(poses().split("train"), np.arange(10, 71))
    with pytest.raises(ParameterError, match="part must be one of 'train', 'test', but it is 'all'"):
        humans().split("all")


def test_there_is_no_shape_beyond_the_last():
    with pytest.raises(IndexError, match="humans has shapes 0 to 99, but 100 was asked for"):
        humans()[100]
    assert sum(1 for _ in dogs()) == 40


@pytest.mark.parametrize("make", [remeshed, clouds])
def test_variants_of_the_test_people_lie_on_them(make):
    collection = make()
    assert len(collection) == 20 == len(set(collection.names))
    assert collection.template == "humans"
    assert collection.split("test").tolist() == list(range(20))
    for index in (0, 13):
        shape, landmarks = collection[index], collection.landmarks(index)
        original = humans()[humans().names.index(collection.names[index].rpartition(", ")[0])]
        gap = np.linalg.norm(original.vertices[landmarks.places] - shape.vertices, axis=1)
        assert gap.max() < 0.04  # metres: places are the nearest vertices
    match = collection.correspondence(0, 13)
    assert match.shape == (collection[0].vertex_count,)
    assert (match >= 0).mean() > 0.3


def test_true_matches_between_people_of_one_meshing_and_of_others():
    person, other, cloud, dog = (shipped_place(name) for name in ("humans/80", "humans/3", "clouds/0", "dogs/0"))
    assert_array_equal(known_matches(person, other), np.arange(6890))
    assert known_matches(person, dog) is None
    points, body = cloud.collection[0].vertices, person.collection[80].vertices
    assert_allclose(body[known_matches(person, cloud)], points, atol=1e-9)  # a cloud's points are vertices of the body
    back = known_matches(cloud, person)
    assert np.linalg.norm(points[back] - body, axis=1).max() < 0.1
