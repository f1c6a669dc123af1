"""The moving average of a network's weights, which generalises better than the weights of any one step."""

from __future__ import annotations

from copy import deepcopy

import torch

from .architectures import Network


class AveragedWeights:
    """A copy of a network that follows it slowly: after step s it keeps min(keep, s / (s + 9)) of what it was.

    keep : from 0, the network itself, to below 1. The second bound lets it forget the random start.
    """

    def __init__(self, network: Network, keep: float) -> None:
        self.network = deepcopy(network).requires_grad_(False).eval()
        self._keep = keep

    def follow(self, network: Network, step: int) -> None:
        """Take the weights of `network` after step number `step`, counted from 1, into the average."""
        share = 1 - min(self._keep, step / (step + 9))
        with torch.no_grad():
            for mean, weight in zip(self.network.parameters(), network.parameters(), strict=True):
                mean.lerp_(weight, share)
