"""Fields of every kind: what is computed, what is said meanwhile, and that late answers are dropped. No Qt."""

import numpy as np
import pytest
from balls import Core, open_ball
from numpy.testing import assert_allclose, assert_array_equal

from add_viewer.controllers.answers import Answers
from add_viewer.controllers.descriptor_maps import ambiguity, best_places, distance_map
from add_viewer.controllers.descriptors import DescriptorStore
from add_viewer.controllers.field_plans import Sources
from add_viewer.controllers.fields import FieldController
from add_viewer.controllers.fields_of_descriptors import quantile_words
from add_viewer.controllers.fields_of_heat import blended
from add_viewer.controllers.kernel import KernelController
from add_viewer.controllers.matching import MatchingController
from add_viewer.controllers.operators import OperatorStore
from add_viewer.models.display import Display
from add_viewer.models.fields import FieldChoice
from add_viewer.models.insights import Insights
from add_viewer.models.jobs import Jobs
from add_viewer.models.results import Results
from add_viewer.models.session import Session


class World:
    """Two balls of one connectivity in a session, with everything that fills fields."""

    def __init__(self, folder, run):
        self.session, self.results, self.insights, self.run = Session(), Results(), Insights(), run
        self.jobs = Jobs(folder / "jobs")
        self.core = Core(self.jobs)
        answers, operators = Answers(self.jobs, run), OperatorStore()
        store = DescriptorStore(answers, lambda: (), lambda: ())
        self.kernel = KernelController(self.session, self.results, Display(), run, operators)
        self.matching = MatchingController(self.session, self.results, self.insights, answers)
        self.sources = Sources(self.results, answers, store, operators, self.matching)
        self.fields = FieldController(self.session, self.sources, run)
        self.bent, self.egg = open_ball(folder, "bent", bent=0.08), open_ball(folder)
        for shape in (self.bent, self.egg):
            self.session.add_shape(shape)

    def settle(self):
        while self.core.waiting or self.run.waiting:
            while self.core.waiting:
                self.core.answer()
            self.run.answer_all()

    def field(self, shape=None, panel=0):
        return self.results.fields[panel, (shape or self.egg).key]


@pytest.fixture
def world(tmp_path, run, monkeypatch):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    return World(tmp_path, run)


def test_a_distance_map_is_zero_at_the_point_and_saturates_at_the_median(world):
    world.session.choose_field(kind="distance", descriptor="wks")
    assert not world.results.fields
    world.session.pick(5)
    assert "Computing WKS of" in world.field().message
    world.settle()
    for shape in (world.egg, world.bent):
        field = world.field(shape)
        assert_allclose(field.scale.high, np.median(field.values))
        assert (field.position == 1.0).mean() == pytest.approx(0.5, abs=0.02)
    assert world.field().values[5] == 0.0
    assert world.field().values.min() == 0.0
    assert 5 not in world.field().best
    assert world.field(world.bent).best[0] == np.argmin(world.field(world.bent).values)
    world.session.choose_field(saturation=90.0)
    world.settle()
    assert_allclose(world.field().scale.high, np.percentile(world.field().values, 90))
    assert world.field().notes[1] == "saturated at the 90th percentile"


@pytest.mark.parametrize(
    ("percentile", "words"),
    [
        *((1, "1st percentile"), (2, "2nd percentile"), (3, "3rd percentile"), (11, "11th percentile")),
        *((13, "13th percentile"), (21, "21st percentile"), (12.2, "12.2th percentile")),
        *((50, "median"), (100, "maximum")),
    ],
)
def test_percentiles_are_read_as_people_say_them(percentile, words):
    assert quantile_words(float(percentile)) == words


def test_two_descriptors_side_by_side_are_computed_once_each(world):
    world.session.choose_field(kind="distance", descriptor="hks")
    world.session.choose_comparison(FieldChoice("distance", "wks"))
    world.session.pick(5)
    assert len(world.core.waiting) == 4
    world.settle()
    assert world.field(panel=0).title == "Distance in HKS"
    assert world.field(panel=1).title == "Distance in WKS"
    world.session.pick(9)
    assert not world.core.waiting
    world.session.choose_comparison(None)
    assert (1, world.egg.key) not in world.results.fields


def test_a_pick_on_any_shape_is_the_point_that_all_are_compared_with(world):
    world.session.choose_field(kind="distance", descriptor="wks")
    world.session.pick(7, shape=world.bent.key)
    world.settle()
    assert world.field(world.bent).values[7] == 0.0
    assert world.field(world.egg).values.min() > 0.0


def test_hks_takes_points_for_their_mirror_image_and_ahks_does_not(world):
    for descriptor in ("hks", "ahks"):
        world.session.choose_field(kind="ambiguity", descriptor=descriptor)
        world.settle()
        values = world.field().values
        assert np.isnan(values[world.egg.symmetry == np.arange(len(values))]).all()
        typical = np.nanmedian(values)
        assert typical < 1e-3 if descriptor == "hks" else typical > 0.1
        assert (world.field().scale.low, world.field().scale.high) == (0.01, 1.0)


def test_a_cancelled_job_is_told_and_the_next_choice_tries_again(world):
    world.session.choose_field(kind="signature", descriptor="wks", index=3)
    from dataclasses import replace

    for id in list(world.core.waiting):
        world.jobs.put(replace(world.jobs[id], state="cancelled"))
    world.core.waiting.clear()
    assert "was cancelled" in world.field().message
    world.session.choose_field(index=4)
    assert "Computing" in world.field().message
    world.settle()
    assert world.field().title == "WKS, number 5 of 16"
    assert_allclose(world.field().values.std(), 1.0, rtol=0.05)


def test_a_failed_job_says_why(world, tmp_path):
    (tmp_path / "egg.off").unlink()
    world.session.choose_field(kind="signature", descriptor="hks")
    world.settle()
    assert "there is no such file" in world.field().message
    assert world.field().values is None


def test_an_eigenfunction_is_one_and_follows_alpha(world):
    world.session.diffuse(alpha=0.0)
    world.session.choose_field(kind="eigenfunction", index=1)
    world.settle()
    field = world.field()
    areas = world.egg.shape.vertex_areas
    assert_allclose(areas @ field.values, 0.0, atol=1e-6)
    assert_allclose(areas @ field.values**2, 1.0, rtol=1e-5)
    assert field.position[np.argmin(np.abs(field.values))] == pytest.approx(0.5, abs=0.05)
    world.session.diffuse(alpha=20.0, theta=0.5)
    world.settle()
    assert np.abs(world.field().values - field.values).max() > 0.1
    world.session.diffuse(theta=0.501)  # less than the step of θ: the same operator
    assert not world.core.waiting


def test_the_wave_kernel_is_the_sum_over_its_band(world):
    world.session.diffuse(alpha=0.0, reach=0.3)
    world.session.choose_field(kind="kernel", name="wave")
    assert not world.results.fields
    world.session.pick(3)
    world.settle()
    values = world.field().values
    assert_allclose(world.egg.shape.vertex_areas @ values, 0.0, atol=1e-4)  # λ = 0 is not in the band
    assert np.argmax(values) == 3


def test_curvature_of_a_ball_is_one_over_its_radius(world):
    from add_core.geometry import normalize
    from add_core.geometry.shapes import sphere

    ball = normalize(sphere(3))
    radius = np.linalg.norm(ball.vertices - ball.vertices.mean(axis=0), axis=1).mean()
    world.session.choose_field(kind="curvature", name="gaussian")
    from dataclasses import replace

    world.session.add_shape(replace(world.egg, key="ball", shape=ball, symmetry=None))
    world.settle()
    field = world.results.fields[0, "ball"]
    assert_allclose(np.median(field.values), radius**-2, rtol=0.05)
    assert field.tones == "signed"


def test_a_field_of_the_file_is_shown_as_it_is(world):
    from dataclasses import replace

    count = world.egg.vertex_count
    columns = np.stack([np.arange(count), -np.ones(count)], axis=1)
    world.session.add_shape(replace(world.egg, fields={"two": columns}))
    world.session.choose_field(kind="file", name="two", index=0)
    world.settle()
    assert_array_equal(world.field().values, np.arange(count))
    assert world.field().tones == "sequential"
    assert "no field named two" in world.field(world.bent).message
    world.session.choose_field(index=7)
    world.settle()
    assert_array_equal(world.field().values, -np.ones(count))


def test_a_rose_has_the_hue_of_each_angle_where_its_kernel_is_largest(world):
    world.session.choose_field(kind="rose", name="")
    world.session.pick(3)
    world.settle()
    assert world.field().colors.shape == (world.egg.vertex_count, 3)
    from add_core.drawing.colours import SKIN, theta_colour

    shares = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    colors = blended(shares, np.array([0.0, np.pi / 2]))
    assert_allclose(colors[:2], theta_colour(np.array([0.0, np.pi / 2])), atol=1e-6)
    assert_allclose(colors[2], SKIN, atol=1e-6)


def test_heat_by_theta_and_by_its_negative_mirror_each_other(world):
    """What θ is to a point, −θ is to its mirror image: colours differ in hue alone, and the pattern is mirrored."""
    eta = world.egg.symmetry
    vertex = int(np.flatnonzero(eta != np.arange(len(eta)))[7])
    world.session.diffuse(theta=np.pi / 2, alpha=20.0)  # −90° is 90°: the same hue
    world.session.choose_field(kind="rose", name="mirror")
    world.session.pick(vertex)
    world.session.pick_mirror(vertex)
    world.settle()
    colors = world.field().colors
    assert_allclose(colors[eta], colors, atol=0.02)


def test_place_colours_land_where_the_matching_says(world):
    world.session.choose_field(kind="transfer")
    world.settle()
    assert_array_equal(world.field(world.bent).colors, world.field().colors)  # true: equal numbers
    world.session.match(method="nearest", descriptor="wks")
    assert "Computing the WKS matches" in world.field(world.bent).message
    world.settle()
    match = world.results.maps[world.egg.key, world.bent.key]
    assert_array_equal(world.field(world.bent).colors, world.field().colors[match])
    raw = match
    world.session.match(refined=True)
    assert not world.core.waiting  # both are known at once
    world.settle()
    assert (world.results.maps[world.egg.key, world.bent.key] != raw).any()


def test_errors_are_shown_where_the_truth_is_known(world):
    world.session.match(method="nearest", descriptor="wks")
    world.session.choose_field(kind="error")
    world.settle()
    match, field = world.results.maps[world.egg.key, world.bent.key], world.field(world.bent)
    assert_array_equal(field.values > 0, match != np.arange(len(match)))
    found = world.matching.found(world.bent.key)
    (quality,) = world.insights.qualities
    mean = world.field(world.bent).values.mean()
    assert quality.curves[False, False].mean == pytest.approx(mean)
    assert quality.message == ""
    assert found.curve(refined=False).exact == pytest.approx((match == np.arange(len(match))).mean())
    world.session.match(method="true")
    assert "has no error" in world.field(world.bent).message


def test_the_best_places_are_listed_with_their_distance_and_geodesic_error(world):
    from add_core.geometry.pair_distances import PairDistances
    from add_viewer.controllers.best_matches import BestMatchesController

    controller = BestMatchesController(world.session, world.results, world.insights, world.run)
    world.session.choose_field(kind="distance", descriptor="wks")
    eta = world.egg.symmetry
    vertex = int(np.argmax(np.abs(world.egg.shape.vertices[:, 0])))
    world.session.pick(vertex)
    world.settle()
    best = world.insights.best[0, world.egg.key]
    values = world.field().values
    assert (best[0].vertex, best[0].is_mirror) == (eta[vertex], True)  # WKS takes it for the point itself
    assert best[0].distance == pytest.approx(values[eta[vertex]] / np.median(values), abs=1e-9)
    true = PairDistances(world.egg.shape).rows([vertex])[0]
    assert [each.error for each in best] == pytest.approx([true[each.vertex] for each in best])
    assert world.insights.best[0, world.bent.key][0].error is not None
    world.session.clear_picks()
    assert controller is not None  # signals hold it weakly
    assert world.insights.best == {}


def test_heat_is_carried_to_the_targets(world):
    world.session.choose_field(kind="transfer", name="heat")
    assert "Click egg" in world.field(world.bent).message
    world.session.pick(3)
    world.settle()
    carried = world.field(world.bent).values
    assert_array_equal(carried, world.field().values)
    assert carried @ world.egg.shape.vertex_areas == pytest.approx(1.0, rel=1e-6)


def test_a_late_field_is_dropped(world):
    world.session.choose_field(kind="curvature", name="mean")
    world.session.choose_field(name="gaussian")
    lanes = [lane for lane, *_ in world.run.waiting if lane == "fields"]
    assert len(lanes) == 2
    world.run.waiting.reverse()
    world.run.answer_all()
    assert world.field().title == "Gaussian curvature K"


def test_going_back_to_heat_leaves_the_views_to_the_live_kernel(world):
    world.session.choose_field(kind="curvature")
    world.settle()
    world.session.choose_field(kind="heat")
    assert not any(field.choice.kind == "curvature" for field in world.results.fields.values())


def test_best_places_are_apart_and_in_order():
    vertices = np.linspace(0, 1, 101)[:, None] * [1.0, 0.0, 0.0]
    distances = np.abs(vertices[:, 0] - 0.3) * 5
    distances[80:83] = [0.11, 0.1, 0.12]
    assert best_places(distances, vertices, count=3, apart=0.055).tolist() == [30, 81, 24]


def test_distance_and_ambiguity_have_the_values_of_their_definition():
    descriptors = np.array([[0.0, 0.0], [3.0, 4.0], [0.0, 4.0]])
    assert_allclose(distance_map(descriptors, descriptors[0]), [0, 5, 4])
    assert_allclose(ambiguity(descriptors, np.array([1, 0, 2])), [5 / 4, 5 / 4, np.nan])
