"""Trainings as jobs: started, listed, heard, offered as descriptors, deleted."""

import pytest

from add_viewer.controllers.training import TrainingController
from add_viewer.models.jobs import Job, Jobs
from add_viewer.models.training import MODEL_FILE, TrainingRequest

SCORES = {"loss": 2.0, "auc": 0.9, "cmc1": 0.4, "cmc10": 0.5, "right_side": 0.7}


class World:
    """Jobs that nobody runs."""

    def __init__(self, home):
        self.jobs, self.gone, self.complaints, self.asked = Jobs(home), [], [], []
        self.jobs.asked.connect(lambda verb, id: self.asked.append((verb, id)))
        self.trainings = TrainingController(self.jobs, self.gone.append, self.complaints.append)
        self.better = []
        self.trainings.models_changed.connect(self.better.append)

    def make_model(self, id):
        path = self.jobs[id].request.folder / MODEL_FILE
        path.parent.mkdir(parents=True)
        path.touch()
        return path


@pytest.fixture
def world(tmp_path):
    return World(tmp_path)


def test_a_request_becomes_a_job_that_can_go_on(world):
    id = world.trainings.start(TrainingRequest())
    job = world.jobs[id]
    assert job.request.resumable
    assert job.request.arguments[0] == "train"
    assert str(job.request.folder) in " ".join(job.request.arguments)
    assert world.asked == [("start", id)]


def test_trainings_of_one_kind_are_told_apart(world):
    requests = (TrainingRequest(), TrainingRequest(), TrainingRequest("ADD1"), TrainingRequest())
    ids = [world.trainings.start(request) for request in requests]
    titles = [world.jobs[id].request.title for id in ids]
    assert titles == ["mADD3 on people", "mADD3 on people, no. 2", "ADD1 on people", "mADD3 on people, no. 3"]


@pytest.mark.parametrize("data", ["", "/no/such/folder"])
def test_a_folder_that_is_not_there_is_a_message_and_no_job(world, data):
    assert world.trainings.start(TrainingRequest(data=data)) is None
    assert world.jobs.all == ()
    assert "There is no folder" in world.complaints[0]


def test_without_torch_the_person_learns_what_to_install(world, monkeypatch):
    monkeypatch.setattr("add_viewer.controllers.training.find_spec", lambda name: None)
    assert world.trainings.start(TrainingRequest()) is None
    assert "pip install torch safetensors" in world.complaints[0]
    assert world.jobs.all == ()


def test_a_better_checkpoint_is_announced_once_it_is_there(world):
    id = world.trainings.start(TrainingRequest())
    world.jobs.said.emit(id, {"event": "validation", "step": 5, **SCORES, "improved": True})
    assert (world.better, world.trainings.models()) == ([], [])
    path = world.make_model(id)
    world.jobs.said.emit(id, {"event": "validation", "step": 10, **SCORES, "improved": False})
    assert world.better == []
    world.jobs.said.emit(id, {"event": "validation", "step": 15, **SCORES, "improved": True})
    assert world.better == [str(path)]
    ((title, offered),) = world.trainings.models()
    assert title.startswith("mADD3 on people (")
    assert offered == str(path)


def test_a_training_that_is_done_lets_its_inputs_go_and_keeps_its_model(world):
    id = world.trainings.start(TrainingRequest())
    path = world.make_model(id)
    world.jobs.put(Job(id, world.jobs[id].request, state="done"))
    assert world.gone == [path.parent / "inputs"]
    assert world.better == [str(path)]


def test_curves_of_an_earlier_window_are_recalled_once(world):
    id = world.trainings.start(TrainingRequest())
    world.jobs.put(Job(id, world.jobs[id].request, state="interrupted"))
    after = World(world.jobs.home)
    after.jobs.put(world.jobs[id])
    assert after.trainings.curves(id).steps == []
    assert after.trainings.curves(id).steps == []
    assert after.asked == [("recall", id)]
    after.jobs.said.emit(id, {"event": "step", "step": 1, "steps": 9, "loss": 3.0})
    assert after.trainings.curves(id).losses == [3.0]


def test_only_a_training_that_does_not_run_can_be_deleted(world):
    id = world.trainings.start(TrainingRequest())
    folder = world.jobs[id].request.folder
    world.trainings.delete(id)
    assert (id in world.jobs, world.gone) == (True, [])
    world.jobs.put(Job(id, world.jobs[id].request, state="cancelled"))
    world.trainings.delete(id)
    assert (id in world.jobs, world.gone, world.better) == (False, [folder], [""])


def test_other_jobs_are_no_trainings(world, make_job):
    world.jobs.put(make_job("describe", world.jobs))
    world.jobs.said.emit(world.jobs.all[0].id, {"event": "step", "step": 1, "steps": 2, "loss": 1.0})
    assert world.trainings.runs == ()


@pytest.fixture
def make_job():
    from add_viewer.models.jobs import JobRequest

    def made(kind, jobs):
        folder = jobs.new_folder(kind)
        return Job(folder.name, JobRequest(kind, "a job", (), folder))

    return made
