"""What one mini-batch says about a network: its loss, by any of the three that there are."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext

import numpy as np
import torch
from torch import Tensor

from .._check import IntArray
from .architectures import Network
from .inputs import InputRecipe
from .losses import multinomial_loss, siamese_loss, soft_nearest_loss, squared_distances
from .pairs import Batch
from .settings import TrainingSettings


class Objective:
    """The loss of a batch under the settings; noise follows from the step alone, on any device.

    mirror_channels : (C,), see `InputRecipe`. By it every point is also seen as in a mirror, where it is its own mirror
    image: a wrong point that differs in nothing but the side, on any meshing. None to do without.
    repeated : all channels are one and the same, as of an isotropic twin, and so is their noise: noise of each its own
    would average out, and the twin learn from cleaner inputs than the network that it is compared with.
    """

    def __init__(
        self, settings: TrainingSettings, mirror_channels: IntArray | None = None, *, repeated: bool = False
    ) -> None:
        self._settings, self._repeated = settings, repeated
        self._mirror = None if mirror_channels is None else torch.from_numpy(np.array(mirror_channels))

    def loss(self, network: Network, batch: Batch, step: int) -> Tensor:
        """A scalar with its gradient."""
        settings, count = self._settings, len(batch.places)
        parts = [batch.one, batch.two] if batch.wrong is None else [batch.one, batch.two, batch.wrong]
        inputs = torch.from_numpy(np.concatenate(parts))  # (2B + E, C, M)
        if self._mirror is not None and settings.loss != "multinomial":
            inputs = torch.cat([inputs, inputs[count : 2 * count, self._mirror]])  # (3B + E, C, M)
        if settings.noise > 0:
            inputs = inputs + settings.noise * self._noise(inputs.shape, step)
        with self._arithmetic():
            outputs = network.logits(inputs.to(settings.device))
        outputs, places = outputs.float(), torch.from_numpy(np.array(batch.places)).to(settings.device)
        if settings.loss == "multinomial":
            return multinomial_loss(outputs, torch.cat([places, places]))
        mirror = torch.from_numpy(np.array(batch.mirror)).to(settings.device)
        wrong = batch.places[:0] if batch.wrong_places is None else batch.wrong_places
        return self._of_pairs(outputs, places, mirror, torch.from_numpy(np.array(wrong)).to(settings.device))

    def _of_pairs(self, outputs: Tensor, places: Tensor, mirror: Tensor, wrong: Tensor) -> Tensor:
        settings, count, last = self._settings, len(places), 2 * len(places) + len(wrong)
        distances = squared_distances(outputs[:count], outputs[count : 2 * count])
        same = places[:, None] == places[None, :]
        # A place on the plane of symmetry is its own mirror image.
        true = (mirror[None, :] < 0) | (mirror[None, :] == places[:, None])
        others = squared_distances(outputs[:count], outputs[last:])  # (B, B), or (B, 0) without mirrors
        others = others.masked_fill(true[:, : others.shape[1]], torch.inf)
        around = squared_distances(outputs[:count], outputs[2 * count : last])  # (B, E)
        around = around.masked_fill(wrong[None, :] == places[:, None], torch.inf)
        if settings.loss == "soft-nearest":
            twice = same & ~torch.eye(count, dtype=torch.bool, device=same.device)
            return soft_nearest_loss(distances, twice, torch.cat([others, around], dim=1))
        negatives = [distances[negative_pairs(places, distances.detach(), hard=settings.hard_negatives)]]
        negatives.append(others.diagonal()[torch.isfinite(others.diagonal())] if others.shape[1] else distances[:0, 0])
        if len(wrong):
            nearest = around.min(dim=0).values
            negatives.append(nearest[torch.isfinite(nearest)])
        return siamese_loss(
            distances.diagonal(), torch.cat(negatives), margin=settings.margin, balance=settings.balance
        )

    def _noise(self, shape: torch.Size, step: int) -> Tensor:
        seed = int(np.random.SeedSequence([self._settings.seed, step]).generate_state(1)[0])
        drawn = (shape[0], 1, shape[2]) if self._repeated else shape
        return torch.randn(drawn, generator=torch.Generator().manual_seed(seed))

    def _arithmetic(self) -> AbstractContextManager[object]:
        if self._settings.arithmetic == "float32":
            return nullcontext()
        narrow: AbstractContextManager[object] = torch.autocast(
            torch.device(self._settings.device).type, dtype=torch.bfloat16
        )
        return narrow


def negative_pairs(places: Tensor, distances: Tensor, *, hard: bool) -> tuple[Tensor, Tensor]:
    """Rows and columns of the negatives of eq. (21) in `distances` (B, B): random ones, and the hardest if wanted."""
    count = len(places)
    rows = torch.arange(count, device=places.device)
    columns = [torch.roll(rows, 1 + count // 3)]
    if hard:
        same = places[:, None] == places[None, :]
        columns.append(distances.masked_fill(same, torch.inf).argmin(dim=1))
    row, column = rows.repeat(len(columns)), torch.cat(columns)
    usable = places[row] != places[column]
    return row[usable], column[usable]


def mirror_channels(recipe: InputRecipe, symmetry: IntArray | None) -> IntArray | None:
    """(C,): the channels of a shape in a mirror; None where no symmetry is known, or the mirror changes nothing."""
    blind = recipe.isotropic or np.array_equal(recipe.mirror_channels, np.arange(recipe.channels))
    return None if symmetry is None or blind else recipe.mirror_channels
