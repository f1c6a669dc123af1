"""Remesh the test people, each on its own, with the place of every new vertex on the old triangles as ground truth.

    python assets/scripts/remesh_test_people.py

Needs pymeshlab (GPL; used here only, never shipped or imported by the program). Writes humans_remeshed_20.npz: about
4,000 vertices a person, 16-bit steps; the old face of each vertex and its barycentric weights, 16 bits too.
"""

from pathlib import Path

import numpy as np
from foreign_meshings import isotropic

from add_core.geometry.closest import closest_points
from add_core.io import humans

VERTICES = 4000
FOLDER = Path(__file__).parents[1] / "shapes"


def main():
    collection = humans()
    parts = {name: [] for name in ("vertices_q", "faces", "place_face", "place_weights")}
    counts, test = [], collection.split("test")
    lo = np.min([collection[i].vertices.min(axis=0) for i in test], axis=0) - 0.01
    scale = np.max([np.ptp(collection[i].vertices, axis=0).max() for i in test]) * 1.2 / 65535
    for index in test:
        old = collection[index]
        new = isotropic(old, VERTICES)
        place = closest_points(old, new.vertices, new.vertex_normals)
        print(collection.names[index], new.vertex_count, f"off by {1000 * place.distances.max():.2f} mm at most")
        parts["vertices_q"].append(np.rint((new.vertices - lo) / scale).astype(np.uint16))
        parts["faces"].append(new.faces.astype(np.uint16))
        parts["place_face"].append(place.faces.astype(np.uint16))
        parts["place_weights"].append(np.rint(65535 * place.weights[:, :2]).astype(np.uint16))
        counts.append((new.vertex_count, len(new.faces)))
    arrays = {name: np.concatenate(values) for name, values in parts.items()}
    np.savez_compressed(
        FOLDER / "humans_remeshed_20.npz", **arrays, counts=np.array(counts), shapes=np.array(test), lo=lo, scale=scale
    )


if __name__ == "__main__":
    main()
