"""Symbols on lanes are those that a street of its kind has."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.roadway.markings import symbols_of
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL, URBAN, Style

_HEAD_M = 0.8  # an arrow's widest step


@pytest.mark.parametrize(("style", "most"), [(URBAN, {2}), (RURAL, set()), (HIGHWAY, set())])
def test_arrows_are_painted_on_town_streets_of_several_lanes_only(
    style: Style, most: set[int]
) -> None:
    lanes = set()
    for seed in range(8):
        street = Street(seed, style, 60.0)
        section = street.bare_section(street.within(30.0, 30.0)[0])
        for draw in range(6):
            rectangles = list(symbols_of(section, section.chance("symbols", draw)))
            if any(np.isclose(left - right, _HEAD_M) for _, _, right, left in rectangles):
                lanes.add(section.plan.lanes)
    assert lanes == most
