"""What to learn from, and what to judge by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .._check import IntArray, array_of, index_array, instance_of
from ..errors import ParameterError
from ..geometry import TriangleMesh
from ..io import Collection
from .middles import Middles
from .training_set import UNKNOWN, TrainingShape, places_of, training_shapes
from .variations import vary


@dataclass(frozen=True, eq=False)
class LearningTask:
    """What to learn from, and what to judge by.

    training, validation : shapes whose places name the same points. symmetry : (P,), the place that mirrors each, or
    None. reference : the mesh whose vertices are the first places, for correspondence networks to name; further places,
    such as middles of its edges, are nothing to them.
    """

    training: Sequence[TrainingShape]
    validation: Sequence[TrainingShape] = ()
    symmetry: IntArray | None = None
    reference: TriangleMesh | None = None

    def __post_init__(self) -> None:
        training_shapes("training", self.training)
        training_shapes("validation", self.validation)
        if self.symmetry is not None:
            _check_involution(self.symmetry)
        if self.reference is not None:
            instance_of("reference", self.reference, TriangleMesh)

    @classmethod
    def of(cls, collection: Collection, *, most: int | None = None, variations: int = 0, seed: int = 0) -> LearningTask:
        """The training part of a collection's split, all of it where there is no split; its test part is left alone.

        The last of three or more subjects is kept for validation, else the last tenth of the shapes.
        most : shapes to train on, and half as many to validate by, spread over those there are; None for all.
        variations : of each training shape, beside the shape itself; see `vary`. The validation shapes, then, are one
            as it is and one varied by turns: a deliberately different set.
        """
        chosen = np.arange(len(collection)) if collection.training is None else collection.split("train")
        held = _held(collection, chosen)
        if (~held).sum() < 2:
            raise ParameterError(
                f"{collection.title} must hold at least four shapes to train on, but it has {len(chosen)}."
            )
        first = int(chosen[0])
        training = places_of(collection, _spread(chosen[~held], most), reference=first)
        validation = places_of(collection, _spread(chosen[held], None if most is None else most // 2), reference=first)
        reference = collection[first]
        task = cls(
            training,
            validation,
            collection.symmetry,
            reference if isinstance(reference, TriangleMesh) else None,
        )
        return task._varied(variations, seed) if variations else task

    def _varied(self, variations: int, seed: int) -> LearningTask:
        shared = self.reference is not None and all(_is_like(item, self.reference) for item in self.training)
        middles = Middles.of(self.reference, self.symmetry) if shared and self.reference is not None else None
        places = None if middles is None else middles.places
        count = variations * len(self.training) + len(self.validation)
        seeds = iter(np.random.SeedSequence(seed).generate_state(count).tolist())
        varied = [vary(item, seed=next(seeds), middles=places) for _ in range(variations) for item in self.training]
        validation = [
            vary(item, seed=next(seeds), middles=places) if i % 2 else item for i, item in enumerate(self.validation)
        ]
        symmetry = self.symmetry if middles is None else middles.symmetry
        return LearningTask([*self.training, *varied], validation, symmetry, self.reference)


def _check_involution(symmetry: IntArray) -> None:
    """Raise ParameterError unless the places, as far as they are known, mostly lead back to themselves in two steps."""
    mirror = np.asarray(index_array("symmetry", symmetry, np.size(array_of("symmetry", symmetry)), least=UNKNOWN))
    known = np.flatnonzero(mirror >= 0)
    if (mirror[mirror[known]] == known).sum() < 0.5 * len(known):
        raise ParameterError(
            "symmetry must be the place that mirrors each place, and lead back in two steps, but it mostly does not."
        )


def _held(collection: Collection, chosen: IntArray) -> np.ndarray:
    """(len(chosen),): whether each shape is kept for validation."""
    subjects = [collection.subjects[i] if collection.subjects is not None else "" for i in chosen]
    if len(set(subjects)) < 3:
        return np.arange(len(chosen)) >= len(chosen) - max(2, len(chosen) // 10)
    return np.array([subject == subjects[-1] for subject in subjects])


def _is_like(item: TrainingShape, mesh: TriangleMesh) -> bool:
    """Whether a shape has the faces of the mesh and its vertices as places, so that edges have common numbers too."""
    return (
        isinstance(item.shape, TriangleMesh)
        and np.array_equal(item.shape.faces, mesh.faces)
        and np.array_equal(item.places, np.arange(mesh.vertex_count))
    )


def _spread(indices: IntArray, most: int | None) -> IntArray:
    """At most so many of the indices, at least two, evenly over all of them."""
    if most is None or len(indices) <= max(most, 2):
        return indices
    return indices[np.linspace(0, len(indices) - 1, max(most, 2)).round().astype(np.int64)]
