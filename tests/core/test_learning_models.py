"""Models: inputs that forget what they should, descriptors of any shape, and files that hold no surprise."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from numpy.testing import assert_allclose, assert_array_equal
from safetensors.torch import save_file

from add_core.descriptors import smoothed
from add_core.errors import ParameterError, ShapeFileError
from add_core.geometry import PointCloud, TriangleMesh, subsample
from add_core.geometry.shapes import ellipsoid
from add_core.learning import InputRecipe, Model, build_network, load_model, shipped_models
from add_core.learning.inputs import Moments, relative_density
from add_core.spectra import compute_spectra

RECIPE = InputRecipe(alphas=(0.0, 30.0), angles=2, eigenpairs=40, splines=12)


@pytest.fixture(autouse=True)
def _one_thread():
    torch.set_num_threads(1)


@pytest.fixture(scope="module")
def mesh():
    shape = ellipsoid(1.0, 0.7, 0.5, subdivisions=3)
    return TriangleMesh(shape.vertices + 0.1 * np.sin(3 * shape.vertices[:, [1, 2, 0]]), shape.faces, name="lumpy")


@pytest.fixture(scope="module")
def model():
    network = build_network("mADD2", alphas=RECIPE.alphas, angles=2, splines=12, seed=1)
    moments = Moments(np.zeros((3, 12), np.float32), np.ones((3, 12), np.float32))
    return Model(network, RECIPE, moments, card={"note": "untrained"})


def describe(model, shape):
    return model.describe(shape, workers=1, cache=False)


def test_the_mean_of_a_relative_density_over_the_surface_is_one(mesh):
    family = compute_spectra(mesh, alphas=(0.0, 30.0), angles=2, count=40, workers=1, cache=False)
    ratio = np.exp(relative_density(family, count=10).astype(float)) - 0.01
    average = np.tensordot(family.mass / family.mass.sum(), ratio, axes=1)
    assert_allclose(average, 1, rtol=1e-4)


def test_moments_weigh_points_by_their_area():
    values = np.array([0.0, 0.0, 0.0, 8.0]).reshape(4, 1, 1)
    moments = Moments.of(values, np.array([1.0, 1.0, 1.0, 3.0]))
    assert_allclose([moments.mean.item(), moments.deviation.item()], [4.0, 4.0])
    assert_allclose(moments.standardise(values).ravel(), [-1, -1, -1, 1])


def test_pooled_moments_are_those_of_all_surfaces_together():
    values = np.random.default_rng(0).normal(size=(2, 50, 3, 4))
    parts = [Moments.of(part, np.ones(50)) for part in values]
    together = Moments.of(values.reshape(100, 3, 4), np.ones(100))
    assert_allclose(Moments.pooled(parts).mean, together.mean, atol=1e-6)
    assert_allclose(Moments.pooled(parts).deviation, together.deviation, rtol=1e-5)


def test_a_spline_on_which_all_points_agree_is_not_blown_up():
    values = 1 + 1e-4 * np.random.default_rng(0).normal(size=(50, 1, 1))
    assert np.abs(Moments.of(values, np.ones(50)).standardise(values)).max() < 0.01


def test_descriptors_do_not_depend_on_unit_place_or_pose_of_the_body(model, mesh):
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    moved = TriangleMesh(1000 * mesh.vertices @ turn.T + 5, mesh.faces)
    assert_allclose(describe(model, moved), describe(model, mesh), atol=1e-3)


def test_descriptors_follow_their_vertices(model, mesh):
    order = np.random.default_rng(0).permutation(mesh.vertex_count)
    number = np.argsort(order)
    shuffled = TriangleMesh(mesh.vertices[order], number[mesh.faces])
    assert_allclose(describe(model, shuffled), describe(model, mesh)[order], atol=1e-3)


def test_clouds_and_small_shapes_are_described(model, mesh):
    cloud = subsample(mesh, 300).cloud
    assert isinstance(cloud, PointCloud)
    assert describe(model, cloud).shape == (300, 16)
    tiny = ellipsoid(1.0, 0.7, 0.5, subdivisions=1)
    assert tiny.vertex_count > 40 or describe(model, tiny).shape == (tiny.vertex_count, 16)
    assert np.isfinite(describe(model, tiny)).all()


def test_a_point_apart_from_its_cloud_is_described_too(mesh):
    """It stands for no area, so that there is one eigenpair fewer than points, and it holds no heat at all."""
    cloud = PointCloud(np.vstack([subsample(mesh, 60).cloud.points, [[50.0, 0.0, 0.0]]]))
    assert cloud.has_mass.sum() == 60
    recipe = InputRecipe(alphas=(0.0,), angles=1, eigenpairs=300, splines=12)
    family = recipe.spectra(cloud, cache=False, workers=1)
    assert family.eigenvalues.shape == (1, 60)
    assert np.isfinite(recipe.inputs(family)).all()


def test_the_isotropic_twin_has_as_many_weights_and_no_direction(mesh):
    twin = InputRecipe(alphas=(0.0, 30.0), angles=2, eigenpairs=40, splines=12, isotropic=True)
    family = twin.spectra(mesh, workers=1, cache=False)
    assert family.alphas.tolist() == [0.0]
    values = twin.inputs(family)
    assert values.shape == (mesh.vertex_count, 3, 12)
    assert_array_equal(values[:, 0], values[:, 2])


def test_a_model_is_the_same_after_a_visit_to_a_file(model, mesh, tmp_path):
    model.save(tmp_path / "my.safetensors")
    again = load_model(tmp_path / "my.safetensors")
    assert_array_equal(describe(again, mesh), describe(model, mesh))
    assert (again.recipe, again.standardisation, again.card) == (model.recipe, "shape", {"note": "untrained"})
    assert [path.name for path in tmp_path.iterdir()] == ["my.safetensors"]


def test_weights_kept_in_half_precision_take_half_the_room_and_describe_alike(model, mesh, tmp_path):
    for precision in ("float32", "float16"):
        model.save(tmp_path / precision, precision=precision)
    whole, half = (load_model(tmp_path / precision) for precision in ("float32", "float16"))
    assert (tmp_path / "float16").stat().st_size < 0.6 * (tmp_path / "float32").stat().st_size
    assert_allclose(describe(half, mesh), describe(whole, mesh), atol=5e-3 * np.abs(describe(whole, mesh)).max())


def test_standardising_by_the_set_uses_its_moments(model, mesh):
    other = Model(model.network, RECIPE, model.moments, "set")
    values = RECIPE.inputs(RECIPE.spectra(mesh, workers=1, cache=False))
    expected = model.network(torch.from_numpy(values)).detach().numpy()
    assert_allclose(other.describe_inputs(values, np.ones(len(values))), expected, rtol=1e-5)


def test_descriptors_are_smoothed_and_what_enters_the_last_layer_of_a_classifier(model, mesh, tmp_path):
    smooth = replace(model, smoothing=4.0)
    assert_allclose(describe(smooth, mesh), smoothed(mesh, describe(model, mesh)), atol=1e-5)
    smooth.save(tmp_path / "smooth")
    assert load_model(tmp_path / "smooth").smoothing == 4.0
    layers = "ASF8 ReLU SC FC9 ReLU FCreference Softmax"
    network = build_network("mADD4", alphas=RECIPE.alphas, angles=2, splines=12, layers=layers, reference_size=50)
    classifier = Model(network, RECIPE, model.moments, smoothing=2.0)
    family = RECIPE.spectra(mesh, workers=1, cache=False)
    inputs = RECIPE.inputs(family)
    with torch.inference_mode():
        features = network.layers[:-2](torch.from_numpy(Moments.of(inputs, family.mass).standardise(inputs)))
        even = torch.from_numpy(smoothed(mesh, features.numpy(), strength=2.0).astype(np.float32))
        expected = network.layers[-2:](even).numpy()
    assert_allclose(describe(classifier, mesh), expected, atol=1e-5)


def test_files_that_hold_no_model_are_explained(tmp_path):
    (tmp_path / "noise").write_bytes(b"\x10" * 100)
    save_file({"x": torch.zeros(2)}, str(tmp_path / "other.safetensors"))
    for name in ("noise", "other.safetensors"):
        with pytest.raises(ShapeFileError, match=name):
            load_model(tmp_path / name)
    with pytest.raises(ParameterError, match="must be a file, the folder of a training or a shipped model"):
        load_model("cats-madd3")


def test_a_recipe_that_does_not_fit_the_network_is_refused(model):
    with pytest.raises(ParameterError, match="takes 3 channels × 12 splines, but the recipe makes 3 × 13"):
        Model(model.network, InputRecipe(alphas=(0.0, 30.0), angles=2, splines=13), model.moments)


@pytest.mark.parametrize("name", shipped_models())
def test_shipped_models_open_and_say_how_they_were_trained(name):
    model = load_model(name)
    assert {"settings", "steps", "history"} <= model.card.keys()


def test_a_mirror_image_is_its_shape_with_the_angles_exchanged(mesh):
    """f_θ∘η = f_{−θ}: what lets networks learn from reflections that cost no spectra."""
    recipe = InputRecipe(alphas=(0.0, 10.0, 30.0), angles=3, eigenpairs=40, splines=12)
    mirrored = TriangleMesh(mesh.vertices * [-1, 1, 1], mesh.faces[:, ::-1])
    one, two = (recipe.inputs(recipe.spectra(shape, workers=1, cache=False)) for shape in (mesh, mirrored))
    assert recipe.mirror_channels.tolist() == [0, 1, 3, 2, 4, 6, 5]
    assert_allclose(two, one[:, recipe.mirror_channels], atol=1e-3)
    assert np.abs(two - one).max() > 0.1
