"""Find the symmetry of posed people and dogs by `intrinsic_symmetry`, and measure how far it is from the true one.

    python assets/scripts/measure_symmetry.py -o assets/reports/symmetry.csv

Twenty of the hundred people, twelve of the 71 poses and twelve of the forty dogs, drawn by seed 0, and the twenty
people kept for tests, of another meshing and as clouds. A line is written after each. error: mean geodesic distance
from a vertex's image to its true mirror image ÷ geodesic diameter.
"""

import argparse
import csv
import time
from pathlib import Path

import numpy as np

from add_core.correspondence import intrinsic_symmetry
from add_core.evaluation.samples import sample
from add_core.geometry import geodesic_diameter, normalize
from add_core.geometry.pair_distances import PairDistances
from add_core.io import dogs, humans, poses
from add_core.spectra import compute_spectra

DRAWN = ((humans, 20), (poses, 12), (dogs, 12))
NUMBERS = ("error", "confidence", "distortion", "worst", "preserved", "unmoved", "unlike", "alike")
COLUMNS = ("collection", "shape", "found", *NUMBERS, "seconds")


def drawn(random):
    """Title, name, shape and true symmetry of all that is measured."""
    for collection, count in ((make(), count) for make, count in DRAWN):
        for index in np.sort(random.choice(len(collection), count, replace=False)):
            yield collection.title, collection.names[index], collection[index], collection.symmetry
    for variant in ("remeshed", "cloud"):
        for index in humans().split("test"):
            part = sample(humans(), int(index), variant)
            yield f"{humans().title}, {variant}", part.name, part.shape, part.symmetry


def measured(title, name, given, symmetry):
    """One line of the table."""
    started = time.process_time()
    shape = normalize(given)
    family = compute_spectra(shape, alphas=(0.0, 50.0), angles=16, count=150, workers=1, cache=False)
    found = intrinsic_symmetry(shape, family=family)
    error = PairDistances(shape)(found.candidate, symmetry).mean() / geodesic_diameter(shape)
    facts = [round(float(x), 4) for x in (error, found.confidence, found.distortion, found.worst)]
    facts += [round(float(x), 3) for x in (found.preserved, found.unmoved, found.unlike, found.alike)]
    seconds = round(time.process_time() - started, 1)
    return [title, name, found.found, *facts, seconds]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    random, lines = np.random.default_rng(options.seed), []
    shapes = list(drawn(random))
    for done, place in enumerate(random.permutation(len(shapes)), start=1):
        lines.append(measured(*shapes[place]))
        with options.output.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *sorted(lines, key=str)])
        good = sum(line[2] and line[3] <= 0.03 for line in lines)
        print(*lines[-1], f"| {good} of {done} found within 0.03", flush=True)


if __name__ == "__main__":
    main()
