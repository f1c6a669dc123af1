"""Who appears in the figures: shapes of a collection, and points on them."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..io import Collection, humans, poses


@dataclass(frozen=True, eq=False)
class Cast:
    """Shapes by their number in `collection`, points by their vertex.

    hero : stands for the kernels. second : the hero's shape in another pose. source : where heat is dropped.
    points : three for signatures, each with a word for it. reference_point : for distance maps.
    audience : shapes whose distance maps are drawn, with the variant of each. reference, targets : of colour transfer.
    contests : collections whose test shapes are matched; learned : trained descriptors, by name, that know such
    shapes; naming : correspondence networks that do.
    """

    collection: Collection
    hero: int
    second: int
    source: int
    points: tuple[tuple[int, str], ...]
    reference_point: int
    audience: tuple[tuple[int, str], ...]
    reference: int
    targets: tuple[int, ...]
    contests: tuple[Collection, ...] = field(default=())
    learned: tuple[str, ...] = ()
    naming: tuple[str, ...] = ()


def people() -> Cast:
    """Persons 9 and 10 of the shipped people, on whom nothing was trained."""
    return Cast(
        collection=humans(),
        hero=80,
        second=84,
        source=6887,
        points=((4303, "chest"), (6868, "thigh"), (5935, "shin")),
        reference_point=3861,
        audience=(*((index, "mesh") for index in (80, 83, 86, 92, 97)), (93, "remeshed"), (84, "cloud")),
        reference=83,
        targets=(87, 84, 89, 92, 96),
        contests=(humans(), poses()),
        learned=("humans-madd3",),
        naming=("humans-madd4",),
    )
