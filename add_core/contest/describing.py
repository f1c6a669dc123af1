"""Descriptors by name, hand-made and learned, of every point of a sample."""

from __future__ import annotations

from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from .._check import FloatArray
from ..evaluation.baselines import BASELINES, describe_with
from ..evaluation.samples import Sample
from ..geometry import normalize
from ..spectra import SpectralFamily, compute_spectra

_SHAPES = 16
"""Whose spectra are remembered; they lie in the cache's files, not in memory."""


class Describer:
    """Computes descriptors at unit geodesic diameter, and remembers those of the last samples."""

    def __init__(self, *, alpha: float = 50.0, angles: int = 16, count: int = 300) -> None:
        """alpha, angles, count : of the spectra that hand-made descriptors come from; models have their own."""
        self._alphas, self._angles, self._count = (0.0, alpha), angles, count
        self.spectra = lru_cache(_SHAPES)(self._spectra)
        self.describe = lru_cache(8 * _SHAPES)(self._describe)

    def _spectra(self, sample: Sample) -> SpectralFamily:
        count = min(self._count, sample.shape.vertex_count - 1)
        return compute_spectra(normalize(sample.shape), alphas=self._alphas, angles=self._angles, count=count)

    def _describe(self, name: str, sample: Sample) -> FloatArray:
        """(n, d), a row for each point. name : one of BASELINES, or a model as `load_model` takes it."""
        if name in BASELINES:
            return describe_with(name, self.spectra(sample))
        from ..learning import load_model

        return np.asarray(load_model(name).embed(sample.shape), dtype=np.float64)


def why_not(name: str) -> str | None:
    """Why the descriptor of that name cannot be had in this installation, in a few words; None if it can."""
    if name in BASELINES:
        return None
    for package in ("torch", "safetensors"):
        if find_spec(package) is None:
            return f"it needs {package}, which is not installed; run: pip install torch safetensors"
    from ..learning import shipped_models

    if name in shipped_models() or Path(name).is_file() or (Path(name) / "model.safetensors").is_file():
        return None
    return f"there is no trained model {name}"
