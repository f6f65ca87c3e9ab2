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


@pytest.mark.parametrize("style", [URBAN, RURAL])
def test_truth_of_markings_lies_on_paint_that_its_pieces_count(style: Style) -> None:
    street = Street(21, style, 60.0)
    kinds = set()
    for row in street.within(0.0, 60.0):
        built = street.section(row)
        middles = built.mesh.vertices[built.mesh.triangles].mean(axis=1)
        marked = [one for one in built.truth if one.file == "markings"]
        assert {one.instance for one in marked} == {
            one.instance for one in built.things if one.kind == "marking"
        }
        for one in marked:
            kinds.add(one.facts["type"])
            on = middles[built.mesh.instance == one.instance]
            wide = one.facts["width_m"]
            assert isinstance(wide, float)
            steps = np.diff(one.xyz[:, :2], axis=0)
            assert len(one.xyz) <= 256
            for place in on[:: max(1, len(on) // 9), :2]:
                ways = place - one.xyz[:-1, :2]
                long = np.maximum((steps**2).sum(axis=1), 1e-12)
                share = np.clip((ways * steps).sum(axis=1) / long, 0.0, 1.0)
                off = np.hypot(*(ways - share[:, None] * steps).T).min()
                assert off <= wide / 2 + 0.02
    assert "solid" in kinds or "broken" in kinds
