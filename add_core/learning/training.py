"""Training: from shapes with known correspondence to a model, in steps that can be stopped and gone on with."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from hashlib import blake2b
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
import torch
from torch import Tensor

from .._check import IntArray, at_least_zero, count_in, one_of, positive
from ..errors import Cancelled, ConvergenceError, ParameterError
from .architectures import Architecture, Network, build
from .checkpoints import Checkpoint
from .inputs import InputRecipe, Moments
from .losses import BALANCE, MARGIN, multinomial_loss, siamese_loss, soft_nearest_loss, squared_distances
from .model import Model, Standardisation
from .pairs import Batch, PairSampler
from .training_set import PreparedShape
from .validation import Validator

Loss = Literal["soft-nearest", "siamese", "multinomial"]
Optimizer = Literal["adam", "adadelta"]
Report = Callable[[dict[str, Any]], object]

CHECKPOINT, MODEL = "checkpoint.pt", "model.safetensors"


@dataclass(frozen=True)
class TrainingSettings:
    """How to train.

    loss : "siamese", eq. (21); "multinomial", eq. (22), for networks that end in Softmax; or "soft-nearest".
    optimizer : "adadelta" as in the paper (learning rate 1, ρ = 0.95, ε = 1e-6), or "adam" with cosine decay to 0.
    learning_rate : None takes 1 or 0.001. steps : mini-batches in all. pairs : pairs of points in each.
    noise : standard deviation of the noise added to standardised inputs.
    reflections : learn from the mirror images of the shapes too, where a symmetry is known.
    hard_negatives : of the siamese loss: the nearest wrong point of the batch beside the mirror image and a random one.
    margin, balance : μ and γ of eq. (21). standardisation : see `Model`.
    validate_every, checkpoint_every : steps. patience : stop after so many validations without a better CMC@1; 0 never.
    """

    loss: Loss = "soft-nearest"
    optimizer: Optimizer = "adam"
    learning_rate: float | None = None
    steps: int = 3000
    pairs: int = 192
    noise: float = 0.1
    reflections: bool = True
    hard_negatives: bool = True
    margin: float = MARGIN
    balance: float = BALANCE
    standardisation: Standardisation = "shape"
    validate_every: int = 250
    checkpoint_every: int = 100
    patience: int = 0
    seed: int = 0

    def __post_init__(self) -> None:
        one_of("loss", self.loss, get_args(Loss))
        one_of("optimizer", self.optimizer, get_args(Optimizer))
        one_of("standardisation", self.standardisation, get_args(Standardisation))
        for name in ("steps", "validate_every", "checkpoint_every"):
            count_in(name, getattr(self, name), 1, 1_000_000_000)
        count_in("patience", self.patience, 0, 1_000_000)
        at_least_zero("noise", self.noise)
        if self.learning_rate is not None:
            positive("learning_rate", self.learning_rate)


def fit(
    architecture: Architecture,
    recipe: InputRecipe,
    shapes: Sequence[PreparedShape],
    folder: str | Path,
    *,
    settings: TrainingSettings | None = None,
    validation: Sequence[PreparedShape] = (),
    symmetry: IntArray | None = None,
    report: Report | None = None,
    card: dict[str, Any] | None = None,
) -> Model:
    """Train a network on prepared shapes, writing checkpoints and the model into `folder`, and return the model.

    A folder that holds a checkpoint of the same training is gone on with, to the same weights, bit for bit, as without
    the interruption. symmetry : (P,), the place that mirrors each place, whose pairs become negatives.
    report : called with a dictionary for each event ("step", "validation", "done"); returning False stops the training
        after a checkpoint and raises Cancelled.

    The model has the weights of the validation with the highest CMC@1, or the last ones without validation.
    Raises ParameterError for sets or settings that do not fit, ConvergenceError if the loss stops being a number.
    """
    chosen = settings or TrainingSettings()
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    run = _Run(architecture, recipe, shapes, chosen, validation, symmetry, place, report or (lambda event: None))
    run.go_on()
    return run.finish(card or {})


class _Run:
    """One training in one folder."""

    def __init__(
        self,
        architecture: Architecture,
        recipe: InputRecipe,
        shapes: Sequence[PreparedShape],
        settings: TrainingSettings,
        validation: Sequence[PreparedShape],
        symmetry: IntArray | None,
        folder: Path,
        report: Report,
    ) -> None:
        self.settings, self.recipe, self.folder, self.report = settings, recipe, folder, report
        self.network = build(architecture, seed=settings.seed)
        _check_classes(self.network, settings, shapes)
        self.pooled = Moments.pooled([shape.moments for shape in shapes])
        moments = self.pooled if settings.standardisation == "set" else None
        images: list[PreparedShape] = []
        if settings.reflections and symmetry is not None:
            images = [shape.reflected(symmetry, recipe.mirror_channels) for shape in shapes]
        self.sampler = PairSampler(
            [*shapes, *images], pairs=settings.pairs, seed=settings.seed, symmetry=symmetry, moments=moments
        )
        self.validator = Validator(validation, symmetry=symmetry, moments=moments) if validation else None
        self.optimizer = _optimizer(self.network, settings)
        about = [asdict(architecture), asdict(recipe), asdict(settings), _fingerprint([*shapes, *validation], symmetry)]
        self.state = Checkpoint(json.dumps(about), 0, {}, {})
        self._resume()

    def _resume(self) -> None:
        found = Checkpoint.load(self.folder / CHECKPOINT)
        if found is None:
            return
        if found.about != self.state.about:
            raise ParameterError(f"{self.folder} holds a training of other shapes or settings. Choose another folder.")
        self.state = found
        self.network.load_state_dict(found.network)
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
            speed = (state.step - first) / max(time.monotonic() - since, 1e-9)
            event = {"event": "step", "step": state.step, "steps": settings.steps, "loss": loss, "per_second": speed}
            if self.report(event) is False:
                self._save()
                raise Cancelled(
                    f"Stopped on request after step {state.step} of {settings.steps}; the same command goes on."
                )
        if self._is_exhausted():
            self._save()

    def finish(self, card: dict[str, Any]) -> Model:
        """The model with the best weights, written to the folder."""
        if self.state.best is not None:
            self.network.load_state_dict(self.state.best)
        facts = {"settings": asdict(self.settings), "steps": self.state.step, "history": self.state.history, **card}
        model = Model(self.network, self.recipe, self.pooled, self.settings.standardisation, facts)
        model.save(self.folder / MODEL)
        self.report({"event": "done", "model": str(self.folder / MODEL), "steps": self.state.step})
        return model

    def _step(self, step: int) -> float:
        for group in self.optimizer.param_groups:
            group["lr"] = learning_rate(self.settings, step)
        batch = self.sampler.batch(step)
        self.network.train()
        loss = self._loss(batch, step)
        value = float(loss.detach())
        if not np.isfinite(value):
            raise ConvergenceError(
                f"the loss is {value} at step {step}. Lower the learning rate, or check the inputs for extreme values."
            )
        self.optimizer.zero_grad(set_to_none=True)
        loss.backward()
        self.optimizer.step()
        return value

    def _loss(self, batch: Batch, step: int) -> Tensor:
        settings = self.settings
        inputs = torch.from_numpy(np.concatenate([batch.one, batch.two]))  # (2B, C, M)
        if settings.noise > 0:
            source = torch.Generator().manual_seed(
                int(np.random.SeedSequence([settings.seed, step]).generate_state(1)[0])
            )
            inputs = inputs + settings.noise * torch.randn(inputs.shape, generator=source)
        outputs = self.network.logits(inputs)
        places = torch.from_numpy(np.array(batch.places))
        if settings.loss == "multinomial":
            return multinomial_loss(outputs, torch.cat([places, places]))
        distances = squared_distances(*outputs.split(len(places)))
        same = places[:, None] == places[None, :]
        if settings.loss == "siamese":
            negatives = distances[negative_pairs(batch, distances.detach(), hard=settings.hard_negatives)]
            return siamese_loss(distances.diagonal(), negatives, margin=settings.margin, balance=settings.balance)
        return soft_nearest_loss(distances, same & ~torch.eye(len(places), dtype=torch.bool))

    def _validate(self) -> None:
        assert self.validator is not None
        self.network.eval()
        scores = {"step": self.state.step, **asdict(self.validator.scores(self.network))}
        best = max((entry["cmc1"] for entry in self.state.history), default=-1.0)
        self.state.history.append(scores)
        if scores["cmc1"] > best:
            self.state.best = {name: value.clone() for name, value in self.network.state_dict().items()}
        self.report({"event": "validation", **scores})

    def _is_exhausted(self) -> bool:
        """Whether the last `patience` validations brought nothing better."""
        patience, curve = self.settings.patience, [entry["cmc1"] for entry in self.state.history]
        return 0 < patience < len(curve) and max(curve[-patience:]) <= max(curve[:-patience])

    def _save(self) -> None:
        saved = replace(self.state, network=self.network.state_dict(), optimizer=self.optimizer.state_dict())
        saved.save(self.folder / CHECKPOINT)


def negative_pairs(batch: Batch, distances: Tensor, *, hard: bool) -> tuple[Tensor, Tensor]:
    """Rows and columns of the negatives of eq. (21) in `distances` (B, B): mirrored, random, and hardest ones."""
    count = len(batch.places)
    rows = np.arange(count)
    columns = [batch.mirror, np.roll(rows, 1 + count // 3)]
    if hard:
        same = torch.from_numpy(batch.places[:, None] == batch.places[None, :])
        columns.append(distances.masked_fill(same, torch.inf).argmin(dim=1).numpy())
    row, column = np.tile(rows, len(columns)), np.concatenate(columns)
    usable = (column >= 0) & (batch.places[row] != batch.places[column])
    return torch.from_numpy(row[usable]), torch.from_numpy(column[usable])


def learning_rate(settings: TrainingSettings, step: int) -> float:
    """The learning rate of a step: constant for ADADELTA, falling to 0 like a cosine for Adam."""
    if settings.optimizer == "adadelta":
        return 1.0 if settings.learning_rate is None else settings.learning_rate
    start = 1e-3 if settings.learning_rate is None else settings.learning_rate
    return float(start * 0.5 * (1 + np.cos(np.pi * step / settings.steps)))


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


def _fingerprint(shapes: Sequence[PreparedShape], symmetry: IntArray | None) -> str:
    digest = blake2b(digest_size=12)
    for shape in shapes:
        for array in (shape.moments.mean, shape.moments.deviation, shape.places):
            digest.update(np.ascontiguousarray(array).tobytes())
    digest.update(b"none" if symmetry is None else np.ascontiguousarray(symmetry).tobytes())
    return digest.hexdigest()
