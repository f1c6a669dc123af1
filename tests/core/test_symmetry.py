"""Symmetries of shapes that have one by construction, posed or not, and of shapes that have none."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.distance import cdist

from add_core.correspondence import intrinsic_symmetry, mirror_symmetry, preserved_orientation
from add_core.correspondence.involution import nearest_involution
from add_core.errors import ParameterError
from add_core.evaluation.samples import sample
from add_core.geometry import PointCloud, TriangleMesh, geodesic_diameter, normalize
from add_core.geometry.pair_distances import PairDistances
from add_core.geometry.shapes import sphere
from add_core.io import dogs, humans
from add_core.spectra import compute_spectra

BALL = sphere(3)
MIRROR = cdist(BALL.vertices * [-1, 1, 1], BALL.vertices).argmin(axis=1)


def creature(*, arms=(0.9, 0.9), bend=0.0):
    """A body with two arms to the sides of x = 0, a head and a nose; `bend` turns it over its length, arms and all."""
    directions = np.array([[0.8, 0.1, 0.6], [-0.8, 0.1, 0.6], [0, 0, 1.0], [0, 1.0, 0.3], [0, -0.3, -1.0]])
    sizes = np.array([*arms, 0.7, 0.5, 0.9])
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    growth = 1 + np.exp(-14 * (1 - BALL.vertices @ directions.T)) @ sizes
    x, y, z = (BALL.vertices * growth[:, None] * [0.8, 0.6, 1.2]).T
    angle = bend * x
    return TriangleMesh(
        np.stack([x, np.cos(angle) * y - np.sin(angle) * z, np.sin(angle) * y + np.cos(angle) * z], axis=1), BALL.faces
    )


def spectra_of(shape, count=60):
    return compute_spectra(normalize(shape), alphas=(0.0, 50.0), angles=8, count=count, workers=1, cache=False)


def test_the_mirror_image_of_every_point_is_found():
    shape = creature()
    found = intrinsic_symmetry(shape, family=spectra_of(shape))
    assert found.found, found.reason
    error = PairDistances(shape)(found.eta, MIRROR) / geodesic_diameter(shape)
    assert error.mean() < 0.01
    assert preserved_orientation(shape, shape, found.eta) < 0.1
    assert 0 < found.confidence <= 1
    assert found.field.mean() > 0.9
    assert found.unmoved < 0.2
    assert found.alike > 0.95


def test_the_mirror_image_of_a_person_in_a_pose_is_found():
    collection = humans()
    person = collection[97]
    assert not mirror_symmetry(person, tolerance=0.01).found
    found = intrinsic_symmetry(person, family=spectra_of(person, 80))
    assert found.found, found.reason
    error = PairDistances(person)(found.eta, collection.symmetry) / geodesic_diameter(person)
    assert error.mean() < 0.03


@pytest.mark.parametrize(("variant", "index"), [("remeshed", 80), ("remeshed", 83), ("cloud", 83)])
def test_the_mirror_image_of_a_person_is_found_on_other_meshings(variant, index):
    """The first sends a fingertip astray; the others look less like a mirror than on the mesh that people come in."""
    person = sample(humans(), index, variant)
    found = intrinsic_symmetry(person.shape, family=spectra_of(person.shape, 150))
    assert found.found, found.reason
    error = PairDistances(person.shape)(found.eta, person.symmetry) / geodesic_diameter(person.shape)
    assert error.mean() < 0.03


def test_a_dog_that_mirrors_clearly_is_found_though_few_of_its_points_do():
    collection = dogs()
    dog = collection[18]
    found = intrinsic_symmetry(dog, family=spectra_of(dog, 150))
    assert found.found, found.reason
    assert found.alike < 0.7
    assert found.unlike < 0.9
    error = PairDistances(dog)(found.eta, collection.symmetry) / geodesic_diameter(dog)
    assert error.mean() < 0.03


def test_a_map_that_lays_a_limb_upon_itself_is_no_symmetry():
    """A person with one thick hand: arms left where they are distort less than one hand laid on the other."""
    person = normalize(humans()[13])
    hand = int(np.argmax(humans()[1].vertices[:, 0]))
    near = np.clip(1 - PairDistances(person).rows(np.array([hand]))[0] / 0.25, 0, 1) ** 2
    thick = TriangleMesh(person.vertices + 0.06 * near[:, None] * person.vertex_normals, person.faces)
    found = intrinsic_symmetry(thick, family=spectra_of(thick, 150))
    assert not found.found
    assert found.reason.endswith("of the points where they are.")


def test_a_longer_arm_leaves_no_symmetry():
    shape = creature(arms=(0.4, 1.6))
    found = intrinsic_symmetry(shape, family=spectra_of(shape))
    assert not found.found
    assert found.eta is None
    assert found.confidence == 0
    assert found.candidate.shape == (642,)
    assert "The best map" in found.reason


def blob(seed):
    """A ball with a dozen bumps and dents at random."""
    random = np.random.default_rng(seed)
    places = random.normal(size=(12, 3))
    places /= np.linalg.norm(places, axis=1, keepdims=True)
    growth = 1 + np.exp(-6 * (1 - BALL.vertices @ places.T)) @ random.uniform(-0.35, 0.6, size=12)
    return TriangleMesh(BALL.vertices * growth[:, None] * [0.8, 1.0, 1.3], BALL.faces)


def smooth(seed):
    """A ball with a few wide bumps, whose two sides differ little in distances and much in what lies where."""
    random = np.random.default_rng(seed)
    count = int(random.integers(4, 9))
    places = random.standard_normal((count, 3))
    places /= np.linalg.norm(places, axis=1, keepdims=True)
    sizes, widths = random.uniform(-0.4, 1.0, count), random.uniform(2, 12, count)
    fine = sphere(4)
    growth = 1 + (sizes * np.exp(widths * (fine.vertices @ places.T - 1))).sum(axis=1)
    return TriangleMesh(fine.vertices * growth[:, None] * random.uniform(0.6, 1.6, 3), fine.faces)


def star(lengths):
    """Limbs of these lengths around a body that is round above and flat below."""
    angles = 2 * np.pi * np.arange(len(lengths)) / len(lengths)
    ends = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    growth = 1 + np.exp(-14 * (1 - BALL.vertices @ ends.T)) @ np.asarray(lengths)
    places = BALL.vertices * growth[:, None]
    return TriangleMesh(places * np.where(places[:, 2:] < 0, [1, 1, 0.3], [1, 1, 0.9]), BALL.faces)


@pytest.mark.parametrize(
    "shape",
    [
        creature(arms=(0.9, 0.0)),
        creature(arms=(0.9, 0.3), bend=0.6),
        blob(1),
        blob(2),
        blob(5),
        smooth(8),
        star([1.6, 0.9, 0.4]),
    ],
    ids=["arm missing", "bent, with a stump", "blob", "second blob", "third blob", "smooth", "three unequal limbs"],
)
def test_shapes_without_a_symmetry_are_told_so(shape):
    found = intrinsic_symmetry(shape, family=spectra_of(shape))
    assert not found.found
    assert found.eta is None
    assert found.confidence == 0
    assert found.reason.startswith("The best map")


def test_two_equal_limbs_of_three_are_a_symmetry():
    shape = star([1.6, 0.8, 0.8])
    found = intrinsic_symmetry(shape, family=spectra_of(shape))
    mirror = cdist(shape.vertices * [1, -1, 1], shape.vertices).argmin(axis=1)
    assert found.found, found.reason
    assert (PairDistances(shape)(found.eta, mirror) / geodesic_diameter(shape)).mean() < 0.02


def test_one_orientation_for_both_sides_is_needed():
    shape = creature()
    family = spectra_of(shape)
    with pytest.raises(ParameterError, match="family must hold α = 0"):
        intrinsic_symmetry(shape, family=compute_spectra(shape, alphas=(50.0,), angles=4, count=20, cache=False))
    lopsided = type(family)(
        family.alphas[:3], family.thetas[:3], family.eigenvalues[:3], family.eigenfunctions[:3], family.mass
    )
    with pytest.raises(ParameterError, match=r"family must hold the angle π − 0\.3927 for α = 50"):
        intrinsic_symmetry(shape, family=lopsided)


def test_the_nearest_involution_is_its_own_inverse_and_a_fixed_point():
    matrix = np.random.default_rng(0).normal(size=(7, 7))
    found = nearest_involution(matrix)
    assert_allclose(found @ found, np.eye(7), atol=1e-12)
    assert_allclose(found, found.T, atol=1e-12)
    assert_allclose(nearest_involution(found), found, atol=1e-12)
    others = [nearest_involution(np.random.default_rng(seed).normal(size=(7, 7))) for seed in range(1, 30)]
    assert all(np.linalg.norm(matrix - found) <= np.linalg.norm(matrix - other) for other in others)


@pytest.mark.parametrize("kind", ["mesh", "cloud"])
def test_the_plane_of_a_neutral_pose_is_found_wherever_it_lies(kind):
    shape = creature()
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    places = 3.0 * shape.vertices @ turn.T + [5.0, -2.0, 7.0]
    placed = TriangleMesh(places, shape.faces) if kind == "mesh" else PointCloud(places)
    found = mirror_symmetry(placed)
    assert found.found
    assert_array_equal(found.eta, MIRROR)
    assert abs(found.normal @ turn[:, 0]) == pytest.approx(1.0, abs=1e-6)
    assert found.offset == pytest.approx(found.normal @ [5.0, -2.0, 7.0], abs=1e-5)
    assert found.residual < 1e-6


def test_a_cloud_without_paired_points_still_has_its_plane():
    random = np.random.default_rng(3)
    points = random.normal(size=(3000, 3)) * [1.0, 2.0, 3.0] + random.exponential(size=(3000, 1)) * [0, 1.0, 1.0]
    found = mirror_symmetry(PointCloud(points), tolerance=0.1)
    assert found.found
    assert abs(found.normal[0]) > 0.99


def test_a_bent_shape_has_no_mirror_plane():
    found = mirror_symmetry(creature(arms=(0.3, 2.0), bend=0.9))
    assert not found.found
    assert found.eta is None
    assert found.residual > 0.03


def test_loose_vertices_ask_for_no_smaller_count():
    """150 eigenpairs by default, but no more than vertices with area: the caller has not asked for any number."""
    ball = sphere(1)
    loose = TriangleMesh(np.vstack([ball.vertices, ball.vertices * 1.1]), ball.faces)
    assert len(intrinsic_symmetry(loose, angles=2).candidate) == 84


def test_points_in_one_place_do_not_hide_which_way_a_cloud_is_turned():
    """No direction leads from a point to its double, so that both take part as one."""
    points = np.vstack([sphere(2).vertices, sphere(2).vertices[::2]])
    cloud, mirrored = PointCloud(points), PointCloud(points * [-1, 1, 1])
    assert preserved_orientation(cloud, cloud, np.arange(len(points))) == 1.0
    assert preserved_orientation(mirrored, cloud, np.arange(len(points))) == 0.0
    assert preserved_orientation(PointCloud(np.eye(3)[:2]), cloud, [0, 1]) == 0.5


def test_a_neutral_pose_that_is_not_quite_symmetric_has_the_exact_map_of_its_triangles():
    collection = humans()
    for index in (0, 10):
        found = mirror_symmetry(collection[index])
        assert found.found
        assert_array_equal(found.eta, collection.symmetry)
