"""Training with counterparts on one body: what it is part of, and what it is refused with."""

from pathlib import Path

import numpy as np
import pytest
from learning_inputs import made_up

from add_core.errors import ParameterError
from add_core.geometry import PointCloud
from add_core.geometry.shapes import ellipsoid, sphere
from add_core.learning import InputRecipe, TrainingSettings, TrainingShape
from add_core.learning.architectures import Architecture, build
from add_core.learning.training import fit
from add_core.learning.training_set import prepare
from add_core.spectra import family

RECIPE = InputRecipe(alphas=(0.0,), angles=1, eigenpairs=10, splines=4)
NETWORK = Architecture("small", "ASF4 SC FC4", channels=1, splines=4)
CLASSIFIER = Architecture("names", "ASF4 SC FCreference Softmax", channels=1, splines=4, reference_size=30)
QUICK = TrainingSettings(steps=4, pairs=8, checkpoint_every=2)


@pytest.fixture
def shapes():
    random = np.random.default_rng(0)
    return [made_up(random.normal(size=(30, 1, 4)), np.arange(30)) for _ in range(2)]


def line(count=30):
    return np.column_stack([np.arange(float(count)), np.zeros(count), np.zeros(count)])


def test_a_training_with_other_counterparts_is_another_training(shapes, tmp_path):
    fit(NETWORK, RECIPE, shapes, tmp_path, settings=QUICK, positions=line())
    fit(NETWORK, RECIPE, shapes, tmp_path, settings=QUICK, positions=line())
    for other in (None, 2.0 * line()):
        with pytest.raises(ParameterError, match="a training of other shapes or settings"):
            fit(NETWORK, RECIPE, shapes, tmp_path, settings=QUICK, positions=other)


def test_counterparts_change_what_is_learned(shapes, tmp_path):
    found = [
        fit(NETWORK, RECIPE, shapes, tmp_path / str(number), settings=QUICK, positions=positions)
        for number, positions in enumerate((None, line()))
    ]
    one, two = (np.concatenate([w.numpy().ravel() for w in each.network.state_dict().values()]) for each in found)
    assert not np.array_equal(one, two)


def test_positions_are_refused_where_places_are_named_and_where_they_are_no_points(shapes, tmp_path):
    settings = TrainingSettings(steps=4, pairs=8, loss="multinomial")
    assert build(CLASSIFIER, seed=0).is_classifier
    with pytest.raises(ParameterError, match="positions are of no use to the loss 'multinomial'"):
        fit(CLASSIFIER, RECIPE, shapes, tmp_path, settings=settings, positions=line())
    with pytest.raises(Exception, match=r"positions must have shape \(n, 3\)"):
        fit(NETWORK, RECIPE, shapes, tmp_path, settings=QUICK, positions=line()[:, :2])


@pytest.mark.parametrize("name", ["METHOD", "METHOD_ON_CLOUDS"])
def test_inputs_of_an_earlier_method_are_computed_anew(name, tmp_path, monkeypatch):
    mesh = ellipsoid(1.0, 0.7, 0.5, subdivisions=2)
    shape = mesh if name == "METHOD" else PointCloud(mesh.vertices, mesh.vertex_normals)
    item = TrainingShape(shape, np.arange(mesh.vertex_count))
    prepare([item], RECIPE, tmp_path, workers=1)
    monkeypatch.setattr(family, name, getattr(family, name) + 1)
    prepare([item], RECIPE, tmp_path, workers=1)
    prepare([item], RECIPE, tmp_path, workers=1)
    assert len(list(Path(tmp_path).glob("*.npz"))) == 2


def test_a_sphere_has_inputs_that_do_not_depend_on_the_other_method(tmp_path, monkeypatch):
    item = TrainingShape(sphere(1), np.arange(42))
    prepare([item], RECIPE, tmp_path, workers=1)
    monkeypatch.setattr(family, "METHOD_ON_CLOUDS", 99)
    prepare([item], RECIPE, tmp_path, workers=1)
    assert len(list(Path(tmp_path).glob("*.npz"))) == 1
