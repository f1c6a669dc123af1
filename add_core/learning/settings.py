"""How to train: every choice in one place, written into the checkpoint and the model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
import torch

from .._check import at_least_zero, count_in, one_of, positive
from ..errors import ParameterError
from .losses import BALANCE, MARGIN
from .model import Standardisation

Loss = Literal["soft-nearest", "siamese", "multinomial"]
Optimizer = Literal["adam", "adadelta"]
Arithmetic = Literal["float32", "bfloat16"]


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
    averaging : the model has the moving average of the weights, each step keeping this share of it; 0 for the weights
        of the last step. Early steps keep less, so that the start is soon forgotten.
    arithmetic : of products within the network; "bfloat16" is half again as fast where a processor has it, and many
        times slower where it does not (AVX2 alone).
    device : of torch, such as "cpu" or "cuda".
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
    averaging: float = 0.995
    arithmetic: Arithmetic = "float32"
    device: str = "cpu"
    validate_every: int = 250
    checkpoint_every: int = 100
    patience: int = 0
    seed: int = 0

    def __post_init__(self) -> None:
        one_of("loss", self.loss, get_args(Loss))
        one_of("optimizer", self.optimizer, get_args(Optimizer))
        one_of("standardisation", self.standardisation, get_args(Standardisation))
        one_of("arithmetic", self.arithmetic, get_args(Arithmetic))
        for name in ("steps", "validate_every", "checkpoint_every"):
            count_in(name, getattr(self, name), 1, 1_000_000_000)
        count_in("patience", self.patience, 0, 1_000_000)
        at_least_zero("noise", self.noise)
        if not 0 <= at_least_zero("averaging", self.averaging) < 1:
            raise ParameterError(f"averaging must be below 1, but it is {self.averaging}.")
        _check_device(self.device)
        if self.learning_rate is not None:
            positive("learning_rate", self.learning_rate)


def _check_device(name: str) -> None:
    try:
        torch.empty(0, device=name)
    except (RuntimeError, AssertionError) as error:  # torch asserts that it was built with CUDA
        raise ParameterError(
            f"device must be one that torch has here, such as 'cpu', but {name!r} is not: {str(error).splitlines()[0]}"
        ) from None


def learning_rate(settings: TrainingSettings, step: int) -> float:
    """The learning rate of a step: constant for ADADELTA, falling to 0 like a cosine for Adam."""
    if settings.optimizer == "adadelta":
        return 1.0 if settings.learning_rate is None else settings.learning_rate
    start = 1e-3 if settings.learning_rate is None else settings.learning_rate
    return float(start * 0.5 * (1 + np.cos(np.pi * step / settings.steps)))
