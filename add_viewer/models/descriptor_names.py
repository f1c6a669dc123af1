"""Descriptors by name: what people call them, and what they know, in a sentence."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class DescriptorName:
    """name : of the command and in sessions; the path of a trained model. title : for people. help : one sentence."""

    name: str
    title: str
    help: str


PLAIN = (
    DescriptorName("hks", "HKS", "Heat kernel signature: how much heat stays, without direction."),
    DescriptorName("si-hks", "SI-HKS", "Scale-invariant heat kernel signature: the same for a shape of any size."),
    DescriptorName("wks", "WKS", "Wave kernel signature: band-pass filters, sharper than heat, without direction."),
    DescriptorName("ahks", "AHKS", "Anisotropic heat kernel signature, α = 50, 16 directions: knows left from right."),
    DescriptorName(
        "geometry-vectors",
        "Directed",
        "Band-pass kernels in 16 directions, the input of the paper's networks: knows left from right.",
    ),
    DescriptorName("wft", "WFT", "Windowed Fourier transform: which frequencies there are around a point."),
)
"""Those that need no learning."""

_LEARNED = {
    "humans-madd3": DescriptorName(
        "humans-madd3", "mADD3", "Learned by the paper's network on people: sharp, and knows left from right."
    ),
    "humans-madd4": DescriptorName(
        "humans-madd4", "mADD4", "Learned on people: where on a reference person each point probably is."
    ),
    "humans-osd": DescriptorName(
        "humans-osd", "OSD", "Optimal spectral descriptors: the best linear ones, learned on people, without direction."
    ),
}


_METHODS = {"osd": "OSD", "wft": "learned WFT", "add3": "ADD3", "madd3": "mADD3"}

_OWN: dict[str, str] = {}


def name_models(titles: dict[str, str]) -> None:
    """Call trained models by these titles, by path, from now on."""
    _OWN.clear()
    _OWN.update(titles)


def descriptor_name(name: str) -> DescriptorName:
    """What is known about any name: plain, shipped or a trained model's path."""
    plain = next((each for each in PLAIN if each.name == name), None)
    if plain is not None:
        return plain
    if name in _LEARNED:
        return _LEARNED[name]
    path = Path(name)
    own = path.name != name
    if name in _OWN:
        return DescriptorName(name, _OWN[name], "Your own trained model.")
    if own:
        title = path.parent.name if path.stem in ("model", "best", "last", "checkpoint") else path.stem
        return DescriptorName(name, title, "Your own trained model.")
    shapes, _, method = name.rpartition("-")
    title = f"{_METHODS.get(method, method)}, {shapes}" if shapes else name
    return DescriptorName(name, title, f"A descriptor learned on {shapes or 'shapes'}, which ships with the app.")
