"""Words that stand under figures."""

from math import radians

import pytest

from add_viewer.models.captions import describe
from add_viewer.models.diffusion import Diffusion


@pytest.mark.parametrize(
    ("diffusion", "words"),
    [
        (Diffusion("curvature", 50.0, radians(30), 0.06), "α = 50 ⌀ (curvature), θ = 30°, t = 0.03 ⌀²"),
        (Diffusion("constant", 7.5, radians(90), 0.06), "α = 7.5 (constant), θ = 90°, t = 0.03 ⌀²"),
        (Diffusion("curvature", 0.0, radians(30), 0.06), "α = 0 ⌀ (curvature), t = 0.03 ⌀²"),
    ],
)
def test_a_caption_says_what_was_computed_and_no_angle_where_there_is_none(diffusion, words):
    assert describe(diffusion, 2.0) == words
