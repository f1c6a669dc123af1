"""Pairs of points drawn on the fly: one place on two shapes, and the places it could be mistaken for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .._check import BoolArray, IntArray, count_in, index_array, read_only
from ..errors import ParameterError
from .inputs import Inputs, Moments
from .training_set import UNKNOWN, PreparedShape

MOST_TRIES = 1000
"""Draws of two shapes until a pair shares places: consistent sets need one or two."""


@dataclass(frozen=True, eq=False)
class Batch:
    """Points of two shapes that correspond row by row.

    one, two : (B, C, M), standardised inputs. places : (B,), equal where the same place was drawn twice.
    mirror : (B,), the row that holds the mirror image of each row's place, −1 where the batch has none.
    """

    one: Inputs
    two: Inputs
    places: IntArray
    mirror: IntArray


class PairSampler:
    """Draws batches; the same step of the same seed is the same batch, whatever was drawn before.

    shapes : at least two that share places. pairs : B. symmetry : (P,), the place that mirrors each place, or None.
    moments : standardise by these; None standardises every shape by its own.

    A fifth of the places is drawn anywhere; a fifth are their mirror images; the others lie near to those of the first
    fifth, because neighbours are what is confused most. Without a symmetry the mirror images are drawn anywhere too.
    Each shape counts the same, whatever its number of points. Raises ParameterError if no two shapes share a place.
    """

    def __init__(
        self,
        shapes: Sequence[PreparedShape],
        *,
        pairs: int,
        seed: int,
        symmetry: IntArray | None = None,
        moments: Moments | None = None,
    ) -> None:
        if len(shapes) < 2:
            raise ParameterError(f"shapes must hold at least two shapes to compare, but it holds {len(shapes)}.")
        self._pairs = count_in("pairs", pairs, 4, 1_000_000)
        self._shapes, self._seed, self._moments = shapes, seed, moments
        self._places = 1 + max(int(shape.places.max()) for shape in shapes)
        self._symmetry = _padded(symmetry, self._places)
        self.batch(0)

    def batch(self, step: int) -> Batch:
        """The batch of step 0, 1, 2, …: inputs of shape (B, C, M)."""
        draw = np.random.default_rng([self._seed, step])
        one, two, common = self._two_shapes(draw)
        fifth = max(1, self._pairs // 5)
        somewhere = draw.choice(common, fifth)
        shared = np.zeros(self._places, dtype=bool)
        shared[common] = True
        images = self._symmetry[somewhere]
        mirrored = np.where(shared[images] & (images >= 0), images, draw.choice(common, fifth))
        near = self._near(one, np.resize(somewhere, self._pairs - 2 * fifth), shared, draw)
        places = np.concatenate([somewhere, mirrored, near])
        return Batch(
            one.inputs(one.vertex_at[places], self._moments),
            two.inputs(two.vertex_at[places], self._moments),
            read_only(places),
            read_only(_rows_of(self._symmetry[places], places)),
        )

    def _two_shapes(self, draw: np.random.Generator) -> tuple[PreparedShape, PreparedShape, IntArray]:
        for _ in range(MOST_TRIES):
            first, second = draw.choice(len(self._shapes), 2, replace=False)
            one, two = self._shapes[first], self._shapes[second]
            size = min(len(one.vertex_at), len(two.vertex_at))
            common = np.flatnonzero((one.vertex_at[:size] >= 0) & (two.vertex_at[:size] >= 0))
            if len(common):
                return one, two, common
        raise ParameterError(
            "shapes must share places, but no two of them do: their correspondences name different points."
        )

    def _near(self, shape: PreparedShape, places: IntArray, shared: BoolArray, draw: np.random.Generator) -> IntArray:
        """A place beside each of `places`, on `shape`; the place itself where no neighbour is shared by both shapes."""
        around = shape.neighbours[shape.vertex_at[places]]
        chosen = shape.places[around[np.arange(len(around)), draw.integers(around.shape[1], size=len(around))]]
        return np.where((chosen >= 0) & shared[chosen], chosen, places)


def _padded(symmetry: IntArray | None, places: int) -> IntArray:
    """(places,): the mirror image of each place, −1 where unknown."""
    table = np.full(places, UNKNOWN)
    if symmetry is not None:
        known = index_array("symmetry", symmetry, max(len(symmetry), places), least=UNKNOWN)[:places]
        table[: len(known)] = np.where(known < places, known, UNKNOWN)
    return table


def _rows_of(wanted: IntArray, places: IntArray) -> IntArray:
    """The first row of `places` that holds each of `wanted`, −1 for none."""
    order = np.argsort(places, kind="stable")
    position = np.minimum(np.searchsorted(places[order], wanted), len(places) - 1)
    rows = order[position]
    return np.where((places[rows] == wanted) & (wanted >= 0), rows, UNKNOWN)
