"""Matching and evaluating two people: seconds of processor time, peak memory, and how far matches miss."""

import resource
import time

from add_core.correspondence import guided_zoomout, nearest_matches
from add_core.evaluation import descriptor_scores, match_errors
from add_core.evaluation.baselines import describe_with, isotropic
from add_core.evaluation.samples import sample
from add_core.geometry import normalize
from add_core.io import humans
from add_core.spectra import compute_spectra

PAIR = 83, 87


def main() -> None:
    """Person 9 walking and kicking, 6,890 vertices, K = 200."""
    collection = humans()
    one, two = (sample(collection, index) for index in PAIR)
    families = [compute_spectra(normalize(part.shape), alphas=(0.0, 50.0), angles=16, count=200) for part in (one, two)]
    started = time.process_time()
    described = [describe_with("ahks", family) for family in families]
    raw = nearest_matches(described[1], described[0])
    found = guided_zoomout(isotropic(families[0]), isotropic(families[1]), *described).match_21
    print(f"AHKS and ZoomOut, spectra given: {time.process_time() - started:.1f} s of one core (limit 10)")
    missed = [match_errors(match, two.place, shape=one.shape).mean() for match in (raw, found)]
    print("mean geodesic error ÷ √area: raw {:.3f}, ZoomOut {:.3f}".format(*missed))
    waves = [describe_with("wks", family) for family in families]
    started = time.process_time()
    descriptor_scores("wks", one, two, (waves[0], waves[1]))
    print(f"all protocols, both settings, all points: {time.process_time() - started:.1f} s of one core (limit 20)")
    print(f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB (limit 2,048)")


if __name__ == "__main__":
    main()
