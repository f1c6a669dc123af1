"""How the data sets of the literature name their files, and what is known about them."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Member:
    """What the name of one file says. trains : whether the literature trains on it, None without a custom."""

    name: str
    subject: str | None = None
    pose: str | None = None
    trains: bool | None = None


@dataclass(frozen=True)
class Layout:
    """One data set.

    stem : what its file names look like. home : where to get it. licence : its terms in a few words.
    """

    title: str
    stem: re.Pattern[str]
    member: Callable[[re.Match[str]], Member]
    example: str
    home: str
    licence: str
    unit: str = ""
    up: str = ""
    front: str = ""


def _faust(match: re.Match[str]) -> Member:
    subject, pose = divmod(int(match[1]), 10)
    # Subjects 1 to 8 train, 9 and 10 test.
    return Member(f"subject {subject + 1}, pose {pose + 1}", f"subject {subject + 1}", f"pose {pose + 1}", subject < 8)


def _scape(match: re.Match[str]) -> Member:
    number = int(match[1])
    return Member(f"shape {number}", "scape", f"pose {number}", 10 <= number <= 70)


def _tosca(match: re.Match[str]) -> Member:
    return Member(f"{match[1]} {match[2]}", match[1], f"pose {match[2]}")


LAYOUTS = (
    Layout(
        title="FAUST",
        stem=re.compile(r"tr_reg_(\d{3})"),
        member=_faust,
        example="tr_reg_000.ply",
        home="http://faust.is.tue.mpg.de",
        licence="non-commercial research only, after registration",
        unit="m",
        up="+y",
        front="+z",
    ),
    Layout(
        title="SCAPE",
        stem=re.compile(r"mesh(\d{3})"),
        member=_scape,
        example="mesh000.ply",
        home="http://ai.stanford.edu/~drago/Projects/scape/scape.html",
        licence="for research; see its page",
    ),
    Layout(
        title="TOSCA",
        stem=re.compile(r"(cat|centaur|david|dog|gorilla|horse|lioness|michael|seahorse|shark|victoria|wolf)(\d+)"),
        member=_tosca,
        example="cat0.off or cat0.mat",
        home="http://tosca.cs.technion.ac.il/book/resources_data.html",
        licence="for research; see its page",
    ),
)


def layout_of(stems: list[str]) -> Layout | None:
    """The data set whose naming all file names (without extensions) follow."""
    return next((layout for layout in LAYOUTS if all(layout.stem.fullmatch(stem) for stem in stems)), None)


def whereabouts(hint: str) -> str:
    """Where to get the data sets; of those named in `hint`, if any is."""
    named = [layout for layout in LAYOUTS if layout.title.lower() in hint.lower()] or LAYOUTS
    return " ".join(f"{known.title} ({known.example}, …): {known.home}, {known.licence}." for known in named)
