"""Scales say what their ends mean, and fields what stands under the cursor."""

import numpy as np
import pytest

from add_viewer.models.arrangement import columns
from add_viewer.models.fields import FieldChoice, ShapeField, ValueScale, in_common_range


def labels(scale):
    return [label for _, label in scale.ticks()]


def test_the_linear_scale_of_a_kernel_is_the_share_of_its_maximum():
    values = np.array([0.0, 1.0, 4.0])
    scale = ValueScale.of_kernel(values, "linear")
    assert scale.position(values) == pytest.approx([0, 0.25, 1])
    assert scale.ticks() == [(0.0, "0"), (0.5, "2"), (1.0, "4")]


def test_the_log_scale_of_a_kernel_spans_two_decades_and_says_so():
    values = np.array([-1e-9, 1.7, 17.0, 170.0])
    scale = ValueScale.of_kernel(values, "log")
    assert scale.position(values) == pytest.approx([0, 0, 0.5, 1])
    assert labels(scale) == ["≤ 1.7", "17", "170"]


def test_distances_saturate_at_the_percentile_and_say_so():
    values = np.array([0.0, 1.0, 2.0, 3.0, 40.0])
    scale = ValueScale.saturated(values, 50.0)
    assert scale.position(values) == pytest.approx([0, 0.5, 1, 1, 1])
    assert labels(scale) == ["0", "1", "≥ 2"]
    assert labels(ValueScale.saturated(values, 100.0))[-1] == "40"


def test_zero_is_in_the_middle_of_a_signed_scale():
    scale = ValueScale.signed(np.array([-1.0, 0.0, 4.0]))
    assert scale.position(np.array([-4.0, 0.0, 2.0])) == pytest.approx([0, 0.5, 0.75])
    assert labels(scale) == ["-4", "0", "4"]


@pytest.mark.parametrize("values", [np.zeros(5), np.full(5, 3.0), np.full(5, np.nan), np.empty(0)])
def test_fields_without_a_range_have_colours_all_the_same(values):
    made = (
        ValueScale.signed(values),
        ValueScale.spanning(values),
        ValueScale.saturated(values, 50.0),
        ValueScale.of_kernel(np.nan_to_num(values), "log"),
    )
    for scale in made:
        assert np.isfinite(scale.position(values)).all()
        assert len(scale.ticks()) >= 2


def test_a_common_range_holds_all_fields_of_one_choice_and_leaves_the_others():
    choice = FieldChoice("distance", "wks")
    fields = [
        ShapeField(shape="a", choice=choice, values=np.arange(3.0), scale=ValueScale(0.0, 2.0)),
        ShapeField(shape="b", choice=choice, values=np.arange(9.0), scale=ValueScale(0.5, 8.0, open_high=True)),
        ShapeField(shape="a", choice=FieldChoice("eigenfunction"), values=np.arange(3.0), scale=ValueScale(-1.0, 1.0)),
    ]
    joint = in_common_range(fields)
    assert [field.scale for field in joint[:2]] == [ValueScale(0.0, 8.0, open_high=True)] * 2
    assert joint[2].scale == ValueScale(-1.0, 1.0)


def test_the_value_under_the_cursor_has_symbol_and_unit():
    field = ShapeField(shape="a", choice=FieldChoice(), values=np.array([0.25, np.nan]), symbol="h", unit="/⌀²")
    assert field.reading(0) == "h = 0.25 /⌀²"
    assert field.reading(1) == ""
    assert ShapeField(shape="a", choice=FieldChoice(), colors=np.zeros((2, 3))).reading(0) == ""


@pytest.mark.parametrize(
    ("count", "aspect", "expected"), [(1, 1.6, 1), (2, 1.6, 2), (4, 1.6, 4), (6, 1.6, 3), (12, 1.6, 6), (3, 0.5, 2)]
)
def test_a_grid_makes_upright_views_large(count, aspect, expected):
    assert columns(count, "grid", aspect) == expected
    assert columns(count, "strip", aspect) == count


@pytest.mark.parametrize(("aspect", "expected"), [(2.0, 4), (0.7, 2)])
def test_a_split_view_of_two_shapes_stands_in_one_row_or_in_two(aspect, expected):
    assert columns(4, "grid", aspect, step=2) == expected
