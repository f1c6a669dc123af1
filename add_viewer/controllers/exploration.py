"""What is computed for looking closer: descriptors, fields, mirror maps, matchings, and the numbers beside them."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

from add_core.io import shipped_models

from ..models.descriptor_names import name_models
from ..models.insights import Insights
from ..models.jobs import Jobs
from ..models.results import Results
from ..models.session import Session
from .answers import Answers
from .best_matches import BestMatchesController
from .descriptors import DescriptorStore
from .field_plans import Sources
from .fields import FieldController
from .matching import MatchingController
from .operators import OperatorStore
from .running import Run
from .symmetry import SymmetryController

Models = Callable[[], list[tuple[str, str]]]
"""Titles and paths of the person's trained models, the newest first."""


class Exploration:
    """Wires these controllers to each other. models : the person's trained ones; replace it to offer some."""

    def __init__(
        self, session: Session, results: Results, insights: Insights, jobs: Jobs, run: Run, operators: OperatorStore
    ) -> None:
        self.models: Models = list
        self._session, self.insights = session, insights
        self.answers = Answers(jobs, run)
        self.descriptors = DescriptorStore(self.answers, self._paths, learned_models)
        self.matching = MatchingController(session, results, insights, self.answers)
        self.sources = Sources(results, self.answers, self.descriptors, operators, self.matching)
        self.fields = FieldController(session, self.sources, run)
        self.best = BestMatchesController(session, results, insights, run)
        self.symmetry = SymmetryController(session, results, insights, self.descriptors)
        session.shapes_changed.connect(self.refresh_names)
        jobs.finished.connect(lambda _id: self.refresh_names())
        self.refresh_names()

    def refresh_names(self) -> None:
        """Look anew at which descriptors there are: a training may have ended, or written a model."""
        name_models({path: title for title, path in self.models()})
        self.insights.set_descriptors(self.descriptors.names)

    def improve(self, model: str) -> None:
        """A training wrote a better model: let what is shown of it follow."""
        self.refresh_names()
        state = self._session.state
        used = {choice.descriptor for choice in state.choices} | {state.matching.descriptor}
        if model in used:
            self.descriptors.states.renew(model, state.shapes)

    def _paths(self) -> tuple[str, ...]:
        return tuple(path for _, path in self.models())


def learned_models() -> tuple[str, ...]:
    """The shipped ones, if what they need is installed."""
    return shipped_models() if find_spec("torch") is not None else ()
