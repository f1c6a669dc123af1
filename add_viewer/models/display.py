"""How things are drawn: a person's taste, kept between starts."""

from __future__ import annotations

from typing import Any

from psygnal import Signal

THEMES = ("system", "light", "dark")
KERNEL_SCALES = ("linear", "log")
UP_AXES = ("auto", "+y", "+z")
KERNEL_COLOURS = ("kernel", "sequential", "grey")
SAMPLES = ("4", "8", "0")

_CHOICES = {
    "theme": THEMES,
    "kernel_scale": KERNEL_SCALES,
    "up_axis": UP_AXES,
    "kernel_colours": KERNEL_COLOURS,
    "samples": SAMPLES,
}
_SWITCHES = {
    "arrows": False,
    "wireframe": False,
    "colour_bar": True,
    "relative_curves": True,
    "reflected_curves": False,
    "autosave": True,
}


class Display:
    """Named settings with one signal: the name of what changed."""

    changed = Signal(str)

    def __init__(self) -> None:
        self._values = _defaults()

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def set(self, name: str, value: Any) -> None:
        """Change one setting; values that do not fit it are ignored, as they come from files that anybody may edit."""
        allowed = _CHOICES.get(name, (False, True))
        if name in self._values and value in allowed and value != self._values[name]:
            self._values[name] = value
            self.changed.emit(name)

    def reset(self) -> None:
        """Everything as it was at the first start."""
        for name, value in _defaults().items():
            self.set(name, value)

    def as_dict(self) -> dict[str, Any]:
        return dict(self._values)


def _defaults() -> dict[str, Any]:
    return {name: options[0] for name, options in _CHOICES.items()} | dict(_SWITCHES)
