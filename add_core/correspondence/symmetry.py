"""The symmetry of a shape in any pose, found by the shape itself: f_θ ∘ η = f_{−θ}."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._check import FloatArray, IntArray, count_in, positive, read_only
from ..descriptors import geometry_vectors
from ..descriptors.range import checked_family
from ..errors import ParameterError
from ..geometry import PointCloud, TriangleMesh, farthest_points, normalize
from ..geometry.pair_distances import PairDistances
from ..spectra import SpectralFamily, Spectrum, compute_spectra
from ..spectra.computation import Progress
from .involution import grown_involution, involution_of_matches
from .nearest import nearest_matches
from .orientation import orientation_kept, outward_triangles, preserved_orientation

SAMPLES = 500
"""Points, far from one another, by which candidates are found and compared."""
RADII = (0.0, 0.05, 0.1)
"""Geodesic radii around a point, ÷ diameter, within which its mirror image is not looked for."""
SIZES = (6, 10, 15, 20)
"""Sizes of functional map from which ZoomOut starts."""
MOST_DISTORTION = 0.045
"""Mean change of geodesic distances, ÷ diameter, that poses explain: up to 0.025 on the shipped people and dogs."""
WORST, MOST_WORST = 0.98, 0.065
"""The same for the distances of the point that fares worse than this share of all, and the most that may be: up to
0.055 there and on other meshings of them, 0.063 once, but over 0.08 where a limb is missing or longer. A fingertip may
go astray."""
MOST_KEPT = 0.3
"""Share of the area that a mirror may lay down the wrong way round, by rounding to vertices."""
KEPT_COST = 0.05
"""Distortion that turning everything the wrong way round must save: an arm twisted into the other is cheap."""
MOST_UNLIKE = 0.9
"""Mean squared difference of f_θ ∘ η and f_{−θ}, ÷ that of f_θ ∘ η and f_θ, below which the map surely mirrors what has
a direction: up to 0.87 on people and dogs in poses, 0.94 or more on blobs and bodies with a stump, whose best maps may
distort no more than a pose does."""
LEAST_ALIKE, MOST_ALIKE = 0.7, 0.92
"""On other meshings and clouds both differences hold much noise, and it is above that as well. What is left to tell is
for which share of the moving points the former is the smaller. Asked is 1.06 − 16 × distortion (poses cost both), but
no less and no more than these. It is 0.7 to 1 there, half to two thirds on blobs, 0.78 to 0.89 on smooth ones whose
distortion is so small that a true mirror would have 1."""
STILL, MOST_UNMOVED, FAR = 0.03, 0.2, 0.1
"""Points that move by less, ÷ diameter, count as unmoved: a tenth of them on people, up to 0.17 on dogs, a quarter
where one limb is laid upon itself; and the most there may be. By more than the last, they are points that move."""


@dataclass(frozen=True, eq=False)
class IntrinsicSymmetry:
    """What was found: a map η of the shape to itself that reverses orientation and preserves distances, or none.

    found : whether `candidate` is good enough to be called a symmetry.
    candidate : (n,), the image of every vertex under the best map, found or not.
    confidence : 0 to 1: how far the map is from the limits below; more than 0 if and only if found.
    field : (n,), 0 to 1: 1 where η leads back exactly after two steps, 0 where it misses by a tenth of the diameter.
    distortion : mean change of geodesic distances under η, ÷ diameter (at most 0.045 if found).
    worst : the same for the distances of the point that fares worse than 98 in 100 (at most 0.065 if found).
    preserved : share of the area whose orientation η keeps instead of reversing (at most 0.3 if found).
    unmoved : share of points that move by less than 0.03 of the diameter (at most 0.2 if found).
    unlike : how far f_θ ∘ η = f_{−θ} is missed: mean squared difference of both sides, ÷ that of f_θ ∘ η and f_θ.
    alike : share of points that move by more than 0.1 of the diameter for whom f_θ ∘ η is nearer to f_{−θ} than to f_θ
        (chance gives half; 0 if none moves). If found, `unlike` is at most 0.9, or this at least 0.7, and 0.92 where η
        distorts little.
    reason : why nothing was found, in a sentence; "" if something was.
    """

    found: bool
    candidate: IntArray
    confidence: float
    field: FloatArray
    distortion: float
    worst: float
    preserved: float
    unmoved: float
    unlike: float
    alike: float
    reason: str

    @property
    def eta(self) -> IntArray | None:
        """η, (n,): the mirror image of every vertex; None if no symmetry was found."""
        return self.candidate if self.found else None


def intrinsic_symmetry(
    shape: TriangleMesh | PointCloud,
    *,
    family: SpectralFamily | None = None,
    alpha: float = 50.0,
    angles: int = 16,
    count: int = 150,
    size: int = 120,
    progress: Progress | None = None,
) -> IntrinsicSymmetry:
    """Find the map η that mirrors a shape in whatever pose, by the paper's own relation f_θ∘η = f_{−θ} (section 4.1).

    Geometry vectors of all channels at θ are matched to those at −θ on the same shape. Limbs that moved differently are
    more like themselves than like each other, so matches are also sought away from the point itself. Each set of
    matches starts ZoomOut among symmetric orthogonal maps (η is its own inverse); of the results that are neither
    nearly the identity nor keep orientation, the one that distorts geodesic distances and orientation least is refined
    to `size` eigenfunctions.

    shape : needs consistently oriented faces or normals. It is scaled to unit geodesic diameter first, and η is free of
        scale; `family`, the spectra of α = 0 and one or more α > 0 at evenly spaced angles, is taken as it is.
    alpha, angles, count, progress : for `compute_spectra`, without `family`.
    size : eigenfunctions of the final map, at most those of the spectra.
    Several symmetries are not told apart: one of them is returned. Returns η (n,), or says that none was found.
    Raises ParameterError if the family has no isotropic channel, or angles without their mirror images.
    """
    unit, size = normalize(shape), count_in("size", size, 1, 10**9)
    if family is None:
        degrees = (0.0, positive("alpha", alpha))
        count = min(count_in("count", count, 10, 10**9), max(int(unit.has_mass.sum()) - 2, 1))
        family = compute_spectra(unit, alphas=degrees, angles=angles, count=count, progress=progress)
    isotropic = np.flatnonzero(checked_family(family).alphas == 0)
    if not len(isotropic):
        raise ParameterError("family must hold α = 0, on whose eigenfunctions the map is built. Compute it along.")
    spectrum = family[int(isotropic[0])]
    distances = PairDistances(unit)
    allowed = int(unit.is_referenced.sum()) if isinstance(unit, TriangleMesh) else unit.vertex_count
    rows = farthest_points(unit, min(SAMPLES, allowed))
    search = _Search(spectrum, distances, rows)
    ahead, back = mirrored_descriptors(family)
    best = min(search.candidates(ahead, back), key=search.badness)
    final = grown_involution(spectrum, best, search.fine_rows, min(size, len(spectrum.eigenvalues)))
    return search.judged(search.points(final), ahead, back)


def mirrored_descriptors(family: SpectralFamily) -> tuple[FloatArray, FloatArray]:
    """Log geometry vectors f_θ and f_{−θ} of all channels, each column standardised: two arrays (n, C·M).

    Raises ParameterError if the mirror image π − θ of an angle θ is not among the angles of its α.
    """
    partner = np.empty(len(family), dtype=np.int64)
    for channel, (alpha, theta) in enumerate(zip(family.alphas, family.thetas, strict=True)):
        gap = np.abs(np.angle(np.exp(2j * (family.thetas + theta))))  # angles have period π: compare double angles
        same = np.flatnonzero((family.alphas == alpha) & (gap < 1e-6))
        if not len(same):
            raise ParameterError(
                f"family must hold the angle π − {theta:.4g} for α = {alpha:g}, but it does not. Space angles evenly."
            )
        partner[channel] = same[0]
    vectors = np.log(geometry_vectors(family, count=64) + 1e-4)
    used = family.mass > 0
    centre, spread = vectors[used].mean(axis=0), vectors[used].std(axis=0)
    vectors = (vectors - centre) / np.where(spread > 1e-9, spread, 1.0)
    n = len(vectors)
    return vectors.reshape(n, -1), vectors[:, partner].reshape(n, -1)


class _Search:
    """Candidates for η, each a symmetric orthogonal matrix, judged on sampled points."""

    def __init__(self, spectrum: Spectrum, distances: PairDistances, rows: IntArray) -> None:
        self._spectrum, self._distances, self._rows = spectrum, distances, rows
        self._few = np.linspace(0, len(rows) - 1, min(len(rows), 100)).astype(np.int64)
        self._apart = self._table(rows[self._few])
        triangles = outward_triangles(distances.shape)
        self._triangles = triangles[:: max(1, len(triangles) // 800)]
        massive = np.flatnonzero(spectrum.mass > 0)
        self.fine_rows = massive[:: max(1, len(massive) // 1200)]

    def candidates(self, ahead: FloatArray, back: FloatArray) -> list[FloatArray]:
        """A map of 40 eigenfunctions for each radius and size."""
        one = ahead[self._rows]
        squared = (one**2).sum(axis=1)[:, None] + (back**2).sum(axis=1)[None, :] - 2.0 * one @ back.T
        squared[:, self._spectrum.mass <= 0] = np.inf
        away = self._distances.rows(self._rows)
        most = len(self._spectrum.eigenvalues)
        found = []
        for radius in RADII:
            matches = np.where(away < radius, np.inf, squared).argmin(axis=1)
            for size in SIZES:
                matrix = involution_of_matches(self._spectrum, self._rows, matches, min(size, most))
                found.append(grown_involution(self._spectrum, matrix, self._rows, min(40, most)))
        return found

    def points(self, matrix: FloatArray, rows: IntArray | None = None) -> IntArray:
        functions = self._spectrum.eigenfunctions[:, : len(matrix)]
        return nearest_matches(functions if rows is None else functions[rows], functions @ matrix.T)

    def badness(self, matrix: FloatArray) -> tuple[bool, float]:
        """Nearly the identity comes last; among the others, the least distortion and the fewest faces kept."""
        images = self.points(matrix, self._rows)
        corners, place = np.unique(self._triangles, return_inverse=True)
        laid = self.points(matrix, corners)[place.reshape(-1, 3)]
        kept = orientation_kept(self._distances.shape, laid, np.ones(len(laid)))
        return self._unmoved(images) > MOST_UNMOVED, float(self._changes(images).mean()) + KEPT_COST * kept

    def judged(self, eta: IntArray, ahead: FloatArray, back: FloatArray) -> IntrinsicSymmetry:
        images = eta[self._rows]
        changes, unmoved = self._changes(images), self._unmoved(images)
        distortion, worst = float(changes.mean()), float(np.quantile(changes, WORST))
        unlike, alike = self._likeness(eta[self.fine_rows], ahead, back)
        preserved = preserved_orientation(self._distances.shape, self._distances.shape, eta)
        reason = ""
        if unmoved > MOST_UNMOVED:
            reason = f"The best map leaves {unmoved:.0%} of the points where they are."
        elif distortion > MOST_DISTORTION or worst > MOST_WORST:
            reason = (
                f"The best map changes distances by {distortion:.3f} of the diameter, at some points by {worst:.3f}."
            )
        elif preserved > MOST_KEPT:
            reason = f"The best map keeps the orientation of {preserved:.0%} of the area, so it is no mirror."
        elif unlike > MOST_UNLIKE and alike < min(max(1.06 - 16.0 * distortion, LEAST_ALIKE), MOST_ALIKE):
            reason = (
                f"The best map leads {1 - alike:.0%} of the points to ones that look no more alike mirrored than not."
            )
        nearest_limit = max(distortion / MOST_DISTORTION, worst / MOST_WORST, preserved / MOST_KEPT)
        confidence = 0.0 if reason else float(max(1.0 - nearest_limit**2, 1e-3))
        missed = self._distances(eta[eta], np.arange(len(eta)))
        field = read_only(np.clip(1.0 - missed / 0.1, 0.0, 1.0))
        return IntrinsicSymmetry(
            not reason, read_only(eta), confidence, field, distortion, worst, preserved, unmoved, unlike, alike, reason
        )

    def _unmoved(self, images: IntArray) -> float:
        return float((self._distances(self._rows, images) < STILL).mean())

    def _likeness(self, images: IntArray, ahead: FloatArray, back: FloatArray) -> tuple[float, float]:
        """`unlike` and `alike` of a map that leads `fine_rows` to `images`."""
        rows = self.fine_rows
        mirrored, plain = (((ahead[rows] - seen[images]) ** 2).mean(axis=1) for seen in (back, ahead))
        moved = self._distances(rows, images) > FAR
        unlike = float(mirrored.sum() / plain.sum()) if plain.any() else np.inf
        return unlike, float((mirrored < plain)[moved].mean()) if moved.any() else 0.0

    def _changes(self, images: IntArray) -> FloatArray:
        """Mean |d(x, y) − d(ηx, ηy)| over y for each sample x; where η breaks or joins paths, a diameter."""
        moved = self._table(images[self._few])
        whole = np.isfinite(moved) & np.isfinite(self._apart)
        change = np.abs(np.where(whole, moved, 0.0) - np.where(whole, self._apart, 0.0))
        return np.asarray(np.where(np.isfinite(moved) == np.isfinite(self._apart), change, 1.0).mean(axis=1))

    def _table(self, points: IntArray) -> FloatArray:
        n = len(points)
        first, second = np.triu_indices(n, 1)
        table = np.zeros((n, n))
        table[first, second] = self._distances(points[first], points[second])
        return table + table.T
