"""Poses carried from body to body: exact where truth is known, refused where none is."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from add_core.errors import ParameterError
from add_core.geometry import TriangleMesh
from add_core.io import humans
from add_core.learning.pose_transfer import between, deform, deformation


def centred(mesh: TriangleMesh) -> np.ndarray:
    return mesh.vertices - mesh.vertices.mean(axis=0)


def turned(mesh: TriangleMesh, turn: Rotation) -> TriangleMesh:
    return TriangleMesh(turn.apply(mesh.vertices.copy()), mesh.faces)


@pytest.fixture(scope="module")
def people():
    return humans()


def test_a_body_takes_its_own_pose_exactly(people):
    found = deform(people[0], deformation(people[0], people[5]))
    assert np.abs(centred(found) - centred(people[5])).max() < 1e-10
    assert np.allclose(found.vertices.mean(axis=0), people[0].vertices.mean(axis=0))


def test_a_turn_is_carried_to_another_body(people):
    turn = Rotation.from_rotvec([0.3, -1.1, 0.4])
    found = deform(people[20], deformation(people[0], turned(people[0], turn)))
    assert np.abs(centred(found) - turn.apply(centred(people[20]))).max() < 1e-10


def test_another_body_comes_near_to_its_own_pose_and_keeps_its_build(people):
    found = deform(people[10], deformation(people[0], people[3]))
    edges = people[10].edges

    def lengths(mesh: TriangleMesh) -> np.ndarray:
        return np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1)

    own, other = lengths(people[13]), lengths(people[3])
    assert np.abs(lengths(found) - own).mean() < 0.4 * np.abs(other - own).mean()


def test_halfway_between_two_turns_is_half_the_turn(people):
    rest = people[0]
    first, second = Rotation.from_rotvec([0, 0, 0.4]), Rotation.from_rotvec([0, 0, 1.6])
    ends = [deformation(rest, turned(rest, turn)) for turn in (first, second)]
    for share, angle in ((0.0, 0.4), (0.5, 1.0), (1.0, 1.6)):
        wanted = Rotation.from_rotvec([0, 0, angle]).as_matrix()
        assert np.abs(between(*ends, share) - wanted).max() < 1e-10


def test_where_triangles_turn_round_nothing_is_mixed(people):
    rest = people[0]
    first = deformation(rest, people[1])
    opposite = deformation(rest, turned(rest, Rotation.from_rotvec([0, 0, np.pi])))
    assert between(first, opposite, 0.5) is first


def test_other_faces_are_refused(people):
    other = TriangleMesh(people[0].vertices, people[0].faces[:-1])
    with pytest.raises(ParameterError, match="faces"):
        deformation(people[0], other)
