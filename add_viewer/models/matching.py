"""How picks and colours go from one shape to another."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal

Method = Literal["true", "nearest", "functional-map", "zoomout"]
METHODS: tuple[Method, ...] = ("true", "nearest", "functional-map", "zoomout")


@dataclass(frozen=True)
class Matching:
    """method : "true" the known correspondence; "nearest" descriptors; those made smooth by a "functional-map", or
    refined by "zoomout". descriptor : of the last three. refined : show the smooth version of what is carried.
    """

    method: Method = "true"
    descriptor: str = "ahks"
    refined: bool = False

    def with_changes(self, **changes: Any) -> Matching:
        """The same with `changes`; an unknown method is ignored."""
        made = replace(self, **changes)
        return made if made.method in METHODS else replace(made, method=self.method)
