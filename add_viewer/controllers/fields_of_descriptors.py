"""Fields that descriptors make: distance maps, ambiguity maps, single components."""

from __future__ import annotations

import numpy as np

from ..models.descriptor_names import descriptor_name
from ..models.fields import ShapeField, ValueScale
from ..models.picks import Pick
from ..models.session import SessionState
from .descriptor_maps import ambiguity, best_places, distance_map
from .field_plans import Place, Plan, Same, Sources

MISTAKEN = 0.01
"""Distance to the mirror image, ÷ median, up to which a point counts as mistaken for it: the cold end of colours."""


def distance_plan(place: Place, sources: Sources) -> Plan:
    """Distances to the picked point in descriptor space, the paper's Figure 6."""
    pick = asked_point(place.state)
    if pick is None:
        return Plan()
    owner = place.state.shape(pick.shape)
    assert owner is not None
    name, store = place.choice.descriptor, sources.descriptors
    theirs, ours = store.want(owner, name), store.want(place.shape, name)
    if theirs is None or ours is None:
        return Plan(message=store.message(place.shape if ours is None else owner, name))
    if theirs.shape[1] != ours.shape[1]:
        return Plan(message=f"{descriptor_name(name).title} has another width on {place.shape.name}: too few vertices")
    own = pick.vertex if owner.key == place.shape.key else None
    point = theirs[pick.vertex]

    def work() -> ShapeField:
        return _distance_field(place, distance_map(ours, point), own)

    return Plan((place.choice, Same(ours), Same(theirs), pick.shape, pick.vertex), work)


def _distance_field(place: Place, values: np.ndarray, own: int | None) -> ShapeField:
    choice = place.choice
    away = values if own is None else np.where(np.arange(len(values)) == own, 0.0, values)
    best = best_places(away, place.shape.shape.vertices)
    return ShapeField(
        shape=place.shape.key,
        choice=choice,
        values=values,
        title=f"Distance in {descriptor_name(choice.descriptor).title}",
        notes=("no unit", f"saturated at the {quantile_words(choice.saturation)}"),
        tones="distance",
        scale=ValueScale.saturated(values, choice.saturation),
        symbol="distance",
        best=tuple(int(vertex) for vertex in best if vertex != own),
    )


def quantile_words(percentile: float) -> str:
    """Where colours saturate: "median", "maximum", "10th percentile"."""
    known = {50.0: "median", 100.0: "maximum"}
    number = f"{percentile:.3g}"
    ending = "th" if number[-2:-1] == "1" or "." in number else {"1": "st", "2": "nd", "3": "rd"}.get(number[-1], "th")
    return known.get(percentile, f"{number}{ending} percentile")


def ambiguity_plan(place: Place, sources: Sources) -> Plan:
    """How far every point is from its own mirror image, in descriptor space."""
    symmetry = place.shape.symmetry
    if symmetry is None:
        return Plan(message=f"The mirror map of {place.shape.name} is not known yet: find it under Symmetry")
    name = place.choice.descriptor
    ours = sources.descriptors.want(place.shape, name)
    if ours is None:
        return Plan(message=sources.descriptors.message(place.shape, name))

    def work() -> ShapeField:
        return ShapeField(
            shape=place.shape.key,
            choice=place.choice,
            values=ambiguity(ours, symmetry),
            title=f"{descriptor_name(name).title}, left–right",
            notes=("to the mirror image", "÷ median, log scale"),
            tones="distance",
            scale=ValueScale(MISTAKEN, 1.0, "log", open_low=True, open_high=True),
            symbol="to its mirror image",
            unit="medians",
        )

    return Plan((place.choice, Same(ours), Same(symmetry)), work)


def signature_plan(place: Place, sources: Sources) -> Plan:
    """One number of a descriptor at every point."""
    name = place.choice.descriptor
    ours = sources.descriptors.want(place.shape, name)
    if ours is None:
        return Plan(message=sources.descriptors.message(place.shape, name))
    count = ours.shape[1]
    index = min(place.choice.index, count - 1)

    def work() -> ShapeField:
        values = ours[:, index].astype(np.float64)
        return ShapeField(
            shape=place.shape.key,
            choice=place.choice,
            values=values,
            title=f"{descriptor_name(name).title}, number {index + 1} of {count}",
            notes=("standardised", "linear scale"),
            tones="sequential",
            scale=ValueScale.spanning(values),
            symbol="value",
        )

    return Plan((place.choice, Same(ours), index), work)


def asked_point(state: SessionState) -> Pick | None:
    """The point that distances are measured from: the last one picked that is nobody's mirror image."""
    picks = state.active_picks or state.picks
    plain = [pick for pick in picks if not pick.is_mirror]
    chosen = plain[-1] if plain else None
    return chosen if chosen is not None and state.shape(chosen.shape) is not None else None
