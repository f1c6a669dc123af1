"""Pairs of points drawn on the fly: one place on two shapes, and the places it could be mistaken for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from .._check import FloatArray, IntArray, count_in, index_array, read_only
from ..errors import ParameterError
from .inputs import Inputs, Moments
from .nearby import CLUSTER, NEAREST, nearby_pairs
from .training_set import UNKNOWN, PreparedShape

MOST_TRIES = 1000
"""Draws of two shapes until a pair shares places: consistent sets need one or two."""


@dataclass(frozen=True, eq=False)
class Batch:
    """Points of two shapes that correspond row by row.

    one, two : (B, C, M), standardised inputs. places : (B,), equal where the same place was drawn twice.
    mirror : (B,), the place that is the mirror image of each, −1 where it is unknown. wrong : (E, C, M), further points
    of the second shape, near those that correspond, and wrong_places : (E,); none without a body to tell by.
    """

    one: Inputs
    two: Inputs
    places: IntArray
    mirror: IntArray
    wrong: Inputs | None = None
    wrong_places: IntArray | None = None


class PairSampler:
    """Draws batches; the same step of the same seed is the same batch, whatever was drawn before.

    shapes : at least two that share places. pairs : B. symmetry : (P,), the place that mirrors each place, or None.
    moments : standardise by these; None standardises every shape by its own. positions : (P, 3), where each place is on
    one body: see `nearby_pairs`. None draws places alone that both shapes have.

    Places come in clusters of five, the first anywhere and four near it, because neighbours are what is confused most.
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
        positions: FloatArray | None = None,
    ) -> None:
        if len(shapes) < 2:
            raise ParameterError(f"shapes must hold at least two shapes to compare, but it holds {len(shapes)}.")
        self._pairs = count_in("pairs", pairs, 4, 1_000_000)
        self._shapes, self._seed, self._moments, self._positions = shapes, seed, moments, positions
        self._places = 1 + max(int(shape.places.max()) for shape in shapes)
        self._symmetry = _padded(symmetry, self._places)
        self.batch(0)

    def batch(self, step: int) -> Batch:
        """The batch of step 0, 1, 2, …: inputs of shape (B, C, M)."""
        draw = np.random.default_rng([self._seed, step])
        if self._positions is not None:
            return self._nearby(self._positions, draw)
        one, two, common = self._two_shapes(draw)
        places = _clustered(one, common, self._pairs, draw)
        return Batch(
            one.inputs(one.vertex_at[places], self._moments),
            two.inputs(two.vertex_at[places], self._moments),
            read_only(places),
            read_only(self._symmetry[places]),
        )

    def _nearby(self, positions: FloatArray, draw: np.random.Generator) -> Batch:
        first, second = draw.choice(len(self._shapes), 2, replace=False)
        one, two = self._shapes[first], self._shapes[second]
        chosen, found, wrong = nearby_pairs(one, two, positions, self._pairs, draw)
        seen = two.inputs(np.concatenate([found, wrong]), self._moments)
        places = two.places[found]
        return Batch(
            one.inputs(chosen, self._moments),
            seen[: self._pairs],
            read_only(places),
            read_only(self._symmetry[places]),
            seen[self._pairs :],
            read_only(two.places[wrong]),
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


def _clustered(shape: PreparedShape, common: IntArray, count: int, draw: np.random.Generator) -> IntArray:
    """(count,): places among `common`, each first one anywhere and the others of its cluster near it on the shape."""
    positions = shape.positions[shape.vertex_at[common]]
    firsts = draw.integers(len(common), size=-(-count // CLUSTER))
    nearest = cKDTree(positions).query(positions[firsts], k=min(NEAREST, len(common)))[1].reshape(len(firsts), -1)
    columns = draw.integers(nearest.shape[1], size=(len(firsts), CLUSTER - 1))
    rows = np.concatenate([firsts[:, None], np.take_along_axis(nearest, columns, axis=1)], axis=1)
    return np.asarray(common[rows.ravel()[:count]])


def _padded(symmetry: IntArray | None, places: int) -> IntArray:
    """(places,): the mirror image of each place, −1 where unknown."""
    table = np.full(places, UNKNOWN)
    if symmetry is not None:
        known = index_array("symmetry", symmetry, max(len(symmetry), places), least=UNKNOWN)[:places]
        table[: len(known)] = np.where(known < places, known, UNKNOWN)
    return table
