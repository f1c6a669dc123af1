"""Methods against each other on pairs of test shapes: what add-core evaluate and the figures have in common."""

from .describing import Describer
from .pairs import Pair, chosen_pairs

__all__ = ["Describer", "Pair", "chosen_pairs"]
