"""Finding commands by a few letters."""

import pytest

from add_viewer.models.commands import RECENT_LIMIT, Command, find, remembered
from add_viewer.models.searching import match_score


def command(title: str, *, name: str = "", **more) -> Command:
    return Command(name or title, title, more.pop("section", "View"), lambda: None, **more)


def titles(commands: list[Command]) -> list[str]:
    return [each.title for each in commands]


ACTIONS = [
    command("Copy as script", section="Edit"),
    command("Colour bar"),
    command("Directions on the skin", help="Where heat runs, turned by θ"),
    command("Play θ", section="Edit"),
    command("Theme: Dark"),
    command("Person 1, star", section="Open", on_search=True),
]


@pytest.mark.parametrize(
    ("typed", "first"),
    [
        ("script", "Copy as script"),
        ("cas", "Copy as script"),
        ("as copy", "Copy as script"),
        ("CÓPY", "Copy as script"),
        ("bar", "Colour bar"),
        ("theta", "Play θ"),
        ("θ", "Play θ"),
        ("drk", "Theme: Dark"),
        ("where heat", "Directions on the skin"),
        ("star", "Person 1, star"),
    ],
)
def test_a_few_letters_find_it(typed, first):
    assert titles(find(ACTIONS, typed))[0] == first


def test_what_is_nowhere_finds_nothing():
    assert find(ACTIONS, "zzz") == []
    assert find(ACTIONS, "script zzz") == []


def test_letters_far_apart_are_no_match():
    assert match_score("dirs", "directions on the skin") is not None
    assert match_score("ds", "directions on the skin") is None


def test_a_whole_word_is_better_than_a_start_and_a_start_than_the_middle():
    texts = ["bar", "barrel", "crowbar", "b a r", "b_xa_r"]
    scores = [match_score("bar", text) for text in texts]
    assert scores == sorted(scores, reverse=True)
    assert len(set(scores)) == len(scores)


def test_without_a_word_the_recent_ones_come_first_and_the_many_are_left_out():
    assert titles(find(ACTIONS, "", ["Theme: Dark", "Colour bar"]))[:2] == ["Theme: Dark", "Colour bar"]
    assert "Person 1, star" not in titles(find(ACTIONS, ""))
    assert titles(find(ACTIONS, "", ["Person 1, star"]))[0] == "Person 1, star"


def test_what_cannot_be_done_now_comes_behind_its_equals_but_before_what_hardly_fits():
    actions = [command("Undo", enabled=False), command("Undo everything"), command("Turned over")]
    assert titles(find(actions, "undo")) == ["Undo everything", "Undo", "Turned over"]


def test_the_recent_list_holds_each_once_and_not_too_many():
    recent: list[str] = []
    for number in (1, 2, 3, 1, *range(4, 20), 1):
        recent = remembered(str(number), recent)
    assert recent[0] == "1"
    assert len(recent) == len(set(recent)) == RECENT_LIMIT
