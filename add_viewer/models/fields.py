"""What is drawn on the shapes: which field a person chose, and the numbers or colours that one view shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from add_core.drawing.colour_maps import Tones

FloatArray = NDArray[np.float64]
FieldKind = Literal[
    "skin",
    "heat",
    "rose",
    "kernel",
    "distance",
    "ambiguity",
    "eigenfunction",
    "signature",
    "curvature",
    "file",
    "transfer",
    "error",
]
FIELD_KINDS: tuple[FieldKind, ...] = get_args(FieldKind)
MATCHED: frozenset[FieldKind] = frozenset({"transfer", "error"})
"""Kinds that show what the chosen matching does."""
DECADES = 2.0
"""How far below its maximum a logarithmic scale of a kernel begins."""


@dataclass(frozen=True)
class FieldChoice:
    """A field that can be drawn on every shape.

    kind : "skin" none; "heat" the live anisotropic kernel; "rose" kernels of several θ at once; "kernel" of another
        filter; "distance" between descriptors; "ambiguity" distance to one's mirror image; "eigenfunction";
        "signature" one component of a descriptor; "curvature"; "file" of the shape's own file; "transfer" colours
        carried from the active shape; "error" of the correspondence.
    descriptor : of distance, ambiguity and signature: "hks", "wks", …, a shipped model or the path of a trained one.
    index : number of the eigenfunction, or component of the signature, from 0.
    name : which curvature ("max", "min", "mean", "gaussian", "confidence"), which field of the file, which filter.
    saturation : percentile, 1 to 100, at which the colours of distances saturate; the paper's Figure 6 has the median.
    """

    kind: FieldKind = "heat"
    descriptor: str = "hks"
    index: int = 1
    name: str = ""
    saturation: float = 50.0

    def with_changes(self, **changes: Any) -> FieldChoice:
        """The same with `changes`, brought into range; an unknown kind is ignored."""
        made = replace(self, **changes)
        kind = made.kind if made.kind in FIELD_KINDS else self.kind
        index, saturation = max(0, int(made.index)), min(max(float(made.saturation), 1.0), 100.0)
        return replace(made, kind=kind, index=index, saturation=saturation)


@dataclass(frozen=True)
class ValueScale:
    """From values to colour positions in [0, 1], honest about what the ends mean.

    low, high : values at positions 0 and 1. kind : "linear" or "log" (both > 0).
    open_low, open_high : whether values lie beyond that end; its label then says so.
    """

    low: float
    high: float
    kind: str = "linear"
    open_low: bool = False
    open_high: bool = False

    @classmethod
    def of_kernel(cls, values: FloatArray, kind: str) -> ValueScale:
        """1 at the maximum; 0 at no heat (linear) or `DECADES` below the maximum (log)."""
        top = float(values.max()) if values.size else 1.0
        top = top if top > 0 else 1.0
        return cls(0.0, top) if kind == "linear" else cls(top * 10.0**-DECADES, top, "log", open_low=True)

    @classmethod
    def signed(cls, values: FloatArray) -> ValueScale:
        """Symmetric about 0: position 0.5 is 0."""
        top = float(np.abs(values[np.isfinite(values)]).max(initial=0.0)) or 1.0
        return cls(-top, top)

    @classmethod
    def saturated(cls, values: FloatArray, percentile: float) -> ValueScale:
        """From 0 to the percentile of the values; all beyond it look alike."""
        known = values[np.isfinite(values)]
        top = float(np.percentile(known, percentile)) if known.size else 1.0
        return cls(0.0, top if top > 0 else 1.0, open_high=percentile < 100)

    @classmethod
    def spanning(cls, values: FloatArray) -> ValueScale:
        """From the least to the greatest value."""
        known = values[np.isfinite(values)]
        low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
        return cls(low, high if high > low else low + 1.0)

    def position(self, values: FloatArray) -> FloatArray:
        """(n,) in [0, 1]; values that are not numbers stand at 0."""
        if self.kind == "log":
            kept = np.clip(np.nan_to_num(values, nan=self.low), self.low, self.high)
            logarithmic: FloatArray = np.log(kept / self.low) / np.log(self.high / self.low)
            return logarithmic
        return np.clip((np.nan_to_num(values, nan=self.low) - self.low) / (self.high - self.low), 0.0, 1.0)

    def ticks(self) -> list[tuple[float, str]]:
        """Positions and labels for a colour bar."""
        steps = max(1, round(np.log10(self.high / self.low))) if self.kind == "log" else 2
        at = np.linspace(0.0, 1.0, min(steps, 6) + 1)
        values = self.low * (self.high / self.low) ** at if self.kind == "log" else self.low + at * self._span
        labels = [_number(float(value), self._span) for value in values]
        labels[0] = f"≤ {labels[0]}" if self.open_low else labels[0]
        labels[-1] = f"≥ {labels[-1]}" if self.open_high else labels[-1]
        return [(float(place), label) for place, label in zip(at, labels, strict=True)]

    @property
    def _span(self) -> float:
        return self.high - self.low


@dataclass(frozen=True, eq=False, kw_only=True)
class ShapeField:
    """What one view draws on its shape.

    shape : key. values : (n,) drawn by `tones` and `scale`, or colors : (n, 3) sRGB; one of both is None.
    title, notes : of the colour bar: the quantity, then its unit and scale. caption : parameters, under the name.
    symbol, unit : for the value under the cursor: "h" and "/⌀²".
    best : vertices that deserve a small mark, the best first.
    message : why there is neither, and what is being done or has to be done about it.
    """

    shape: str
    choice: FieldChoice
    values: FloatArray | None = None
    colors: FloatArray | None = None
    title: str = ""
    notes: tuple[str, str] = ("", "")
    caption: str = ""
    tones: Tones = "sequential"
    scale: ValueScale = ValueScale(0.0, 1.0)
    symbol: str = ""
    unit: str = ""
    best: tuple[int, ...] = ()
    message: str = ""

    @property
    def position(self) -> FloatArray | None:
        """(n,) colour positions in [0, 1]; None where the field has colours of its own."""
        return None if self.values is None else self.scale.position(self.values)

    def reading(self, vertex: int) -> str:
        """The value at a vertex in words, "" where there is none."""
        if self.values is None or not np.isfinite(self.values[vertex]):
            return ""
        return f"{self.symbol} = {self.values[vertex]:.4g}{' ' if self.unit else ''}{self.unit}"


def in_common_range(fields: list[ShapeField]) -> list[ShapeField]:
    """The same fields, those that are alike (choice, colours, kind of scale) with one scale that holds them all."""
    groups: dict[tuple[object, ...], list[ValueScale]] = {}
    for field in fields:
        groups.setdefault((field.choice, field.tones, field.scale.kind), []).append(field.scale)
    joint = {
        key: replace(
            scales[0],
            low=min(scale.low for scale in scales),
            high=max(scale.high for scale in scales),
            open_low=any(scale.open_low for scale in scales),
            open_high=any(scale.open_high for scale in scales),
        )
        for key, scales in groups.items()
    }
    return [replace(field, scale=joint[field.choice, field.tones, field.scale.kind]) for field in fields]


def _number(value: float, span: float) -> str:
    """Two significant digits, as a person would write them: 170, 0.091, 3.2e-05; what rounds away is 0."""
    return "0" if abs(value) < 1e-9 * span else f"{float(f'{value:.1e}'):g}"
