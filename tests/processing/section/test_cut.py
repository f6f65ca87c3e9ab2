"""A cut sees left on its left, and a place goes there and back unchanged."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import OutOfRange
from processing.section.cut import Cut

NORTHWARDS = Cut((-11_030.0, -35_020.0, 125.0), (1.0, 0.0), 1.0, 15.0)
"""Across a line that leads north: the section's axis points east."""


def test_looking_along_the_line_left_is_left_and_ahead_is_away() -> None:
    west, ahead = (-11_033.0, -35_020.0, 126.0), (-11_030.0, -35_018.0, 125.0)
    section = NORTHWARDS.to_section([west, ahead])
    assert section == pytest.approx(np.array([[-3.0, 126.0, 0.0], [0.0, 125.0, 2.0]]))


@pytest.mark.parametrize("degrees", [0.0, 37.0, 90.0, 181.0, 300.0])
def test_a_place_goes_into_the_section_and_back(degrees: float) -> None:
    angle = np.radians(degrees)
    cut = Cut((-11_030.0, -35_020.0, 125.0), (float(np.cos(angle)), float(np.sin(angle))))
    xyz = np.random.default_rng(1).uniform(-20, 20, (50, 3)) + np.array(cut.middle)
    assert cut.to_space(cut.to_section(xyz)) == pytest.approx(xyz, abs=1e-9)


def test_the_outline_holds_exactly_the_places_of_the_slab() -> None:
    low, high = NORTHWARDS.outline.min(axis=0), NORTHWARDS.outline.max(axis=0)
    assert low == pytest.approx([-11_045.0, -35_020.5])
    assert high == pytest.approx([-11_015.0, -35_019.5])
    inside = NORTHWARDS.holds(NORTHWARDS.to_section([[*low, 125.0], [low[0] - 0.01, *high[1:], 0]]))
    assert inside.tolist() == [True, False]


@pytest.mark.parametrize(
    ("direction", "width_m", "half_m"),
    [((1.0, 1.0), 1.0, 15.0), ((1.0, 0.0), 0.0, 15.0), ((1.0, 0.0), 1.0, float("nan"))],
)
def test_a_cut_that_cannot_be_is_refused(
    direction: tuple[float, float], width_m: float, half_m: float
) -> None:
    with pytest.raises(OutOfRange):
        Cut((0.0, 0.0, 0.0), direction, width_m, half_m)
