"""Fields that eigenfunctions make: themselves, and kernels of any filter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..models.fields import ShapeField, ValueScale
from ..models.session import SessionState
from .field_plans import Place, Plan, Same, Sources
from .spectra import Eigenpairs, SpectrumQuestion

FloatArray = NDArray[np.float64]

WAVE_WIDTH = 0.35
"""Standard deviation of the wave kernel's band, in log λ."""


@dataclass(frozen=True)
class Filter:
    """τ(λ) of a kernel, λ (K,) in units of the band's centre 1/t."""

    name: str
    title: str
    formula: str
    response: Callable[[FloatArray], FloatArray]


FILTERS = (
    Filter("wave", "Wave kernel", "exp(−ln²(λt) / 2σ²)", lambda x: np.exp(-0.5 * (_log(x) / WAVE_WIDTH) ** 2)),
    Filter("mexican-hat", "Mexican-hat kernel", "λt · exp(1 − λt)", lambda x: x * np.exp(1.0 - x)),
)
"""Band-pass filters, 1 at λ = 1/t: the rim of the spreading heat, and the wave kernel signature's own band."""


def _log(values: FloatArray) -> FloatArray:
    return np.log(np.maximum(values, 1e-12))


def eigenfunction_plan(place: Place, sources: Sources) -> Plan:
    """One eigenfunction of the operator at hand."""
    question = SpectrumQuestion.of(place.shape, place.state.diffusion)
    pairs = sources.answers.want(question)
    if pairs is None:
        return Plan(message=sources.answers.message(question))
    index = min(place.choice.index, len(pairs.eigenvalues) - 1)

    def work() -> ShapeField:
        values = pairs.eigenfunctions[:, index].astype(np.float64)
        return ShapeField(
            shape=place.shape.key,
            choice=place.choice,
            values=values,
            title=f"Eigenfunction φ{_low(index)}",
            notes=("unit 1/⌀", f"λ = {pairs.eigenvalues[index]:.3g} /⌀²"),
            caption=_operator(place.state),
            tones="signed",
            scale=ValueScale.signed(values),
            symbol="φ",
            unit="/⌀",
        )

    return Plan((place.choice, Same(pairs), index, _operator(place.state)), work)


def kernel_plan(place: Place, sources: Sources) -> Plan:
    """The kernel Σ τ(λ) φ(x) φ(·) of another filter than heat's, around the picks of this shape."""
    chosen = next((each for each in FILTERS if each.name == place.choice.name), FILTERS[0])
    picks = place.state.picks_on(place.shape.key) or sources.results.carried.get(place.shape.key, ())
    if not picks:
        return Plan()
    question = SpectrumQuestion.of(place.shape, place.state.diffusion)
    pairs = sources.answers.want(question)
    if pairs is None:
        return Plan(message=sources.answers.message(question))
    vertices = tuple(pick.vertex for pick in picks)
    diffusion = place.state.diffusion

    def work() -> ShapeField:
        laplacian = sources.operators.laplacian(place.shape, diffusion.conductivity, diffusion.alpha)
        return _kernel_field(place, chosen, pairs, vertices, diffusion.reach / laplacian.weyl_eigenvalue(1))

    return Plan((place.choice, Same(pairs), vertices, diffusion), work)


def _kernel_field(
    place: Place, chosen: Filter, pairs: Eigenpairs, vertices: tuple[int, ...], time: float
) -> ShapeField:
    weights = chosen.response(np.maximum(pairs.eigenvalues, 0.0) * time)
    at = pairs.eigenfunctions[list(vertices)].astype(np.float64)
    values = pairs.eigenfunctions @ (weights * at.sum(axis=0)).astype(np.float32)
    cut = weights[-1] > 0.05 * max(float(weights.max()), 1e-300)
    count = len(pairs.eigenvalues)
    return ShapeField(
        shape=place.shape.key,
        choice=place.choice,
        values=values.astype(np.float64),
        title=chosen.title,
        notes=("unit 1/⌀²", f"band cut off at λ{_low(count - 1)}" if cut else f"from {count} eigenfunctions"),
        caption=f"{_operator(place.state)}, t = {time:.3g} ⌀²",
        tones="signed",
        scale=ValueScale.signed(values),
        symbol="k",
        unit="/⌀²",
    )


def _operator(state: SessionState) -> str:
    diffusion = state.diffusion
    angle = f", θ = {np.degrees(diffusion.theta):.4g}°" if diffusion.alpha > 0 else ""
    return f"α = {diffusion.alpha:.4g} ({diffusion.conductivity}){angle}"


def _low(number: int) -> str:
    """A number as a subscript: φ₁₂."""
    return "".join("₀₁₂₃₄₅₆₇₈₉"[int(digit)] for digit in str(number))
