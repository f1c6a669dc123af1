"""Bodies to train and to validate on, made from the shipped people, poses and dogs; the same for the same number.

Nothing is made from what is kept for tests: persons 9 and 10, poses 1 to 10, dogs 31 to 40.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from add_core.geometry import PointCloud, TriangleMesh, subsample
from add_core.io import dogs, humans, poses
from add_core.learning import TrainingShape
from add_core.learning.augmentation import bend, remesh, roughen
from add_core.learning.middles import Middles
from add_core.learning.pose_transfer import between, deform, deformation
from add_core.learning.variations import BEND, SCANNER, WAVELENGTH, blend, vary

UNCHANGED = 0.15
"""Share of the bodies that keep skin and meshing."""
BEYOND = 1.4
"""How far blends go from the mean body, 1 being the people themselves."""
REPOSED_FROM = 490
"""Bodies from this number on have a pose that another body took, and often a way towards a second one."""
FOREIGN_FROM = 980
"""Bodies from this number on are meshed by other programs: see `foreign_meshings`."""
VALIDATION = {
    "mesh": (61, 67, 72, 78),
    "remeshed": (64, 69, 70, 75),
    "cloud": (62, 65, 73, 79),
    "scan": (63, 68, 71, 76),
}
"""Persons 7 and 8 in all of their poses, each as it is or as another kind of data would have it."""


@cache
def people_middles() -> Middles:
    """Vertices and middles of edges of the people as places."""
    return Middles.of(humans()[0], humans().symmetry)


def people_positions() -> NDArray[np.float64]:
    """(P, 3): these places on the first person."""
    mesh = humans()[0]
    return np.concatenate([mesh.vertices, mesh.vertices[mesh.edges].mean(axis=1)])


@cache
def dog_middles() -> Middles:
    """Vertices and middles of edges of the dogs as places."""
    return Middles.of(dogs()[0], dogs().symmetry)


def person(number: int) -> TrainingShape:
    """A training body: one of the people, a blend of three in one pose, or person 1 in another pose; mostly varied.

    Even numbers leave out persons 7 and 8, so that they alone give a set that the validation people are new to. From
    REPOSED_FROM on, blends of three of all people in any pose that one of them took, always varied; from FOREIGN_FROM
    on, such blends or ones in a pose of the people, as other programs mesh them.
    """
    if number >= FOREIGN_FROM:
        return _foreign(number)
    if number >= REPOSED_FROM:
        return _reposed(number)
    subjects = range(6) if number % 2 == 0 else range(8)
    draw = np.random.default_rng([1, number])
    pose, kind = int(draw.integers(10)), draw.random()
    if kind < 0.25:
        mesh = humans()[10 * int(draw.choice(subjects if number % 2 == 0 else subjects[-2:])) + pose]
    elif kind < 0.5:
        mesh = _first_person_in(int(draw.choice(poses().split("train"))))
    else:
        mesh = _blend_in(pose, draw, subjects)
    return _perhaps_varied(mesh, draw, people_middles())


def _foreign(number: int) -> TrainingShape:
    from foreign_meshings import foreign  # needs a program that nothing else here does

    draw = np.random.default_rng([1, number])
    mesh = _in_another_pose(draw) if draw.random() < 0.5 else _blend_in(int(draw.integers(10)), draw, range(8))
    mesh = bend(mesh, amplitude=draw.uniform(*BEND), wavelength=draw.uniform(*WAVELENGTH), seed=number)
    item = foreign(mesh, draw)
    if draw.random() < 0.5 and isinstance(item.shape, TriangleMesh):
        skin = np.exp(draw.uniform(*np.log(SCANNER)))
        rough = roughen(item.shape, amplitude=float(skin), smoothing=int(draw.integers(0, 4)), seed=number)
        return TrainingShape(rough, item.places)
    return item


def _in_another_pose(draw: np.random.Generator) -> TriangleMesh:
    body = _blend_in(0, draw, range(8))
    first, second = _pose(draw), _pose(draw)
    return deform(body, between(first, second, draw.uniform(0.0, 0.5)))


def _reposed(number: int) -> TrainingShape:
    draw = np.random.default_rng([1, number])
    mesh = _in_another_pose(draw)
    item = TrainingShape(mesh, np.arange(mesh.vertex_count))
    return vary(item, seed=int(draw.integers(2**31)), middles=people_middles().places)


def _pose(draw: np.random.Generator) -> NDArray[np.float64]:
    """What the triangles of one of the training people go through from standing to one of their poses."""
    if draw.random() < 0.5:
        return deformation(humans()[0], _first_person_in(int(draw.choice(poses().split("train")))))
    standing = 10 * int(draw.integers(8))
    return deformation(humans()[standing], humans()[standing + int(draw.integers(1, 10))])


def _blend_in(pose: int, draw: np.random.Generator, subjects: range) -> TriangleMesh:
    chosen, weights = draw.choice(subjects, 3, replace=False), draw.dirichlet([0.6] * 3)
    bodies = [humans()[10 * int(subject) + pose] for subject in chosen]
    return blend(bodies, 1 / 3 + BEYOND * (weights - 1 / 3))


def dog(number: int) -> TrainingShape:
    """One of the thirty dogs to train on, mostly varied."""
    return _perhaps_varied(dogs()[number % 30], np.random.default_rng([2, number]), dog_middles())


def validation_people() -> list[TrainingShape]:
    """Sixteen shapes of persons 7 and 8, of another kind and another person by turns."""
    makers = {"mesh": _as_it_is, "remeshed": _remeshed, "cloud": _cloud, "scan": _scan}
    orders = [("mesh", "remeshed", "cloud", "scan")] * 2 + [("remeshed", "mesh", "scan", "cloud")] * 2
    turns = [(0, 2, 0, 2), (1, 3, 1, 3)] * 2  # of the two persons
    return [
        makers[kind](VALIDATION[kind][turn])
        for order, chosen in zip(orders, turns, strict=True)
        for kind, turn in zip(order, chosen, strict=True)
    ]


def validation_dogs() -> list[TrainingShape]:
    """Four of the dogs, twice bent more than those to train on, as meshes of other triangles and as clouds."""
    found = []
    for number in (3, 11, 17, 25):
        mesh = bend(dogs()[number], amplitude=0.015, wavelength=0.3, seed=number)
        twin = remesh(mesh, 5000, seed=number)
        part = subsample(mesh, 4000, start=number)
        found += [TrainingShape(twin.mesh, twin.origin), TrainingShape(part.cloud, part.indices)]
    return found


def _first_person_in(pose: int) -> TriangleMesh:
    """Person 1 in one of the poses of the finer mesh, with the people's triangles."""
    with np.load(Path(__file__).parents[1] / "shapes" / "people_in_poses.npz", allow_pickle=False) as file:
        vertices = poses()[pose].vertices[file["vertex"]]
    return TriangleMesh(vertices, humans()[0].faces, name=poses().names[pose])


def _perhaps_varied(mesh: TriangleMesh, draw: np.random.Generator, middles: Middles) -> TrainingShape:
    item = TrainingShape(mesh, np.arange(mesh.vertex_count))
    if draw.random() < UNCHANGED:
        return item
    return vary(item, seed=int(draw.integers(2**31)), middles=middles.places)


def _as_it_is(index: int) -> TrainingShape:
    return TrainingShape(humans()[index], np.arange(humans()[index].vertex_count))


def _remeshed(index: int) -> TrainingShape:
    twin = remesh(humans()[index], 4000, seed=100 + index)
    return TrainingShape(twin.mesh, twin.origin)


def _cloud(index: int) -> TrainingShape:
    """4,000 vertices as points; the last without normals."""
    part = subsample(humans()[index], 4000, start=97 * index % humans()[index].vertex_count)
    cloud = PointCloud(part.cloud.points) if index == VALIDATION["cloud"][-1] else part.cloud
    return TrainingShape(cloud, part.indices)


def _scan(index: int) -> TrainingShape:
    """Another body with muscles and noise of its own, and uneven triangles."""
    mesh = bend(humans()[index], amplitude=0.006, wavelength=0.3, seed=200 + index)
    mesh = roughen(mesh, amplitude=0.12, smoothing=12, seed=200 + index)
    twin = remesh(mesh, 6000, seed=200 + index, unevenness=0.5)
    rough = roughen(twin.mesh, amplitude=0.05, smoothing=1, seed=200 + index)
    return TrainingShape(rough, twin.origin)
