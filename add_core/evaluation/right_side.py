"""Left or right: is a point's true match nearer than its mirror image?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .._check import FloatArray, read_only
from ..correspondence.nearest import without_unit
from ..errors import ParameterError
from .blocks import checked_descriptors
from .truth import SurfacePoints, Truth


@dataclass(frozen=True, eq=False)
class RightSide:
    """Which points descriptors put on the right side of a symmetric shape.

    field : (q,), 1 where the true match is nearer than its mirror image, 0 where it is farther, ½ where both are
        equally near;
        NaN on the plane of symmetry and where the truth is unknown.
    """

    field: FloatArray

    @property
    def share(self) -> float:
        """P(right side), from 0 to 1: ½ is chance."""
        return float(np.nanmean(self.field)) if not np.isnan(self.field).all() else float("nan")

    @property
    def headline(self) -> float:
        """P(right side)."""
        return self.share


def right_side(
    queries: ArrayLike, targets: ArrayLike, truth: ArrayLike | SurfacePoints, *, symmetry: ArrayLike
) -> RightSide:
    """Compare each point's distance to its true match with that to the match's mirror image, in descriptor space.

    queries (q, d), targets (n, d), truth (q,), symmetry (n,) : as for `cmc`.
    Raises ParameterError if arrays do not fit together or a descriptor is not finite.
    """
    if symmetry is None:
        raise ParameterError("symmetry must be the (n,) mirror image of each target point, but it is None.")
    one, two = without_unit(*checked_descriptors(queries, targets))
    known = Truth.of(truth, symmetry, queries=len(one), targets=len(two))
    point, true, mirror = one[known.rows], two[known.vertex], two[known.mirror]
    nearer = np.sign(((point - mirror) ** 2).sum(axis=1) - ((point - true) ** 2).sum(axis=1))
    field = np.full(len(one), np.nan)
    field[known.rows] = np.where(known.vertex == known.mirror, np.nan, 0.5 * (1 + nearer))
    return RightSide(read_only(field))
