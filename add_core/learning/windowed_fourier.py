"""The learned windowed Fourier descriptor of Boscaini et al. 2015, the isotropic rival that the paper compares with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor, nn

from .._check import FloatArray, IntArray, count_in
from ..descriptors.splines import splines_at
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh
from .inputs import InputRecipe, Moments
from .layers import FC, ReLU
from .losses import soft_nearest_loss, squared_distances
from .training_set import TrainingShape

RECIPE = InputRecipe(alphas=(0.0,), angles=1, splines=150)
WINDOW_SPLINES = 12


@dataclass(frozen=True, eq=False)
class FourierShape:
    """What the network sees of a shape: vectors (n, M), eigenfunctions (n, K), mass (n,), splines (K, W) at their λ."""

    vectors: Tensor
    functions: Tensor
    mass: Tensor
    splines: Tensor

    @classmethod
    def of(
        cls, shape: TriangleMesh | PointCloud, *, frequencies: int = 100, recipe: InputRecipe = RECIPE
    ) -> FourierShape:
        """Inputs of a shape, brought to unit geodesic diameter and then to unit area, so that windows compare."""
        family = recipe.spectra(shape, cache=False)
        values, spectrum = recipe.inputs(family), family[0]
        count = min(count_in("frequencies", frequencies, 2, 100_000), len(spectrum.eigenvalues))
        area = float(family.mass.sum())
        lowest = spectrum.eigenvalues[:count]
        return cls(
            torch.from_numpy(Moments.of(values, family.mass).standardise(values)[:, 0].copy()),
            torch.from_numpy(np.asarray(spectrum.eigenfunctions[:, :count] * np.sqrt(area), dtype=np.float32)),
            torch.from_numpy((family.mass / area).astype(np.float32)),
            torch.from_numpy(splines_at(lowest, count=WINDOW_SPLINES, reach=float(lowest[-1])).astype(np.float32)),
        )


class WindowedFourierNetwork(nn.Module):  # type: ignore[misc]
    """FC16 + ReLU → windowed Fourier transform → FC16, section 3 of the paper and eq. (14).

    The first layer makes `signals` functions on the shape from geometry vectors; the transform tells which frequencies
    each has near a point, seen through a window ĝ(λ) = Σ_w c_w β_w(λ) that is learned; the last makes `outputs` of the
    moduli.
    """

    def __init__(
        self, splines: int = 150, *, signals: int = 16, frequencies: int = 100, outputs: int = 16, seed: int = 0
    ) -> None:
        super().__init__()
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(seed)
            self.signals = nn.Sequential(FC(splines, signals), ReLU())
            self.output = FC(signals * frequencies, outputs)
        # Starts as a low pass, so that the window is localised around its point.
        self.window = nn.Parameter(torch.exp(-torch.linspace(0, 4, WINDOW_SPLINES)))

    def forward(self, shape: FourierShape, points: Tensor) -> Tensor:
        """Descriptors, shape (B, outputs), of the vertices `points` (B,)."""
        moduli = self.transform(self.signals(shape.vectors), shape, points).abs()
        return self.output(moduli.flatten(start_dim=1))

    def transform(self, signals: Tensor, shape: FourierShape, points: Tensor) -> Tensor:
        """(S f)_{x,l} of signals (n, P) at `points` (B,), eq. (14): (B, P, K)."""
        functions = shape.functions
        weighted = (signals * shape.mass[:, None]).T[:, :, None] * functions  # (P, n, K)
        products = functions.T @ weighted  # ⟨f, φ_k φ_l⟩, (P, K, K)
        windowed = functions[points] * (shape.splines.to(functions.dtype) @ self.window)  # (B, K)
        return torch.einsum("bk,pkl->bpl", windowed, products)

    def describe(self, shape: FourierShape) -> FloatArray:
        """Descriptors of every vertex: shape (n, outputs)."""
        with torch.inference_mode():
            parts = [self(shape, part) for part in torch.arange(len(shape.mass)).split(2048)]
        return np.asarray(torch.cat(parts).numpy(), dtype=np.float64)


def learn_windowed_fourier(
    shapes: Sequence[TrainingShape],
    *,
    steps: int = 500,
    pairs: int = 192,
    frequencies: int = 100,
    recipe: InputRecipe = RECIPE,
    seed: int = 0,
) -> WindowedFourierNetwork:
    """Train the network on shapes with known places, by Adam with cosine decay and the soft nearest neighbour.

    Raises ParameterError if two shapes that are drawn together share fewer than `pairs` places.
    """
    if len(shapes) < 2:
        raise ParameterError(f"shapes must hold at least two shapes to compare, but it holds {len(shapes)}.")
    seen = [FourierShape.of(item.shape, frequencies=frequencies, recipe=recipe) for item in shapes]
    width = min(shape.functions.shape[1] for shape in seen)
    network = WindowedFourierNetwork(recipe.splines, frequencies=width, seed=seed)
    optimizer = torch.optim.Adam(network.parameters(), lr=1e-3)
    same = torch.zeros(pairs, pairs, dtype=torch.bool)
    for step in range(steps):
        draw = np.random.default_rng([seed, step])
        first, second = draw.choice(len(shapes), 2, replace=False)
        one, two = _shared(shapes[first].places, shapes[second].places, pairs, draw)
        optimizer.param_groups[0]["lr"] = 1e-3 * 0.5 * (1 + np.cos(np.pi * step / steps))
        loss = soft_nearest_loss(squared_distances(network(seen[first], one), network(seen[second], two)), same)
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        optimizer.step()
    return network


def _shared(one: IntArray, two: IntArray, count: int, draw: np.random.Generator) -> tuple[Tensor, Tensor]:
    places, first, second = np.intersect1d(one, two, return_indices=True)
    known = np.flatnonzero(places >= 0)
    if len(known) < count:
        raise ParameterError(f"shapes must share at least {count} places, but two of them share {len(known)}.")
    chosen = draw.choice(known, count, replace=False)
    return torch.from_numpy(first[chosen]), torch.from_numpy(second[chosen])
