"""What one mini-batch says about a network: its loss, by any of the three that there are."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext

import numpy as np
import torch
from torch import Tensor

from .architectures import Network
from .losses import multinomial_loss, siamese_loss, soft_nearest_loss, squared_distances
from .pairs import Batch
from .settings import TrainingSettings


class Objective:
    """The loss of a batch under the settings; noise follows from the step alone, on any device."""

    def __init__(self, settings: TrainingSettings) -> None:
        self._settings = settings

    def loss(self, network: Network, batch: Batch, step: int) -> Tensor:
        """A scalar with its gradient."""
        settings = self._settings
        inputs = torch.from_numpy(np.concatenate([batch.one, batch.two]))  # (2B, C, M)
        if settings.noise > 0:
            inputs = inputs + settings.noise * self._noise(inputs.shape, step)
        with self._arithmetic():
            outputs = network.logits(inputs.to(settings.device))
        outputs, places = outputs.float(), torch.from_numpy(np.array(batch.places)).to(settings.device)
        if settings.loss == "multinomial":
            return multinomial_loss(outputs, torch.cat([places, places]))
        distances = squared_distances(*outputs.split(len(places)))
        same = places[:, None] == places[None, :]
        if settings.loss == "siamese":
            negatives = distances[negative_pairs(batch, distances.detach(), hard=settings.hard_negatives)]
            return siamese_loss(distances.diagonal(), negatives, margin=settings.margin, balance=settings.balance)
        return soft_nearest_loss(distances, same & ~torch.eye(len(places), dtype=torch.bool, device=same.device))

    def _noise(self, shape: torch.Size, step: int) -> Tensor:
        seed = int(np.random.SeedSequence([self._settings.seed, step]).generate_state(1)[0])
        return torch.randn(shape, generator=torch.Generator().manual_seed(seed))

    def _arithmetic(self) -> AbstractContextManager[object]:
        if self._settings.arithmetic == "float32":
            return nullcontext()
        narrow: AbstractContextManager[object] = torch.autocast(
            torch.device(self._settings.device).type, dtype=torch.bfloat16
        )
        return narrow


def negative_pairs(batch: Batch, distances: Tensor, *, hard: bool) -> tuple[Tensor, Tensor]:
    """Rows and columns of the negatives of eq. (21) in `distances` (B, B): mirrored, random, and hardest ones."""
    count = len(batch.places)
    rows = np.arange(count)
    columns = [batch.mirror, np.roll(rows, 1 + count // 3)]
    if hard:
        same = torch.from_numpy(batch.places[:, None] == batch.places[None, :]).to(distances.device)
        columns.append(distances.masked_fill(same, torch.inf).argmin(dim=1).cpu().numpy())
    row, column = np.tile(rows, len(columns)), np.concatenate(columns)
    usable = (column >= 0) & (batch.places[row] != batch.places[column])
    return torch.from_numpy(row[usable]), torch.from_numpy(column[usable])
