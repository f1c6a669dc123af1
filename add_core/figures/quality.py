"""How much work goes into a figure."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quality:
    """How finely figures are drawn and how much is computed for them.

    dots : per inch. oversampling : samples along each side of a dot. sky : directions that light comes from.
    eigenpairs, angles : K and L of the spectra. cloud_points : of the point clouds. pairs : of shapes that are matched
        for each curve. queries : points asked for on each; None asks for all.
    """

    name: str
    dots: int
    oversampling: int
    sky: int
    eigenpairs: int
    angles: int
    cloud_points: int
    pairs: int
    queries: int | None


QUALITIES: dict[str, Quality] = {
    "draft": Quality("draft", 130, 2, 32, eigenpairs=100, angles=8, cloud_points=4000, pairs=2, queries=500),
    "full": Quality("full", 160, 3, 96, eigenpairs=300, angles=16, cloud_points=4000, pairs=4, queries=1000),
}
