"""The list of fields: everything is in it once, explained, and found by the words that people use."""

from dataclasses import replace

import numpy as np
import pytest

from add_viewer.models.descriptor_names import descriptor_name
from add_viewer.models.field_catalogue import GROUPS, catalogue, entry_of, found_by
from add_viewer.models.fields import FIELD_KINDS, FieldChoice
from add_viewer.models.session import SessionState

NAMES = ("hks", "wks", "ahks", "humans-madd3", "/runs/mine/model.safetensors")


@pytest.fixture
def entries(torus):
    return catalogue(SessionState(shapes=(replace(torus, fields={"quality": np.zeros(288)}),)), NAMES)


def test_every_kind_is_offered_and_explained_in_its_group(entries):
    assert {entry.choice.kind for entry in entries} == set(FIELD_KINDS)
    assert [entry.group for entry in entries] == sorted((e.group for e in entries), key=GROUPS.index)
    assert all(entry.help.endswith((".", ").")) and len(entry.help) < 170 for entry in entries)
    assert len({entry.choice for entry in entries}) == len(entries)


@pytest.mark.parametrize(
    ("text", "first"),
    [
        ("wks", "Distance in WKS"),
        ("figure 6", "Distance in HKS"),
        ("eigen", "Eigenfunction"),
        ("mirror", "Heat by θ and −θ"),
        ("GAUSS", "Gaussian curvature"),
        ("quality", "quality"),
        ("correspondence colour", "Place colours"),
        ("left madd3", "Left from right in mADD3"),
    ],
)
def test_fields_are_found_by_the_words_that_people_use(entries, text, first):
    assert found_by(entries, text)[0].title == first


def test_nonsense_finds_nothing_and_no_words_find_all(entries):
    assert found_by(entries, "xyzzy") == ()
    assert found_by(entries, " ") == entries


def test_a_choice_finds_its_entry_with_its_own_numbers(entries):
    choice = FieldChoice("distance", "wks", saturation=80.0)
    assert entry_of(entries, choice).title == "Distance in WKS"
    assert entry_of(entries, choice).choice is choice
    assert entry_of(entries, FieldChoice("eigenfunction", index=9)).controls == {"model", "alpha", "theta", "index"}
    gone = FieldChoice("distance", "/runs/old/model.safetensors")
    assert entry_of(entries, gone).title == "Distance in old"
    assert entry_of(entries, FieldChoice("file", name="lost")).title == "lost"


def test_a_trained_model_is_called_after_its_folder():
    assert descriptor_name("/runs/mine/model.safetensors").title == "mine"
    assert descriptor_name("/models/night.safetensors").title == "night"
    assert descriptor_name("humans-madd3").title == "mADD3"
    assert descriptor_name("dogs-osd").title == "OSD, dogs"
