"""Budgets of trainings: steps that fit into a time, and shapes that stand for all of them."""

import pytest

from add_core.errors import ParameterError
from add_core.io import humans
from add_core.learning import LearningTask, TrainingSettings, train
from add_core.learning import budget as budget_module
from add_core.learning.budget import TRIAL, within


class Clock:
    """A trial whose steps take half a second, the first two of them five, and whose last ends with a validation."""

    def __init__(self, monkeypatch, validation=10.0):
        self.now, self.validation, self.trials = 0.0, validation, 0
        monkeypatch.setattr(budget_module.time, "perf_counter", lambda: self.now)

    def try_out(self, settings, folder, report):
        self.trials += 1
        assert settings.steps == TRIAL
        for step in range(1, TRIAL + 1):
            self.now += 5.0 if step <= 2 else 0.5
            self.now += self.validation if step == TRIAL else 0.0
            report({"event": "step", "step": step})
        report({"event": "done"})


def test_minutes_become_steps_at_the_speed_of_this_machine_with_its_validations(monkeypatch, tmp_path):
    clock = Clock(monkeypatch)
    settings = within(10, TrainingSettings(validate_every=20), tmp_path, clock.try_out)
    assert settings.steps == 600  # half a second and a twentieth of ten seconds each


def test_a_training_that_is_gone_on_with_keeps_its_number_of_steps(monkeypatch, tmp_path):
    clock = Clock(monkeypatch)
    first = within(1, TrainingSettings(), tmp_path / "run", clock.try_out)
    assert within(1, TrainingSettings(), tmp_path / "run", clock.try_out) == first
    assert clock.trials == 1
    assert within(99, TrainingSettings(), tmp_path / "run", clock.try_out).steps > first.steps


def test_there_is_always_time_for_one_validation(monkeypatch, tmp_path):
    clock = Clock(monkeypatch)
    assert within(0.001, TrainingSettings(validate_every=7), tmp_path, clock.try_out).steps == 7


def test_no_time_at_all_is_a_mistake(tmp_path):
    with pytest.raises(ParameterError, match="minutes must be"):
        within(0, TrainingSettings(), tmp_path, lambda *_: None)
    people = LearningTask.of(humans(), most=2)
    with pytest.raises(ParameterError, match="minutes must be"):
        train(people, tmp_path, minutes=-1.0, report=lambda event: pytest.fail("No inputs are made before."))


def test_a_few_shapes_are_spread_over_all_people_and_keep_a_person_for_validation():
    task = LearningTask.of(humans(), most=6)
    every = LearningTask.of(humans())
    assert (len(task.training), len(task.validation)) == (6, 3)
    names = [item.shape.name for item in task.training]
    assert names[0] == every.training[0].shape.name
    assert names[-1] == every.training[-1].shape.name
    assert len({name.split(",")[0] for name in names}) == 6
