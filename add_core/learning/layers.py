"""The layers of the paper, section 4.2. B points, C channels of (α, θ), M splines or filters, P numbers a point."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from .._check import count_in


class ASF(nn.Module):  # type: ignore[misc]
    """Anisotropic spectral filters, eq. (18): (B, C, M) -> (B, C, filters), the same linear map on every channel.

    On geometry vectors, row q of `weight` (filters, M) holds the coefficients a_qm of the transfer function
    τ_q = Σ_m a_qm β_m, eq. (12). On the output of another ASF it mixes that one's filters.

    bias : a constant for each filter, 0 at the start. Eq. (18) has none; standardised inputs need one to undo their
    centring.
    """

    def __init__(self, inputs: int, filters: int, *, bias: bool = True) -> None:
        super().__init__()
        self.linear = nn.Linear(_size("inputs", inputs), _size("filters", filters), bias=bias)
        _start(self.linear)

    @property
    def weight(self) -> Tensor:
        """Coefficients of the transfer functions, shape (filters, M)."""
        return self.linear.weight

    def forward(self, x: Tensor) -> Tensor:
        """(B, C, M) -> (B, C, filters)."""
        return self.linear(x)


class SC(nn.Module):  # type: ignore[misc]
    """Stack channels: (B, C, M) -> (B, C·M), channel by channel. What follows no longer knows about angles."""

    def forward(self, x: Tensor) -> Tensor:
        """(B, C, M) -> (B, C·M)."""
        return x.flatten(start_dim=1)


class FC(nn.Module):  # type: ignore[misc]
    """Fully connected, eq. (19): (B, P) -> (B, outputs). bias : as for `ASF`."""

    def __init__(self, inputs: int, outputs: int, *, bias: bool = True) -> None:
        super().__init__()
        self.linear = nn.Linear(_size("inputs", inputs), _size("outputs", outputs), bias=bias)
        _start(self.linear)

    @property
    def weight(self) -> Tensor:
        """Weights w_qp, shape (outputs, P)."""
        return self.linear.weight

    def forward(self, x: Tensor) -> Tensor:
        """(B, P) -> (B, outputs)."""
        return self.linear(x)


class ReLU(nn.Module):  # type: ignore[misc]
    """ξ(t) = max(0, t), number by number: any shape."""

    def forward(self, x: Tensor) -> Tensor:
        """Any shape -> the same shape."""
        return torch.relu(x)


class Softmax(nn.Module):  # type: ignore[misc]
    """Eq. (20): (B, P) -> (B, P), probabilities that sum to 1 for each point."""

    def forward(self, x: Tensor) -> Tensor:
        """(B, P) -> (B, P)."""
        return torch.softmax(x, dim=1)


def _size(name: str, value: int) -> int:
    return count_in(name, value, 1, 10_000_000)


def _start(linear: nn.Linear) -> None:
    """He et al. 2015: ReLU halves the variance, twice the usual variance of the weights keeps it."""
    nn.init.kaiming_normal_(linear.weight, nonlinearity="relu")
    if linear.bias is not None:
        nn.init.zeros_(linear.bias)
