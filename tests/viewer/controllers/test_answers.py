"""Questions to processes: asked once, answered from memory, dropped when there is no room. No Qt."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from balls import Core, open_ball

from add_core.errors import ShapeFileError
from add_viewer.controllers.answers import Answers
from add_viewer.controllers.descriptors import DescriptorQuestion, DescriptorStore
from add_viewer.controllers.symmetry import SymmetryController
from add_viewer.models.insights import Insights
from add_viewer.models.jobs import Jobs
from add_viewer.models.results import Results
from add_viewer.models.session import Session


@dataclass(frozen=True)
class Ones:
    """Answered by 8,000 bytes."""

    name: str
    what: str = "ones"
    kind = "describe"
    file_name = "ones.npy"

    @property
    def title(self):
        return f"{self.what} for {self.name}"

    def arguments(self, output: Path):
        return ("ones", str(output))

    def read(self, output, said):
        if self.name == "broken":
            raise ShapeFileError("is damaged.")
        return np.ones(1000)


@pytest.fixture
def world(tmp_path, run):
    jobs = Jobs(tmp_path)
    answers = Answers(jobs, run, room=20_000)
    heard = []
    answers.arrived.connect(heard.append)
    return jobs, answers, heard


def end(jobs, run, state="done"):
    (id,) = [job.id for job in jobs.all if not job.is_finished]
    jobs.put(replace(jobs[id], state=state, message="it broke"))
    run.answer_all()


def test_a_job_is_called_by_its_question_with_a_capital_unless_a_name_begins_it(world):
    jobs, answers, _ = world
    answers.want(Ones("a"))
    answers.want(Ones("a", "mADD3"))
    assert [job.request.title for job in jobs.all] == ["Ones for a", "mADD3 for a"]
    assert answers.message(Ones("a", "mADD3")) == "Computing mADD3 for a …"


def test_a_question_is_asked_once_and_then_answered_from_memory(world, run):
    jobs, answers, heard = world
    assert answers.want(Ones("a")) is None
    assert answers.want(Ones("a")) is None
    assert len(jobs.all) == 1
    jobs.put(replace(jobs.all[0], state="running", done=2, total=5))
    assert answers.message(Ones("a")) == "Computing ones for a … 40 %"
    end(jobs, run)
    assert heard == [Ones("a")]
    assert answers.want(Ones("a")) is answers.get(Ones("a"))


def test_what_was_not_used_longest_makes_room(world, run):
    jobs, answers, _ = world
    for name in ("a", "b", "c"):
        answers.want(Ones(name))
        end(jobs, run)
        answers.get(Ones("a"))
    assert answers.get(Ones("a")) is not None
    assert answers.get(Ones("b")) is None


def test_failures_are_kept_until_somebody_chooses_anew_or_tries_again(world, run):
    jobs, answers, heard = world
    answers.want(Ones("a"))
    end(jobs, run, "failed")
    assert heard == [Ones("a")]
    assert answers.message(Ones("a")) == "Ones for a: it broke"
    answers.want(Ones("a"))
    assert len(jobs.all) == 1
    jobs.put(replace(jobs.all[0], state="running"))  # "retry" in the list of jobs
    assert not answers.has_failed(Ones("a"))
    end(jobs, run, "failed")
    answers.forget_problems()
    answers.want(Ones("a"))
    assert [job.state for job in jobs.all] == ["failed", "waiting"]


def test_a_damaged_file_is_a_failure(world, run):
    jobs, answers, _ = world
    answers.want(Ones("broken"))
    end(jobs, run)
    assert "is damaged" in answers.message(Ones("broken"))


def test_a_file_that_changed_meanwhile_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    shape = open_ball(tmp_path)
    np.savez(tmp_path / "d.npz", vertices=np.zeros((7, 3)), hks=np.zeros((7, 16)))
    question = DescriptorQuestion(shape.reference, shape.shape, "hks", shape.name)
    with pytest.raises(ShapeFileError, match="has 7 vertices by now, but 162 when it was opened"):
        question.read(tmp_path / "d.npz", {})


def test_a_model_that_trains_on_is_another_question_about_a_state_that_stays(tmp_path):
    shape, model = open_ball(tmp_path), tmp_path / "model.safetensors"
    model.write_bytes(b"one")
    before = DescriptorQuestion.about(shape, str(model), 1)
    assert DescriptorQuestion.about(shape, str(model), 2) != before
    word, state, reference, *_ = before.arguments(tmp_path / "job" / "out.npz")
    (tmp_path / "better").write_bytes(b"two")
    (tmp_path / "better").replace(model)
    assert (word, reference, Path(state).read_bytes()) == ("describe", shape.reference, b"one")


def test_the_mirror_map_of_a_shape_is_found_by_itself(tmp_path, run, monkeypatch):
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path / "cache"))
    jobs, session, results = Jobs(tmp_path / "jobs"), Session(), Results()
    core, answers = Core(jobs), Answers(jobs, run)
    store = DescriptorStore(answers, lambda: (), lambda: ())
    insights = Insights()
    controller = SymmetryController(session, results, insights, store)
    shape = open_ball(tmp_path, symmetric=False)
    session.add_shape(shape)
    assert controller.message(shape.key) == ""
    controller.find(shape.key)
    assert "the mirror map of egg" in controller.message(shape.key)
    core.answer()
    run.answer_all()
    learned = session.state.shape(shape.key)
    assert learned.symmetry is not None
    assert 0 < learned.symmetry_confidence <= 1
    places = shape.shape.vertices - shape.shape.vertices.mean(axis=0)
    assert np.median(np.linalg.norm(places[learned.symmetry] - places * [-1, 1, 1], axis=1)) < 0.05
    session.pick(int(np.argmax(places[:, 0])))
    controller.compare("hks")
    assert next(each for each in insights.tellings if each.descriptor == "hks").message.startswith("Computing HKS")
    controller.compare("ahks")
    for _ in range(2):
        core.answer()
    run.answer_all()
    told = {each.descriptor: each.ratio for each in insights.tellings}
    assert told["hks"] < 0.05 < told["ahks"]
    assert told["wks"] is None
    session.undo()
    session.undo()
    assert session.state.shape(shape.key).symmetry is None
