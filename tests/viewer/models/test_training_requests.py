"""What a training is asked for, and what its curves make of what it says."""

from dataclasses import replace

import pytest
from click.testing import CliRunner

from add_core.cli.train import command
from add_viewer.models.training import ARCHITECTURES, EFFORTS, MODEL_FILE, TrainingRequest
from add_viewer.models.training_curves import TrainingCurves, binned


def step(number, loss=1.0, of=100):
    return {"event": "step", "step": number, "steps": of, "loss": loss}


def validation(number, cmc1):
    scores = {"loss": 2.0, "auc": 0.9, "cmc1": cmc1, "cmc10": 0.5, "right_side": None}
    return {"event": "validation", "step": number, **scores}


@pytest.mark.parametrize("architecture", [option.name for option in ARCHITECTURES])
@pytest.mark.parametrize("budget", [{}, {"steps": None, "minutes": 2.5}])
def test_the_command_understands_every_request(tmp_path, architecture, budget):
    """Parsed by the command itself: an option that it does not have would be status 2."""
    request = replace(TrainingRequest(architecture=architecture, isotropic=True), **budget)
    for effort in EFFORTS:
        word, *arguments = request.with_effort(effort).arguments(tmp_path)
        assert word == "train"
        context = command.make_context("train", list(arguments))
        assert context.params["architecture"] == architecture
        assert context.params["run"] == tmp_path / MODEL_FILE.parent
        assert context.params["isotropic"]
        assert context.params["shapes"] == effort.shapes
        assert context.params["count"] == effort.eigenpairs
        assert context.params["minutes"] == request.minutes
        assert budget or context.params["steps"] == effort.steps
        assert (context.params["loss"] == "multinomial") == (architecture == "mADD4")


def test_an_unknown_option_would_be_found():
    assert CliRunner().invoke(command, ["--unicorns", "3"]).exit_code == 2


def test_a_request_knows_which_effort_it_is_until_its_numbers_are_changed():
    for effort in EFFORTS:
        assert TrainingRequest().with_effort(effort).effort is effort
    assert replace(TrainingRequest(), angles=5).effort is None
    assert replace(TrainingRequest(), steps=None, minutes=3.0).effort is EFFORTS[0]


@pytest.mark.parametrize(
    ("changes", "title"),
    [
        ({}, "mADD3 on people"),
        ({"isotropic": True, "architecture": "ADD1", "data": "dogs"}, "isotropic ADD1 on dogs"),
        ({"data": "/somewhere/my shapes"}, "mADD3 on my shapes"),
    ],
)
def test_a_title_says_what_learns_from_what(changes, title):
    assert replace(TrainingRequest(), **changes).title == title


def test_curves_of_a_training_that_went_on_from_a_checkpoint_hold_each_step_once():
    curves = TrainingCurves()
    for event in (step(1, 9.0), step(2, 8.0), validation(2, 0.1), step(3, 7.0), step(4, 6.0), validation(4, 0.3)):
        assert curves.hear(event)
    for event in (step(3, 7.5), step(4, 6.5), validation(4, 0.2), step(5, 5.0)):
        curves.hear(event)
    assert (curves.steps, curves.losses) == ([1, 2, 3, 4, 5], [9.0, 8.0, 7.5, 6.5, 5.0])
    assert [(each.step, each.cmc1) for each in curves.validations] == [(2, 0.1), (4, 0.2)]


def test_the_best_validation_is_the_one_whose_weights_the_model_has():
    curves = TrainingCurves()
    for number, cmc1 in ((1, 0.2), (2, 0.5), (3, 0.5), (4, 0.1)):
        curves.hear(validation(number, cmc1))
    assert curves.best is not None
    assert (curves.best.step, curves.latest.step) == (2, 4)


def test_what_is_no_curve_changes_none():
    assert not TrainingCurves().hear({"event": "prepare", "name": "body", "done": 1, "total": 4})


def test_bins_are_means_of_neighbours_and_lose_nothing():
    steps, values = binned([1, 2, 3, 4, 5], [1.0, 3.0, 5.0, 7.0, 9.0], 3)
    assert (steps, values) == ([1.5, 3.5, 5.0], [2.0, 6.0, 9.0])
    assert binned([1, 2], [5.0, 6.0], 80) == ([1.0, 2.0], [5.0, 6.0])
    assert binned([], [], 80) == ([], [])
