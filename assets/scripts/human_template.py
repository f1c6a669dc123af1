"""Closed, mirror-symmetric skins of 12,166 and 6,890 vertices from MakeHuman's base mesh, through anny.

Every vertex of a skin is a vertex of the base mesh or, in the two eye caps, the mean of the rim around it: a fixed
sparse matrix W maps the base mesh of any body in any pose to its skin, and corresponding vertices correspond exactly.
"""

from collections import Counter
from dataclasses import dataclass

import anny
import numpy as np
import torch
from scipy.sparse import csr_array
from symmetric_decimation import compacted, decimate, mirrored

BASE = "anny-quads-noeyes-notongue"
# Never its "smplx" or "smpl" topologies: their terms forbid commercial use.


@dataclass(frozen=True, eq=False)
class Skin:
    """W : (n, base vertices) sparse. faces : (m, 3). mirror : (n,) involution. rest : (n, 3) of the mean body."""

    W: csr_array
    faces: np.ndarray
    mirror: np.ndarray
    rest: np.ndarray


def build_skins():
    """The full skin, and its decimation to as many vertices as FAUST's registrations have."""
    rest, quads, mirror = _mean_body()
    quads = quads[~_cavities()[quads].all(axis=1)]
    weights, vertex_mirror, caps, mouth = _caps(rest, quads, mirror)
    positions = weights @ rest
    side = np.where(np.abs(positions[:, 0]) < 1e-9, 0, np.sign(positions[:, 0]))
    left = [face for quad in quads if side[quad].sum() > 0 for face in _split(quad, positions)]
    left += [face for face in caps if side[face[2]] > 0] + mouth
    used, faces, skin_mirror = compacted(mirrored(np.array(left), vertex_mirror), vertex_mirror)
    full = Skin(weights[used], faces, skin_mirror, positions[used])
    chosen, faces, skin_mirror = decimate(full.rest, full.faces, full.mirror, 6890, axis=0)
    return full, Skin(full.W[chosen], faces, skin_mirror, full.rest[chosen])


def _mean_body():
    """Base vertices (n, 3) made exactly symmetric, its quads, and its mirror map."""
    model = anny.Anny(topology=BASE).to(dtype=torch.float64)
    body = model(phenotype_kwargs=dict.fromkeys(model.phenotype_labels, 0.5))["rest_vertices"][0].numpy()
    table = anny.paths.get_anny_root_dir() / "data/mpfb2/mesh_metadata/hm08.mirror"
    rows = [line.split() for line in table.read_text().splitlines()]
    partner = {int(row[0]): int(row[1]) for row in rows if len(row) >= 2}
    numbers = model.base_mesh_vertex_indices.numpy()
    place = {number: index for index, number in enumerate(numbers)}
    mirror = np.array([place[partner[number]] for number in numbers])
    if (mirror[mirror] != np.arange(len(mirror))).any():
        raise RuntimeError("the base mesh's mirror table is not an involution")
    return 0.5 * (body + body[mirror] * [-1, 1, 1]), model.faces.numpy(), mirror


def _cavities():
    """(n,): base vertices inside the mouth and the eye sockets."""
    model = anny.Anny(topology=BASE)
    stored = torch.load(anny.paths.get_anny_root_dir() / "data/template_mesh_internal_cavities.pth", weights_only=True)
    inside = np.zeros(19158, dtype=bool)
    inside[np.asarray(stored["vertex_indices"])] = True
    return inside[model.base_mesh_vertex_indices.numpy()]


def _holes(quads):
    """The open rims, each as vertices in an order that closes it outward."""
    half_edges = Counter((a, b) for quad in quads.tolist() for a, b in zip(quad, quad[1:] + quad[:1], strict=True))
    following = {b: a for (a, b) in half_edges if (b, a) not in half_edges}
    rims, left = [], set(following)
    while left:
        start = left.pop()
        rim, at = [start], following[start]
        while at != start:
            rim.append(at)
            left.discard(at)
            at = following[at]
        rims.append(np.array(rim))
    return rims


def _caps(rest, quads, mirror):
    """W with a row for each eye cap, its mirror map, the faces that close the eyes and the left half of the mouth."""
    n = len(rest)
    rows, columns, values = list(range(n)), list(range(n)), [1.0] * n
    eyes, cap_of, mouth = [], {}, []
    for rim in _holes(quads):
        centre = rest[rim].mean(axis=0)
        if abs(centre[0]) > 0.01:
            cap = n + len(cap_of)
            cap_of[np.sign(centre[0])] = cap
            rows += [cap] * len(rim)
            columns += rim.tolist()
            values += [1.0 / len(rim)] * len(rim)
            eyes += [(a, b, cap) for a, b in zip(rim.tolist(), np.roll(rim, -1).tolist(), strict=True)]
        else:
            first, last = np.flatnonzero(mirror[rim] == rim)
            for part in (rim[first : last + 1], np.concatenate([rim[last:], rim[: first + 1]])):
                if rest[part, 0].mean() > 0:
                    mouth = _shortest_triangulation(part, rest)
    weights = csr_array((values, (rows, columns)), shape=(n + 2, n))
    with_caps = np.concatenate([mirror, [0, 0]])
    with_caps[cap_of[1.0]], with_caps[cap_of[-1.0]] = cap_of[-1.0], cap_of[1.0]
    return weights, with_caps, eyes, mouth


def _shortest_triangulation(polygon, positions):
    """Triangles of a polygon in space whose diagonals are shortest in sum, by dynamic programming over its chords."""
    n = len(polygon)
    length = np.linalg.norm(positions[polygon][:, None] - positions[polygon][None], axis=-1)
    cost, best = np.zeros((n, n)), np.zeros((n, n), dtype=int)

    def chord(i, j):
        return length[i, j] if j - i > 1 else 0.0

    for gap in range(2, n):
        for i in range(n - gap):
            j = i + gap
            costs = [cost[i, k] + cost[k, j] + chord(i, k) + chord(k, j) for k in range(i + 1, j)]
            cost[i, j], best[i, j] = min(costs), i + 1 + int(np.argmin(costs))
    faces, waiting = [], [(0, n - 1)]
    while waiting:
        i, j = waiting.pop()
        if j - i >= 2:
            k = best[i, j]
            faces.append((int(polygon[i]), int(polygon[k]), int(polygon[j])))
            waiting += [(i, k), (k, j)]
    return faces


def _split(quad, positions):
    """A quad as two triangles along its shorter diagonal; a quad with a repeated corner as one."""
    corners = list(dict.fromkeys(quad.tolist()))
    if len(corners) == 3:
        return [tuple(corners)]
    a, b, c, d = corners
    if np.linalg.norm(positions[a] - positions[c]) <= np.linalg.norm(positions[b] - positions[d]):
        return [(a, b, c), (a, c, d)]
    return [(b, c, d), (b, d, a)]
