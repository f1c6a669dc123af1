"""A model that trains on: what is shown of it is always one state, and the newest that is complete."""

import os
from dataclasses import dataclass, replace

import numpy as np
import pytest

from add_viewer.controllers.answers import Answers
from add_viewer.controllers.model_states import ModelStates
from add_viewer.models.jobs import Jobs


@dataclass(frozen=True)
class About:
    """A shape by one state of a model."""

    shape: str
    stamp: int
    kind = "describe"
    title = "a model of a shape"
    file_name = "values.npz"

    def arguments(self, output):
        return ("describe", self.shape, str(self.stamp))

    def read(self, output, said):
        return np.zeros(3)


class World:
    """A model whose state a test chooses, and answers that it gives."""

    def __init__(self, folder, run):
        self.jobs, self.run = Jobs(folder / "jobs"), run
        self.model = folder / "model.safetensors"
        self.answers = Answers(self.jobs, run)
        self.states = ModelStates(self.answers, lambda shape, name, stamp: About(shape, stamp))

    def learn(self, stamp):
        self.model.touch()
        os.utime(self.model, ns=(stamp, stamp))

    def renew(self, *shapes):
        self.states.renew(str(self.model), shapes)

    @property
    def shown(self):
        return self.states.shown(str(self.model))

    @property
    def asked(self):
        return [job.request.arguments[1:] for job in self.jobs.all if not job.is_finished]

    def answer(self, state="done"):
        job = next(job for job in self.jobs.all if not job.is_finished)
        self.jobs.put(replace(job, state=state))
        self.run.answer_all()


@pytest.fixture
def world(tmp_path, run):
    made = World(tmp_path, run)
    made.learn(100)
    assert made.shown == 100
    return made


def test_a_newer_state_is_shown_once_every_shape_has_it(world):
    world.learn(200)
    world.renew("one", "two")
    assert world.asked == [("one", "200"), ("two", "200")]
    world.answer()
    assert world.shown == 100
    world.answer()
    assert world.shown == 200


def test_a_model_that_learns_quickly_is_followed_one_state_at_a_time(world):
    world.learn(200)
    world.renew("one")
    for stamp in (300, 400):
        world.learn(stamp)
        world.renew("one")
    assert world.asked == [("one", "200")]
    world.answer()
    assert (world.shown, world.asked) == (200, [("one", "400")])


def test_a_state_that_cannot_be_computed_leaves_the_shown_one(world):
    world.learn(200)
    world.renew("one", "two")
    world.answer()
    world.answer("failed")
    assert world.shown == 100


def test_a_shape_opened_meanwhile_gets_the_newest_state_for_all(world):
    world.learn(200)
    world.states.catch_up(str(world.model))
    assert world.shown == 200


def test_nothing_is_asked_for_a_state_that_is_shown_already_or_a_model_that_is_gone(world):
    world.renew("one")
    world.model.unlink()
    world.renew("one")
    assert (world.asked, world.shown) == ([], 100)


def test_descriptors_without_a_file_have_one_state(world):
    assert world.states.shown("hks") == 0
    world.states.catch_up("hks")
    world.states.renew("hks", ["one"])
    assert (world.states.shown("hks"), world.asked) == (0, [])
