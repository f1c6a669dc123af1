"""What training minimises: losses (21) and (22) of the paper, and a soft nearest neighbour."""

from __future__ import annotations

import torch
from torch import Tensor

MARGIN, BALANCE = 5.0, 0.75
"""μ and γ of eq. (21). The paper gives neither; these are its authors' published values for the same loss."""


def siamese_loss(positives: Tensor, negatives: Tensor, *, margin: float = MARGIN, balance: float = BALANCE) -> Tensor:
    """Eq. (21): (1 − γ) Σ ‖f(x) − f(x⁺)‖² + γ Σ (μ − ‖f(x) − f(x⁻)‖)₊², as means rather than sums.

    positives, negatives : squared distances between the descriptors of such pairs, any shape. margin : μ. balance : γ.
    Means make the loss independent of how many pairs of either kind a batch holds.
    """
    # sqrt has no gradient at 0, where a negative pair has collapsed; the floor gives it none instead of NaN.
    gap = torch.relu(margin - torch.sqrt(negatives.clamp_min(1e-12)))
    return (1 - balance) * positives.mean() + balance * (gap**2).mean()


def multinomial_loss(logits: Tensor, truth: Tensor) -> Tensor:
    """Eq. (22): −Σ log f(x)[y*(x)], as a mean over the points.

    logits : (B, P), what Softmax would get, so that no probability underflows. truth : (B,), vertices of the reference
    shape.
    """
    return torch.nn.functional.cross_entropy(logits, truth)


def soft_nearest_loss(distances: Tensor, excluded: Tensor, others: Tensor | None = None) -> Tensor:
    """Is the true point the nearest? Mean of −log softmax of the negative squared distances, at the diagonal, both
    ways.

    distances : (B, B), squared, between descriptors of point i on one shape and point j on another; i and i correspond.
    excluded : (B, B), True where j is neither the true point nor a wrong one, such as the same place drawn twice.
    others : (B, D), squared distances of the points i to further points of the other shape, all wrong; infinite where
        they are not.

    A smooth form of CMC@1: each of B² − B wrong pairs counts as much as it is near. Descriptors choose their own scale.
    """
    scores = (-distances).masked_fill(excluded, -torch.inf)
    truth = torch.arange(len(scores), device=scores.device)
    forth = scores if others is None else torch.cat([scores, -others], dim=1)
    return 0.5 * (multinomial_loss(forth, truth) + multinomial_loss(scores.T, truth))


def squared_distances(one: Tensor, two: Tensor) -> Tensor:
    """‖a_i − b_j‖² of descriptors (B, Q) and (D, Q): (B, D), never negative."""
    products = one @ two.T
    return ((one**2).sum(1)[:, None] - 2 * products + (two**2).sum(1)[None, :]).clamp_min(0)
