"""Curves like the paper's Figures 9 and 10: the correspondence network against functional maps and a random forest.

    python compare_correspondences.py -o FOLDER [--report ../reports]

Raw matches and matches refined by ZoomOut, by the Princeton protocol, on pairs of test people. FOLDER/test keeps the
inputs of the networks, as compare_networks.py does.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from compare_networks import prepared_sample, shipped

from add_core.contest.describing import Describer
from add_core.contest.pairs import Pair, chosen_pairs
from add_core.evaluation import Scores, averaged, save_report, table
from add_core.evaluation.baselines import BASELINES
from add_core.evaluation.samples import Sample, sample
from add_core.io import humans

METHODS = (
    "fm",
    "fm+zoomout-plain",
    "rf",
    "rf+zoomout-plain",
    "humans-madd3",
    "humans-madd3+zoomout",
    "humans-madd4",
    "humans-madd4+zoomout",
)
PAIRS, QUERIES, COUNT = 4, 500, 200


class PreparedDescriber(Describer):
    """Takes the networks' inputs from a folder; hand-made descriptors need the isotropic spectrum alone."""

    def __init__(self, folder: Path) -> None:
        super().__init__(angles=1, count=COUNT)
        self._alphas, self._folder = (0.0,), folder

    def _describe(self, name: str, part: Sample) -> np.ndarray:
        if name in BASELINES:
            return super()._describe(name, part)
        return shipped(name)(prepared_sample(part, self._folder), part)


def main() -> None:
    """Match, score and write a report for the people as they are and for clouds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--report", type=Path, default=Path(__file__).parents[1] / "reports")
    parser.add_argument("--variants", nargs="*", default=["mesh", "cloud"])
    given = parser.parse_args()
    for variant in given.variants:
        describer = PreparedDescriber(given.output / "test")
        found: dict[str, list[Scores]] = {name: [] for name in METHODS}
        for i, j in chosen_pairs(humans(), PAIRS, 0):
            pair = Pair(sample(humans(), i, variant), sample(humans(), j, variant), describer)
            for name in METHODS:
                found[name].append(pair.scores(name, protocols=("princeton",), queries=QUERIES))
            print(variant, i, j, flush=True)
        scores = [averaged(rows) for rows in found.values()]
        print(table(scores), flush=True)
        save_report(
            scores,
            given.report / f"correspondence_{variant}",
            title=f"Correspondence, test people, {variant}",
            command="python assets/scripts/compare_correspondences.py -o FOLDER",
            notes=[f"{PAIRS} pairs, {QUERIES} queries each, {COUNT} eigenfunctions for maps and refinement."],
        )


if __name__ == "__main__":
    main()
