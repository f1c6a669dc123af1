"""Training: pairs that are what they claim, runs that survive being killed, and complaints that help."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest
import torch
from learning_inputs import made_up, numbered
from numpy.testing import assert_allclose, assert_array_equal

from add_core.errors import Cancelled, ConvergenceError, ParameterError, ShapeFileError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import ellipsoid
from add_core.learning import InputRecipe, LearningTask, TrainingSettings, TrainingShape, load_model, train
from add_core.learning.architectures import Architecture, build, take_over
from add_core.learning.averaging import AveragedWeights
from add_core.learning.pairs import PairSampler
from add_core.learning.settings import learning_rate
from add_core.learning.training import CHECKPOINT, MODEL, fit
from add_core.learning.training_set import prepare
from add_core.learning.validation import Validator

RECIPE = InputRecipe(alphas=(0.0, 30.0), angles=2, eigenpairs=30, splines=12)
SMALL = Architecture("small", "ASF16 ReLU SC FC32 ReLU FC8", channels=3, splines=12)
QUICK = TrainingSettings(steps=24, pairs=16, validate_every=8, checkpoint_every=4, learning_rate=1e-2)


@pytest.fixture(autouse=True)
def _one_thread():
    torch.set_num_threads(1)


def body(seed, *, subdivisions=2, places=None):
    """A lumpy ellipsoid: the same lumps for every seed, in slightly different sizes."""
    mesh = ellipsoid(1.0, 0.7, 0.5, subdivisions=subdivisions)
    x, y, z = mesh.vertices.T
    size = 1 + 0.03 * np.random.default_rng(seed).normal(size=3)
    lumps = (
        1 + 0.2 * size[0] * np.sin(2 * x + 1) + 0.15 * size[1] * np.cos(5 * y + x) + 0.1 * size[2] * np.sin(4 * z - y)
    )
    shape = TriangleMesh(mesh.vertices * lumps[:, None], mesh.faces, name=f"body {seed}")
    return TrainingShape(shape, np.arange(mesh.vertex_count) if places is None else places)


@pytest.fixture(scope="module")
def shapes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("inputs")
    return prepare([body(seed) for seed in range(4)], RECIPE, folder, workers=1)


def test_the_inputs_of_a_shape_are_computed_once(tmp_path):
    started, shape = [], body(0)
    for _ in range(2):
        prepare([shape], RECIPE, tmp_path, workers=1, report=lambda *event: started.append(time.time_ns()))
        written = {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    assert max(written.values()) < started[-2]
    assert sorted(path.suffix for path in written) == [".npy", ".npz"]


def test_a_network_learns_two_shapes_by_heart(shapes, tmp_path):
    settings = TrainingSettings(steps=200, pairs=64, noise=0.0, learning_rate=5e-3, checkpoint_every=1000)
    losses = []
    model = fit(SMALL, RECIPE, shapes[:2], tmp_path, settings=settings, report=lambda e: losses.append(e.get("loss")))
    assert losses[0] > 0.5
    assert np.mean(losses[-12:-2]) < 0.02
    assert model.smoothing == 4.0  # descriptors, not classes


@pytest.mark.parametrize("optimizer", ["adam", "adadelta"])
def test_the_siamese_loss_falls(shapes, tmp_path, optimizer):
    settings = TrainingSettings(loss="siamese", optimizer=optimizer, steps=80, pairs=32)
    losses = []
    fit(SMALL, RECIPE, shapes[:2], tmp_path, settings=settings, report=lambda e: losses.append(e.get("loss")))
    assert np.mean(losses[60:80]) < 0.6 * losses[0]


def test_a_classifier_learns_the_reference_shape(shapes, tmp_path):
    classifier = Architecture("small", "SC FC32 ReLU FCreference Softmax", 3, 12, reference_size=162)
    settings = TrainingSettings(loss="multinomial", steps=150, pairs=64, noise=0.0, learning_rate=1e-2)
    model = fit(classifier, RECIPE, shapes[:2], tmp_path, settings=settings)
    probabilities = model.describe_inputs(np.asarray(shapes[0].values, np.float32), shapes[0].mass)
    assert_allclose(probabilities.sum(axis=1), 1, rtol=1e-5)
    assert (probabilities.argmax(axis=1) == np.arange(162)).mean() > 0.8


def test_a_correspondence_network_names_vertices_of_its_reference(tmp_path):
    """Trained by heart on two bodies, it finds their vertices again, from the file too, and places beyond the reference
    are nothing to it."""
    bodies = [body(0), body(1)]
    places = np.concatenate([bodies[1].places[:-5], 162 + np.arange(5)])
    # Faces as those of the shipped people lie in memory: column after column, which safetensors refuses.
    reference = TriangleMesh(bodies[0].shape.vertices, np.asfortranarray(bodies[0].shape.faces))
    task = LearningTask([bodies[0], TrainingShape(bodies[1].shape, places)], reference=reference)
    layers = "ASF16 ReLU SC FC32 ReLU FCreference Softmax"
    settings = TrainingSettings(loss="multinomial", steps=200, pairs=64, noise=0.0, learning_rate=1e-2)
    train(task, tmp_path, architecture="mADD4", layers=layers, recipe=RECIPE, settings=settings, workers=1)
    model = load_model(tmp_path)
    assert_allclose(model.reference.vertices, bodies[0].shape.vertices, rtol=1e-6)
    matches = model.match(bodies[0].shape, workers=1, cache=False)
    assert (matches.vertices == np.arange(162)).mean() > 0.8
    probabilities = model.describe(bodies[0].shape, workers=1, cache=False)
    assert_array_equal(probabilities.argmax(axis=1), matches.vertices)
    assert_allclose(probabilities.max(axis=1), matches.probabilities)
    embedded = model.embed(bodies[0].shape, workers=1, cache=False)
    assert_array_equal(embedded, model.reference.vertices[matches.vertices])


def test_a_correspondence_network_is_judged_by_the_probability_of_the_true_vertex():
    """A network that passes on its input of 20 numbers, which are its logits."""
    network = build(Architecture("passes", "SC FCreference Softmax", 1, 20, reference_size=20, bias=False))
    with torch.no_grad():
        next(network.parameters()).copy_(torch.eye(20))
    logits = np.zeros((20, 1, 20), np.float32)
    logits[np.arange(20), 0, np.arange(20)] = 1.0
    logits[:5, 0, 19] = 2.0  # one vertex before the true one, at a quarter of the points
    logits[5:10, 0, :] = np.eye(20, dtype=np.float32)[np.arange(5, 10) ^ 1]  # the mirror image before the true one
    shapes = [made_up(logits), made_up(logits)]
    scores = Validator(shapes, symmetry=np.arange(20) ^ 1).scores(network)
    assert (scores.cmc1, scores.cmc10, scores.right_side) == (0.5, 1.0, 0.75)
    assert scores.auc == pytest.approx(1 - 0.5 / 19)
    expected = torch.nn.functional.cross_entropy(torch.from_numpy(logits[:, 0]), torch.arange(20)).item()
    assert scores.loss == pytest.approx(expected, rel=1e-5)


def test_shapes_that_share_too_little_to_be_compared_are_named_with_what_to_do():
    one = made_up(np.zeros((20, 1, 20), np.float32))
    others = (replace(one.below(3), name="other"), one.below(11))
    words = (f"{one.name!r} and 'other' share 3", f"{one.name!r} and another state of it share 11")
    for other, pair in zip(others, words, strict=True):
        with pytest.raises(ParameterError, match=rf"at least 12 places, but {pair}\. Take shapes of more vertices"):
            Validator([one, other])


def test_a_network_that_gives_descriptors_names_no_vertices(shapes, tmp_path):
    model = fit(SMALL, RECIPE, shapes[:2], tmp_path, settings=replace(QUICK, steps=2))
    with pytest.raises(ParameterError, match=r"must end in Softmax.*add-core match"):
        model.match(body(0).shape)


def test_training_starts_from_the_layers_of_another_network(shapes, tmp_path):
    first = fit(SMALL, RECIPE, shapes[:2], tmp_path / "first", settings=QUICK).network
    larger = Architecture("larger", "ASF16 ReLU SC FC32 ReLU FC7", channels=3, splines=12)
    network = build(larger, seed=5)
    assert take_over(network, first) == 5
    assert_array_equal(network.layers[0].weight.detach(), first.layers[0].weight.detach())
    still = replace(QUICK, steps=1, learning_rate=1e-12, averaging=0.0)
    after = fit(larger, RECIPE, shapes[:2], tmp_path / "second", settings=still, start=first).network
    assert_allclose(after.layers[3].weight.detach(), first.layers[3].weight.detach(), atol=1e-9)


def run(folder, shapes, settings=QUICK, **options):
    return fit(SMALL, RECIPE, shapes[:3], folder, settings=settings, validation=shapes[2:], **options)


def weights(model):
    return {name: value.numpy() for name, value in model.network.state_dict().items()}


def test_stopping_and_going_on_changes_no_bit(shapes, tmp_path):
    whole, stops = weights(run(tmp_path / "whole", shapes)), iter([3, 9, 10, 17])
    stop = next(stops)
    while stop is not None:
        with pytest.raises(Cancelled, match="the same command goes on"):
            run(tmp_path / "parts", shapes, report=lambda e, at=stop: e.get("step") != at)
        stop = next(stops, None)
    for name, value in weights(run(tmp_path / "parts", shapes)).items():
        assert_array_equal(value, whole[name])


KILLED = """
import sys, torch
sys.path[:0] = [sys.argv[1], sys.argv[2]]
torch.set_num_threads(1)
from pathlib import Path
from test_learning_training import RECIPE, body, prepare, run
def report(event):
    print(event["event"], event.get("step"), flush=True)
run(Path(sys.argv[4]), prepare([body(s) for s in range(4)], RECIPE, Path(sys.argv[3]), workers=1), report=report)
"""


def test_a_killed_run_ends_with_the_same_weights(shapes, tmp_path):
    whole = weights(run(tmp_path / "whole", shapes))
    here = os.path.dirname(__file__)
    command = [sys.executable, "-c", KILLED, os.path.dirname(os.path.dirname(here)), here, str(tmp_path / "inputs")]
    with subprocess.Popen([*command, str(tmp_path / "killed")], stdout=subprocess.PIPE, text=True) as process:
        for line in process.stdout:
            if line.split() == ["step", "11"]:
                os.kill(process.pid, signal.SIGKILL if hasattr(signal, "SIGKILL") else signal.SIGTERM)
                break
    assert (tmp_path / "killed" / CHECKPOINT).exists()
    assert load_model(tmp_path / "killed" / MODEL).card["step"] == 8
    for name, value in weights(run(tmp_path / "killed", shapes)).items():
        assert_array_equal(value, whole[name])


@pytest.mark.skipif(not hasattr(os, "fork"), reason="kills forked copies of this process")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_ten_kills_at_random_moments_change_no_bit(shapes, tmp_path):
    """Killed within steps, validations or writes, wherever the moment falls, and each time gone on with."""
    settings = replace(QUICK, steps=150, checkpoint_every=3, validate_every=10)
    whole = weights(run(tmp_path / "whole", shapes, settings))
    draw, ends = np.random.default_rng(0), []
    for _ in range(10):
        reading, writing = os.pipe()
        child = os.fork()
        if not child:
            try:
                run(tmp_path / "killed", shapes, settings, report=lambda event, pipe=writing: os.write(pipe, b"."))
            finally:
                os._exit(0)
        os.close(writing)
        for _ in range(draw.integers(1, 16)):
            os.read(reading, 1)
        time.sleep(draw.uniform(0, 0.02))
        os.kill(child, signal.SIGKILL)
        ends.append(os.WTERMSIG(os.waitpid(child, 0)[1]))
        os.close(reading)
    assert ends == [signal.SIGKILL] * 10
    for name, value in weights(run(tmp_path / "killed", shapes, settings)).items():
        assert_array_equal(value, whole[name])


def test_the_best_validation_is_what_is_kept(shapes, tmp_path):
    model = run(tmp_path, shapes, replace(QUICK, learning_rate=1.0, steps=32))
    curve = [entry["cmc1"] for entry in model.card["history"]]
    again = run(tmp_path, shapes, replace(QUICK, learning_rate=1.0, steps=32))
    assert [entry["step"] for entry in model.card["history"]] == [8, 16, 24, 32]
    assert weights(again).keys() == weights(model).keys()
    assert max(curve) >= curve[-1]


def test_the_best_model_so_far_can_be_used_while_training_goes_on(shapes, tmp_path):
    steps = []

    def look(event):
        if event["event"] == "validation" and event["improved"]:
            steps.append(event["step"])
            assert load_model(tmp_path / MODEL).card["step"] == event["step"]

    assert run(tmp_path, shapes, report=look).card["step"] == steps[-1]
    assert steps[0] == QUICK.validate_every


def test_without_validation_the_model_is_there_from_the_first_checkpoint(shapes, tmp_path):
    def look(event):
        if event.get("step") == 5:
            assert load_model(tmp_path / MODEL).card["step"] == 4

    assert fit(SMALL, RECIPE, shapes, tmp_path, settings=QUICK, report=look).card["step"] == QUICK.steps


def test_averaged_weights_forget_the_start_and_then_move_slowly():
    network = build(Architecture("one", "SC FC1", 1, 1, bias=False))
    average, weight = AveragedWeights(network, 0.9), next(network.parameters())
    with torch.no_grad():
        weight.fill_(4.0)
    average.follow(network, 1)
    assert next(average.network.parameters()).item() == pytest.approx(0.9 * 4 + 0.1 * average_start(network))
    average.follow(network, 10**6)
    kept = next(average.network.parameters()).item()
    with torch.no_grad():
        weight.fill_(0.0)
    average.follow(network, 10**6)
    assert next(average.network.parameters()).item() == pytest.approx(0.9 * kept)


def average_start(network):
    return next(build(network.architecture).parameters()).item()


def test_training_stops_early_when_nothing_gets_better(shapes, tmp_path):
    settings = replace(QUICK, steps=4000, validate_every=4, patience=3, learning_rate=1e-9)
    model = run(tmp_path, shapes, settings)
    assert model.card["steps"] < 4000


def test_a_folder_of_another_training_is_not_overwritten(shapes, tmp_path):
    run(tmp_path, shapes)
    with pytest.raises(ParameterError, match="other shapes or settings"):
        run(tmp_path, shapes, replace(QUICK, pairs=20))
    with pytest.raises(ParameterError, match="other shapes or settings"):
        fit(SMALL, RECIPE, shapes[1:], tmp_path, settings=QUICK, validation=shapes[2:])


def test_a_damaged_checkpoint_is_named(shapes, tmp_path):
    (tmp_path / CHECKPOINT).write_bytes(b"nothing of the kind")
    with pytest.raises(ShapeFileError, match="Remove it to start anew"):
        run(tmp_path, shapes)


def test_a_loss_that_is_no_number_stops_the_training(tmp_path):
    bad = [made_up(np.full((20, 3, 12), np.nan), name=f"{i}") for i in range(2)]
    with pytest.raises(ConvergenceError, match="at step 0"):
        fit(SMALL, RECIPE, bad, tmp_path, settings=QUICK)


@pytest.mark.parametrize(
    ("shapes", "complaint"),
    [
        ([numbered(np.arange(20))], "at least two shapes"),
        ([numbered(np.arange(20)), numbered(np.arange(30, 50))], "no two of them do"),
    ],
)
def test_sets_that_cannot_be_compared_are_explained(shapes, complaint):
    with pytest.raises(ParameterError, match=complaint):
        PairSampler(shapes, pairs=8, seed=0)


def test_losses_that_do_not_fit_the_network_are_explained(shapes, tmp_path):
    with pytest.raises(ParameterError, match="'multinomial' does not fit small"):
        fit(SMALL, RECIPE, shapes, tmp_path, settings=TrainingSettings(loss="multinomial"))
    classifier = Architecture("mine", "SC FCreference Softmax", 3, 12, reference_size=10)
    with pytest.raises(ParameterError, match="reference_size must be above 161"):
        fit(classifier, RECIPE, shapes, tmp_path, settings=TrainingSettings(loss="multinomial"))


@pytest.mark.parametrize(
    "setting",
    [
        {"steps": 0},
        {"noise": -1.0},
        {"averaging": 1.0},
        {"loss": "hinge"},
        {"learning_rate": 0.0},
        {"arithmetic": "float8"},
        {"device": "cuda:99"},
    ],
)
def test_settings_out_of_range_are_named(setting):
    with pytest.raises(ParameterError, match=next(iter(setting))):
        TrainingSettings(**setting)


def test_the_learning_rate_falls_like_a_cosine():
    settings = TrainingSettings(steps=100, learning_rate=2.0)
    assert_allclose([learning_rate(settings, step) for step in (0, 50, 100)], [2.0, 1.0, 0.0], atol=1e-12)
    assert learning_rate(TrainingSettings(optimizer="adadelta"), 77) == 1.0


def test_training_in_one_call_makes_a_model_that_describes_shapes(tmp_path):
    task = LearningTask([body(seed) for seed in range(3)], [body(3), body(4)])
    events = []
    settings = replace(QUICK, steps=4)
    model = train(
        task, tmp_path, architecture="mADD2", recipe=RECIPE, settings=settings, report=events.append, workers=1
    )
    loaded = load_model(tmp_path / MODEL)
    shape = body(9).shape
    described = loaded.describe(shape, workers=1, cache=False)
    assert described.shape == (shape.vertex_count, 16)
    assert_array_equal(described, model.describe(shape, workers=1, cache=False))
    kinds = ["prepare"] * 6 + ["step"] * 3 + ["validation", "step", "done"]
    assert [event["event"] for event in events] == kinds


def test_nothing_to_learn_from_is_explained(tmp_path):
    with pytest.raises(ParameterError, match="at least one shape"):
        train([], tmp_path, recipe=RECIPE)
    with pytest.raises(ParameterError, match="architecture must be one of"):
        train([body(0)], tmp_path, architecture="ADD7")
    with pytest.raises(ParameterError, match="all are -1"):
        TrainingShape(body(0).shape, np.full(162, -1))


@pytest.mark.parametrize(
    ("symmetry", "problem"),
    [
        (np.zeros((3, 3), dtype=int), r"symmetry must have shape \(n,\)"),
        ("abc", r"symmetry must have shape \(n,\)"),
        (np.arange(162) + 10**6, "symmetry must be from -1 to 161"),
        (np.roll(np.arange(162), 1), "lead back in two steps, but it mostly does not"),
    ],
)
def test_a_symmetry_that_is_none_is_refused_before_anything_is_computed(symmetry, problem):
    with pytest.raises(ParameterError, match=problem):
        LearningTask([body(0), body(1)], symmetry=symmetry)


@pytest.mark.parametrize("data", [None, 3, "humans", [None, None], [body(0).shape]])
def test_what_is_no_set_of_training_shapes_is_explained(data, tmp_path):
    with pytest.raises(
        ParameterError, match=r"training(\[0\])? must be a (Sequence|TrainingShape), but it is .*Name the"
    ):
        train(data, tmp_path)
    with pytest.raises(ParameterError, match="shape must be a TriangleMesh or a PointCloud, but it is None"):
        TrainingShape(None, np.arange(3))
