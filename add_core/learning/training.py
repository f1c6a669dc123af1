"""Training: from shapes with known correspondence to a model, in steps that can be stopped and gone on with."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from hashlib import blake2b
from pathlib import Path
from typing import Any

import numpy as np
import torch

from .._check import FloatArray, IntArray, points_array
from ..errors import Cancelled, ConvergenceError, ParameterError
from ..geometry import TriangleMesh
from .architectures import Architecture, Network, build, take_over
from .averaging import AveragedWeights
from .checkpoints import Checkpoint
from .inputs import InputRecipe, Moments
from .model import RUN_MODEL, Model
from .objective import Objective, mirror_channels
from .pairs import PairSampler
from .settings import TrainingSettings, learning_rate
from .training_set import PreparedShape
from .validation import Validator

Report = Callable[[dict[str, Any]], object]

CHECKPOINT, MODEL = "checkpoint.pt", RUN_MODEL
SMOOTHING = 4.0
"""Of descriptors: the best on the validation people. A correspondence network, which names vertices, has none."""


def fit(
    architecture: Architecture,
    recipe: InputRecipe,
    shapes: Sequence[PreparedShape],
    folder: str | Path,
    *,
    settings: TrainingSettings | None = None,
    validation: Sequence[PreparedShape] = (),
    symmetry: IntArray | None = None,
    positions: FloatArray | None = None,
    reference: TriangleMesh | None = None,
    start: Network | None = None,
    report: Report | None = None,
    card: dict[str, Any] | None = None,
) -> Model:
    """Train a network on prepared shapes, writing checkpoints and the model into `folder`, and return the model.

    A folder that holds a checkpoint of the same training is gone on with, to the same weights, bit for bit, as without
    the interruption. symmetry : (P,), the place that mirrors each place, whose pairs become negatives.
    positions : (P, 3), where each place is on one body, by which vertices of different meshings have counterparts: see
        `nearby_pairs`. None learns from places alone that two shapes share.
    reference, card : of the model. start : a network whose layers are taken over, see `take_over`.
    report : called with a dictionary for each event ("step", "validation", "done"); returning False stops the training
        after a checkpoint and raises Cancelled.

    The model has the averaged weights of the validation with the highest CMC@1, or the last ones without validation.
    Its file is there from the first validation on, or the first checkpoint without any, and is replaced as a whole by
    each better one.
    Raises ParameterError for sets or settings that do not fit, ConvergenceError if the loss stops being a number.
    """
    chosen = settings or TrainingSettings()
    network = build(architecture, seed=chosen.seed)
    if start is not None:
        take_over(network, start)
    _check_classes(network, chosen, shapes)
    if positions is not None and chosen.loss == "multinomial":
        raise ParameterError("positions are of no use to the loss 'multinomial', which names places. Leave them out.")
    pooled = Moments.pooled([shape.moments for shape in shapes])
    moments = pooled if chosen.standardisation == "set" else None
    smoothing = 0.0 if network.is_classifier else SMOOTHING
    about = [asdict(architecture), asdict(recipe), asdict(chosen)]
    about.append({"data": _fingerprint([*shapes, *validation], symmetry, positions, network)})
    run = _Run(
        network,
        chosen,
        objective=Objective(chosen, mirror_channels(recipe, symmetry), repeated=recipe.isotropic),
        sampler=_sampler(shapes, recipe, chosen, symmetry, moments, positions),
        validator=Validator(validation, symmetry=symmetry, moments=moments) if validation else None,
        model=lambda trained, facts: Model(
            trained, recipe, pooled, chosen.standardisation, facts | (card or {}), reference, smoothing
        ),
        about=json.dumps(about),
        folder=Path(folder),
        report=report or (lambda event: None),
    )
    run.go_on()
    return run.finish()


class _Run:
    """One training in one folder. model : makes one of a network and facts about its training."""

    def __init__(
        self,
        network: Network,
        settings: TrainingSettings,
        *,
        objective: Objective,
        sampler: PairSampler,
        validator: Validator | None,
        model: Callable[[Network, dict[str, Any]], Model],
        about: str,
        folder: Path,
        report: Report,
    ) -> None:
        self.settings, self.objective, self.model = settings, objective, model
        self.sampler, self.validator = sampler, validator
        self.folder, self.report = folder, report
        folder.mkdir(parents=True, exist_ok=True)
        self.network = network.to(settings.device)
        self.average = AveragedWeights(self.network, settings.averaging)
        self.optimizer = _optimizer(self.network, settings)
        self.state = Checkpoint(about, 0, {}, {})
        self._resume()

    def _resume(self) -> None:
        found = Checkpoint.load(self.folder / CHECKPOINT)
        if found is None:
            return
        if found.about != self.state.about:
            raise ParameterError(f"{self.folder} holds a training of other shapes or settings. Choose another folder.")
        self.state = found
        self.network.load_state_dict(found.network)
        self.average.network.load_state_dict(found.average or found.network)
        self.optimizer.load_state_dict(found.optimizer)

    def go_on(self) -> None:
        """Take the steps that are left."""
        settings, state, since = self.settings, self.state, time.monotonic()
        first = state.step
        while state.step < settings.steps and not self._is_exhausted():
            loss = self._step(state.step)
            state.step += 1
            last = state.step == settings.steps
            if self.validator is not None and (last or state.step % settings.validate_every == 0):
                self._validate()
            if last or state.step % settings.checkpoint_every == 0:
                self._save()
                if self.validator is None:
                    self._publish(self.average.network, state.step)
            speed = (state.step - first) / max(time.monotonic() - since, 1e-9)
            event = {"event": "step", "step": state.step, "steps": settings.steps, "loss": loss, "per_second": speed}
            if self.report(event) is False:
                self._save()
                raise Cancelled(
                    f"Stopped on request after step {state.step} of {settings.steps}; the same command goes on."
                )
        if self._is_exhausted():
            self._save()

    def finish(self) -> Model:
        """The model with the best weights, written to the folder."""
        best = self.average.network
        if self.state.best is not None:
            best.load_state_dict(self.state.best)
        curve = [entry["cmc1"] for entry in self.state.history]
        step = self.state.history[int(np.argmax(curve))]["step"] if curve else self.state.step
        model = self._publish(best, step)
        self.report({"event": "done", "model": str(self.folder / MODEL), "steps": self.state.step})
        return model

    def _publish(self, network: Network, step: int) -> Model:
        """Write a model of the weights that `network` had at `step`."""
        facts = {"step": step, "steps": self.state.step, "settings": asdict(self.settings)}
        model = self.model(network.cpu(), facts | {"history": list(self.state.history)})
        model.save(self.folder / MODEL)
        network.to(self.settings.device)
        return model

    def _step(self, step: int) -> float:
        for group in self.optimizer.param_groups:
            group["lr"] = learning_rate(self.settings, step)
        batch = self.sampler.batch(step)
        self.network.train()
        loss = self.objective.loss(self.network, batch, step)
        value = float(loss.detach())
        if not np.isfinite(value):
            raise ConvergenceError(
                f"the loss is {value} at step {step}. Lower the learning rate, or check the inputs for extreme values."
            )
        self.optimizer.zero_grad(set_to_none=True)
        loss.backward()
        self.optimizer.step()
        self.average.follow(self.network, step + 1)
        return value

    def _validate(self) -> None:
        assert self.validator is not None
        network = self.average.network
        scores = {"step": self.state.step, **asdict(self.validator.scores(network.cpu()))}
        network.to(self.settings.device)
        best = max((entry["cmc1"] for entry in self.state.history), default=-1.0)
        self.state.history.append(scores)
        if scores["cmc1"] > best:
            self.state.best = {name: value.clone() for name, value in network.state_dict().items()}
            self._publish(network, self.state.step)
        self.report({"event": "validation", **scores, "improved": scores["cmc1"] > best})

    def _is_exhausted(self) -> bool:
        """Whether the last `patience` validations brought nothing better."""
        patience, curve = self.settings.patience, [entry["cmc1"] for entry in self.state.history]
        return 0 < patience < len(curve) and max(curve[-patience:]) <= max(curve[:-patience])

    def _save(self) -> None:
        weights = {"network": self.network.state_dict(), "average": self.average.network.state_dict()}
        saved = replace(self.state, optimizer=self.optimizer.state_dict(), **weights)
        saved.save(self.folder / CHECKPOINT)


def _sampler(
    shapes: Sequence[PreparedShape],
    recipe: InputRecipe,
    settings: TrainingSettings,
    symmetry: IntArray | None,
    moments: Moments | None,
    positions: FloatArray | None,
) -> PairSampler:
    images: list[PreparedShape] = []
    if settings.reflections and symmetry is not None:
        images = [shape.reflected(symmetry, recipe.mirror_channels) for shape in shapes]
    return PairSampler(
        [*shapes, *images],
        pairs=settings.pairs,
        seed=settings.seed,
        symmetry=symmetry,
        moments=moments,
        positions=None if positions is None else points_array("positions", positions),
    )


def _optimizer(network: Network, settings: TrainingSettings) -> torch.optim.Optimizer:
    rate = learning_rate(settings, 0)
    if settings.optimizer == "adadelta":
        return torch.optim.Adadelta(network.parameters(), lr=rate, rho=0.95, eps=1e-6)
    return torch.optim.Adam(network.parameters(), lr=rate)


def _check_classes(network: Network, settings: TrainingSettings, shapes: Sequence[PreparedShape]) -> None:
    if network.is_classifier != (settings.loss == "multinomial"):
        raise ParameterError(
            f"loss {settings.loss!r} does not fit {network.architecture.name}: networks that end in Softmax learn by "
            "'multinomial', the others by 'siamese' or 'soft-nearest'."
        )
    most = max(int(shape.places.max()) for shape in shapes) if shapes else 0
    if network.is_classifier and most >= network.outputs:
        raise ParameterError(f"reference_size must be above {most}, the highest place, but it is {network.outputs}.")


def _fingerprint(
    shapes: Sequence[PreparedShape], symmetry: IntArray | None, positions: FloatArray | None, network: Network
) -> str:
    """A hash of what is learned from and where learning starts."""
    digest = blake2b(digest_size=12)
    for shape in shapes:
        for array in (shape.moments.mean, shape.moments.deviation, shape.places):
            digest.update(np.ascontiguousarray(array).tobytes())
    digest.update(b"none" if symmetry is None else np.ascontiguousarray(symmetry).tobytes())
    if positions is not None:
        digest.update(np.ascontiguousarray(positions).tobytes())
    for weights in network.state_dict().values():
        digest.update(weights.numpy().tobytes())
    return digest.hexdigest()
