"""Descriptors of the open shapes: computed by processes, held in memory."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from add_core.errors import ShapeFileError
from add_core.io import load_fields

from ..models.descriptor_names import PLAIN, descriptor_name
from ..models.shapes import OpenShape, Shape
from ..models.training import MODEL_FILE
from .answers import Answers
from .descriptor_maps import median_distance
from .model_states import ModelStates, is_model_file, keep_state

FloatArray = NDArray[np.float32]

COUNT = 300
"""K, as in the paper; matching takes the same, so that both find the same spectra on disk."""


@dataclass(frozen=True)
class DescriptorQuestion:
    """The descriptor `name` of every vertex of a shape. stamp : when the file of a trained model was written."""

    reference: str
    shape: Shape
    name: str
    shape_name: str = field(compare=False)
    stamp: int = 0

    kind = "describe"
    file_name = "descriptors.npz"

    @classmethod
    def about(cls, shape: OpenShape, name: str, stamp: int) -> DescriptorQuestion:
        """The descriptor of an open shape, by a model's state if it is a model's."""
        return cls(shape.reference, shape.shape, name, shape.name, stamp)

    @property
    def title(self) -> str:
        return f"{descriptor_name(self.name).title} of {self.shape_name}"

    def arguments(self, output: Path) -> tuple[str, ...]:
        """Plain ones as they are compared: logarithms, each number standardised over the shape."""
        if any(plain.name == self.name for plain in PLAIN):
            count = str(min(COUNT, self.shape.vertex_count))
            chosen = ("--descriptor", self.name, "--compared", "--count", count)
            return ("describe", self.reference, *chosen, "-o", str(output))
        model = self.name
        if is_model_file(model):
            with suppress(OSError):  # the command then says that there is no such model
                model = str(keep_state(Path(model), output.with_name(MODEL_FILE.name)))
        return ("describe", model, self.reference, "-o", str(output))

    def read(self, output: Path, said: Mapping[str, Any]) -> FloatArray:
        """(n, d). Raises ShapeFileError if there is no row for each vertex."""
        fields = load_fields(output)
        values = fields["learned"] if "learned" in fields else next(iter(fields.values()))
        rows = np.ascontiguousarray(values if values.ndim == 2 else values[:, None], dtype=np.float32)
        if len(rows) != self.shape.vertex_count:
            raise ShapeFileError(
                f"{self.reference} has {len(rows)} vertices by now, but {self.shape.vertex_count} when it was opened. "
                "Open it again."
            )
        rows.flags.writeable = False
        return rows


class DescriptorStore:
    """(shape, name) → (n, d) descriptors, and which names there are.

    models : the person's trained models, newest first. shipped : names of learned ones that come with the app.
    """

    def __init__(
        self, answers: Answers, models: Callable[[], tuple[str, ...]], shipped: Callable[[], tuple[str, ...]]
    ) -> None:
        self.answers = answers
        self._models, self._shipped = models, shipped
        self._medians: dict[DescriptorQuestion, float] = {}
        self.states = ModelStates(answers, DescriptorQuestion.about)

    @property
    def names(self) -> tuple[str, ...]:
        """What can be asked for now."""
        return (*(plain.name for plain in PLAIN), *self._shipped(), *self._models())

    def get(self, shape: OpenShape, name: str) -> FloatArray | None:
        """The descriptors if they are there."""
        found: FloatArray | None = self.answers.get(self._question(shape, name))
        return found

    def want(self, shape: OpenShape, name: str) -> FloatArray | None:
        """The descriptors if they are there; otherwise a process begins to compute them."""
        question = self._question(shape, name)
        if self.answers.get(question) is None and not self.answers.is_asked(question):
            self.states.catch_up(name)
        found: FloatArray | None = self.answers.want(self._question(shape, name))
        return found

    def message(self, shape: OpenShape, name: str) -> str:
        """What is happening to them, in words."""
        return self.answers.message(self._question(shape, name))

    def is_asked(self, shape: OpenShape, name: str) -> bool:
        """Whether they are being computed, or have failed to be."""
        question = self._question(shape, name)
        return self.answers.is_asked(question) or self.answers.has_failed(question)

    def median(self, shape: OpenShape, name: str) -> float:
        """Median distance of two points in descriptors that are there."""
        question = self._question(shape, name)
        if question not in self._medians:
            found = self.answers.get(question)
            self._medians[question] = 1.0 if found is None else median_distance(found)
        return self._medians[question]

    def _question(self, shape: OpenShape, name: str) -> DescriptorQuestion:
        return DescriptorQuestion.about(shape, name, self.states.shown(name))
