"""The networks of the paper, ADD1 to ADD3 and mADD1 to mADD4, read off one specification."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor, nn

from .._check import at_least_zero, count_in, instance_of, numbers
from ..errors import ParameterError
from .layers import ASF, FC, SC, ReLU, Softmax

SPECIFICATIONS = {
    "ADD1": "SC FC16",
    "ADD2": "ASF256 ReLU SC FC16",
    "ADD3": "ASF256 ReLU ASF256 ReLU SC FC512 ReLU FC16",
    "mADD1": "SC FC16",
    "mADD2": "ASF256 ReLU SC FC16",
    "mADD3": "ASF256 ReLU ASF256 ReLU SC FC512 ReLU FC16",
    "mADD4": "ASF512 ReLU ASF512 ReLU SC FC2048 ReLU FC2048 ReLU FCreference Softmax",
}
"""Sections 7.1 and 7.2. FCreference has one output for each vertex of the reference shape."""

SINGLE, MULTIPLE = (50.0,), (0.0, 25.0, 50.0)
"""Degrees of anisotropy of ADD and of mADD networks."""
_LAYER = re.compile(r"(ASF|FC)(\d+|reference)|SC|ReLU|Softmax")


@dataclass(frozen=True)
class Architecture:
    """What a network is built from, and all that is needed to build it again.

    name : of `SPECIFICATIONS`, or one's own. layers : such as "ASF256 ReLU SC FC16", separated by blanks.
    channels, splines : C and M of its input (B, C, M). reference_size : outputs of FCreference. bias : of ASF and FC.
    """

    name: str
    layers: str
    channels: int
    splines: int
    reference_size: int = 6890
    bias: bool = True


class Network(nn.Module):  # type: ignore[misc]
    """Layers one after another: inputs (B, C, M) -> descriptors (B, Q), or probabilities from a Softmax."""

    def __init__(self, architecture: Architecture) -> None:
        super().__init__()
        self.architecture = architecture
        self.layers = nn.Sequential(*_layers(architecture))

    @property
    def is_classifier(self) -> bool:
        """Whether the outputs are probabilities over the vertices of a reference shape."""
        return isinstance(self.layers[-1], Softmax)

    @property
    def outputs(self) -> int:
        """Numbers a point that come out."""
        return int([layer for layer in self.layers if isinstance(layer, FC)][-1].weight.shape[0])

    def forward(self, x: Tensor) -> Tensor:
        """(B, C, M) -> (B, Q)."""
        return self.layers(self._checked(x))

    def logits(self, x: Tensor) -> Tensor:
        """(B, C, M) -> (B, Q), before the Softmax if there is one: what a stable loss (22) starts from."""
        return (self.layers[:-1] if self.is_classifier else self.layers)(self._checked(x))

    def features(self, x: Tensor) -> Tensor:
        """(B, C, M) -> (B, D): the descriptors, or what enters a classifier's last FC layer."""
        return self.layers[: self._features_end](self._checked(x))

    def concluded(self, features: Tensor) -> Tensor:
        """(B, D) -> (B, Q): what `forward` makes of `features`, which may have been averaged over points between."""
        return self.layers[self._features_end :](features)

    @property
    def _features_end(self) -> int:
        """How many layers `features` go through."""
        count = len(self.layers)
        return max(n for n in range(count) if isinstance(self.layers[n], FC)) if self.is_classifier else count

    def _checked(self, x: Tensor) -> Tensor:
        instance_of("inputs", x, Tensor)
        weights = next(self.parameters()).dtype
        if x.dtype not in (weights, torch.float16, torch.bfloat16):
            raise ParameterError(f"inputs must be {weights} like the weights, but they are {x.dtype}.")
        wanted = (self.architecture.channels, self.architecture.splines)
        if x.ndim != 3 or tuple(x.shape[1:]) != wanted:
            raise ParameterError(
                f"inputs must have shape (B, {wanted[0]}, {wanted[1]}), points × channels × splines, "
                f"but they have {tuple(x.shape)}."
            )
        return x


def build_network(
    name: str,
    *,
    alphas: Sequence[float] | None = None,
    angles: int = 16,
    splines: int = 150,
    outputs: int = 16,
    reference_size: int = 6890,
    layers: str | None = None,
    bias: bool = True,
    seed: int = 0,
) -> Network:
    """A network of the paper with random weights, the same for the same seed.

    name : "ADD1" … "ADD3", "mADD1" … "mADD4". alphas : degrees of anisotropy, (50,) for ADD and (0, 25, 50) for mADD
    unless given. Its input has a channel for each α and angle, α = 0 once: (B, C, splines).
    outputs : Q of the last layer, where that is FC16 in the paper. reference_size : classes of mADD4. layers : in place
    of those of `SPECIFICATIONS`, such as a smaller mADD4.

    Raises ParameterError for an unknown name or numbers out of range.
    """
    if not isinstance(name, str) or name not in SPECIFICATIONS:
        raise ParameterError(f"name must be one of {', '.join(SPECIFICATIONS)}, but it is {name!r}.")
    published = re.sub(r"FC16$", f"FC{count_in('outputs', outputs, 1, 100_000)}", SPECIFICATIONS[name])
    architecture = Architecture(
        name,
        published if layers is None else layers,
        channels=channel_count(default_alphas(name) if alphas is None else alphas, angles),
        splines=count_in("splines", splines, 1, 100_000),
        reference_size=count_in("reference_size", reference_size, 2, 10_000_000),
        bias=bias,
    )
    return build(architecture, seed=seed)


def build(architecture: Architecture, *, seed: int = 0) -> Network:
    """A network of any architecture with random weights; leaves the global random state of torch alone."""
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(count_in("seed", seed, 0, 2**63 - 1))
        return Network(architecture)


def take_over(network: Network, start: Network) -> int:
    """Copy the weights of `start` into `network`, layer by layer from the input on, as long as the layers agree.

    Returns how many layers do, ReLU and SC included.
    """
    count = 0
    for mine, other in zip(network.layers, start.layers, strict=False):
        shapes = [{name: value.shape for name, value in layer.state_dict().items()} for layer in (mine, other)]
        if type(mine) is not type(other) or shapes[0] != shapes[1]:
            break
        mine.load_state_dict(other.state_dict())
        count += 1
    return count


def default_alphas(name: str) -> tuple[float, ...]:
    """The degrees of anisotropy that the paper gives to the network of that name."""
    return MULTIPLE if name.startswith("m") else SINGLE


def channel_count(alphas: Sequence[float], angles: int) -> int:
    """C: one channel for each α and angle, but one in all for each α = 0."""
    count_in("angles", angles, 1, 10_000)
    degrees = [at_least_zero("alphas", alpha) for alpha in np.atleast_1d(numbers("alphas", alphas))]
    if not degrees:
        raise ParameterError("alphas must hold at least one number, but it is empty.")
    return sum(angles if degree > 0 else 1 for degree in degrees)


def _layers(architecture: Architecture) -> list[nn.Module]:
    """Layers in order. `width` is the last axis of what the next one gets; SC multiplies it by the channels."""
    instance_of("layers", architecture.layers, str)
    width, stacked, layers = architecture.splines, False, []
    for word in architecture.layers.split():
        found = _LAYER.fullmatch(word)
        if found is None:
            raise ParameterError(f"layers must be ASF<m>, SC, FC<q>, ReLU or Softmax, but one is {word!r}.")
        kind, size = found[1] or word, found[2]
        if stacked != (kind == "FC") and kind in ("ASF", "SC", "FC"):
            raise ParameterError(f"ASF comes before SC and FC after it, but {architecture.layers!r} has it otherwise.")
        if kind in ("ASF", "FC"):
            units = architecture.reference_size if size == "reference" else int(size)
            layers.append({"ASF": ASF, "FC": FC}[kind](width, units, bias=architecture.bias))
            width = units
        elif kind == "SC":
            layers.append(SC())
            width, stacked = width * architecture.channels, True
        else:
            layers.append({"ReLU": ReLU, "Softmax": Softmax}[kind]())
    if not any(isinstance(layer, FC) for layer in layers):
        raise ParameterError(f"layers must end in descriptors of FC, but {architecture.layers!r} has none.")
    return layers
