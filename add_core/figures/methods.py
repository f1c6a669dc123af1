"""How methods are called and coloured in figures, the same in every figure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec

from matplotlib.colors import to_hex, to_rgb

from ..contest.describing import why_not
from ..contest.pairs import FOREST, MAPS, REFINED


@dataclass(frozen=True)
class Method:
    """title : in figures. colour : of its curves, darker once its matches are refined. is_ours : of the paper's own
    family, drawn stronger.
    """

    title: str
    colour: str
    is_ours: bool = False


_GREY = "#8a8f98"
METHODS: dict[str, Method] = {
    "hks": Method("HKS", "#8a8f98"),
    "si-hks": Method("SI-HKS", "#b58f6a"),
    "wks": Method("WKS", "#0072b2"),
    "wft": Method("WFT", "#56b4e9"),
    "osd": Method("OSD", "#009e73"),
    "learned-wft": Method("learned WFT", "#44aa99"),
    "isotropic": Method("isotropic network", "#b07aa1"),
    "ahks": Method("AHKS", "#e69f00", is_ours=True),
    "add1": Method("ADD1", "#f2b37c", is_ours=True),
    "add2": Method("ADD2", "#e8843c", is_ours=True),
    "add3": Method("ADD3", "#b8500f", is_ours=True),
    "madd1": Method("mADD1", "#dba3c4", is_ours=True),
    "madd2": Method("mADD2", "#c2619b", is_ours=True),
    "madd3": Method("mADD3", "#8f1d5f", is_ours=True),
    "madd4": Method("mADD4", "#5b1a8a", is_ours=True),
    MAPS: Method("functional maps", "#5f6bb5"),
    FOREST: Method("random forest", "#7d8f2e"),
}


def method(name: str) -> Method:
    """The method of that name; a model's file or shipped name stands for its architecture: "humans-madd3"."""
    if name.endswith(REFINED):
        found = method(name.removesuffix(REFINED))
        red, green, blue = (0.55 * channel for channel in to_rgb(found.colour))
        return Method(f"{found.title} + ZoomOut", to_hex((red, green, blue)), found.is_ours)
    plain = name.lower().removesuffix(".safetensors").removesuffix("/model").rpartition("/")[2]
    known = METHODS.get(plain) or METHODS.get(plain.rpartition("-")[2])
    return known or Method(name, _GREY)


def obtainable(names: Sequence[str]) -> tuple[list[str], tuple[str, ...]]:
    """Those of `names` that can be had in this installation, and for each of the others a line that says why not."""
    had, reasons = [], []
    for name in names:
        reason = _forest_missing() if name.startswith(FOREST) else None
        if name not in METHODS and reason is None:
            reason = why_not(name.removesuffix(REFINED))
        if reason is None:
            had.append(name)
        else:
            reasons.append(f"{method(name).title}: {reason}")
    return had, tuple(dict.fromkeys(reasons))


def _forest_missing() -> str | None:
    if find_spec("sklearn") is None:
        return "it needs scikit-learn, which is not installed; run: pip install scikit-learn"
    return None
