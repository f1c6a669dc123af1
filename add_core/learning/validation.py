"""How well a network tells points apart while it learns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch

from .._check import IntArray
from ..errors import ParameterError
from ..evaluation import cmc, right_side, roc
from .architectures import Network
from .inputs import Inputs, Moments
from .losses import multinomial_loss, soft_nearest_loss, squared_distances
from .training_set import PreparedShape

FEWEST = 12
"""Places that two shapes must share for their scores to mean anything."""
POINTS = 1000
"""Points of a shape that are compared. CMC is among so many candidates, not among all vertices."""


@dataclass(frozen=True)
class ValidationScores:
    """Means over the pairs of shapes. loss : soft nearest neighbour, or (22) of a classifier. cmc1, cmc10 : among
    1,000 candidates, asymmetric; among all vertices of the reference for a classifier, whose auc is the share of false
    vertices that are less probable than the true one. right_side : NaN without a symmetry.
    """

    loss: float
    auc: float
    cmc1: float
    cmc10: float
    right_side: float


class Validator:
    """Compares each shape with the next one of a list, the last with the first, at places drawn once.

    symmetry : (P,), the place that mirrors each. moments : standardise by these; None, every shape by its own.
    Raises ParameterError if two successive shapes share fewer than 12 places.
    """

    def __init__(
        self,
        shapes: Sequence[PreparedShape],
        *,
        symmetry: IntArray | None = None,
        moments: Moments | None = None,
        seed: int = 0,
    ) -> None:
        if len(shapes) < 2:
            raise ParameterError(f"validation must hold at least two shapes to compare, but it holds {len(shapes)}.")
        draw = np.random.default_rng(seed)
        self._moments, self._symmetry = moments, symmetry
        pairs = zip(shapes, [*shapes[1:], shapes[0]], strict=True)
        self._pairs = [(one, two, _shared(one, two, symmetry, draw)) for one, two in pairs]

    def scores(self, network: Network) -> ValidationScores:
        """Scores of the network as it is."""
        rows = [self._of_pair(network, *pair) for pair in self._pairs]
        known = [row for row in rows if np.isfinite(row.right_side)]
        means = {
            name: float(np.mean([getattr(row, name) for row in rows])) for name in ("loss", "auc", "cmc1", "cmc10")
        }
        side = float(np.mean([row.right_side for row in known])) if known else float("nan")
        return ValidationScores(right_side=side, **means)

    def _of_pair(self, network: Network, one: PreparedShape, two: PreparedShape, places: IntArray) -> ValidationScores:
        a, b = (self._outputs(network, shape, places) for shape in (one, two))
        if network.is_classifier:
            return self._of_classes(torch.from_numpy(a), torch.from_numpy(places.copy()))
        truth = np.arange(len(places))
        x, y = (np.asarray(values, dtype=np.float64) for values in (a, b))
        matches = cmc(x, y, truth, ranks=10)
        side = float("nan")
        if self._symmetry is not None:
            number = {int(place): row for row, place in enumerate(places)}
            mirror = np.array([number.get(int(self._symmetry[place]), row) for row, place in enumerate(places)])
            side = right_side(x, y, truth, symmetry=mirror).share
        distances = squared_distances(torch.from_numpy(a), torch.from_numpy(b))
        loss = float(soft_nearest_loss(distances, torch.zeros_like(distances, dtype=torch.bool)))
        return ValidationScores(loss, roc(x, y, truth).auc, matches.headline, matches.at(10), side)

    def _of_classes(self, logits: torch.Tensor, places: torch.Tensor) -> ValidationScores:
        """Scores of logits (B, P): how many of the reference's vertices are more probable than the true one."""
        true = logits.gather(1, places[:, None])
        before = (logits > true).sum(dim=1).double()
        side = float("nan")
        if self._symmetry is not None:
            mirror = torch.from_numpy(np.array(self._symmetry))[places]
            has_other = (mirror != places) & (mirror >= 0) & (mirror < logits.shape[1])
            other = logits.gather(1, torch.where(has_other, mirror, places)[:, None])
            side = float((true > other)[has_other].double().mean())
        return ValidationScores(
            float(multinomial_loss(logits, places)),
            float(1 - before.mean() / (logits.shape[1] - 1)),
            float((before < 1).double().mean()),
            float((before < 10).double().mean()),
            side,
        )

    def _outputs(self, network: Network, shape: PreparedShape, places: IntArray) -> Inputs:
        values = shape.inputs(shape.vertex_at[places], self._moments)
        with torch.inference_mode():
            outputs: Inputs = network.logits(torch.from_numpy(values)).numpy()
        return outputs


def _shared(one: PreparedShape, two: PreparedShape, symmetry: IntArray | None, draw: np.random.Generator) -> IntArray:
    """Places on both shapes, half of them the mirror images of the others where there is a symmetry."""
    size = min(len(one.vertex_at), len(two.vertex_at))
    is_common = (one.vertex_at[:size] >= 0) & (two.vertex_at[:size] >= 0)
    common = np.flatnonzero(is_common)
    if len(common) < FEWEST:
        other = "another state of it" if one.name == two.name else repr(two.name)
        raise ParameterError(
            f"validation shapes must share at least {FEWEST} places, but {one.name!r} and {other} share {len(common)}. "
            "Take shapes of more vertices or with more of their correspondence known: by equal faces, or by .vts or "
            ".map files beside them."
        )
    chosen = draw.permutation(common)[: POINTS if symmetry is None else POINTS // 2]
    if symmetry is not None:
        mirrored = np.asarray(symmetry)[chosen]
        mirrored = mirrored[(mirrored >= 0) & (mirrored < size)]
        chosen = np.concatenate([chosen, mirrored[is_common[mirrored]]])
    return np.unique(chosen)
