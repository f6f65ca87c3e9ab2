"""What lies between two grounds of a section, and where a ground is interrupted."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from processing.methods.earthwork.sections.drawing_parts import (
    DrawnSection,
    earth_moved,
    parts_with_ground,
)

NO = np.nan
heights = st.lists(
    st.one_of(st.just(NO), st.floats(-5.0, 5.0, allow_subnormal=False)), min_size=7, max_size=7
)
OFFSETS = np.array([-4.0, -2.0, -1.0, 0.0, 0.5, 3.0, 7.0])


def section(before: list[float], after: list[float]) -> DrawnSection:
    return DrawnSection(0.0, "", OFFSETS, np.array(before), np.array(after), 0.0, 0.0)


def test_lines_that_cross_enclose_cut_and_fill() -> None:
    parts = earth_moved(section([0.0] * 7, [1.0, 1.0, 1.0, -1.0, -1.0, 0.0, 0.0]))
    areas = [(is_cut, shapely.Polygon(outline).area) for is_cut, outline in parts]
    # 3 m of a metre and half a triangle; then a triangle, half a metre and a longer triangle.
    assert areas == [(False, pytest.approx(3.25)), (True, pytest.approx(0.25 + 0.5 + 1.25))]
    assert parts[0][1].tolist()[:4] == [[-4, 0], [-2, 0], [-1, 0], [-0.5, 0]]


@given(heights, heights)
def test_cut_and_fill_are_the_integral_of_the_change_where_both_are_known(
    before: list[float], after: list[float]
) -> None:
    one = section(before, after)
    expected = [0.0, 0.0]
    stretches = zip(pairwise(OFFSETS), pairwise(one.after - one.before), strict=True)
    for (x1, x2), (d1, d2) in stretches:
        if np.isfinite(d1 + d2):
            fine = np.linspace(d1, d2, 2001)
            for at, part in enumerate((np.minimum(fine, 0.0), np.maximum(fine, 0.0))):
                expected[at] += abs(float(np.mean((part[1:] + part[:-1]) / 2))) * (x2 - x1)
    found = [0.0, 0.0]
    for is_cut, outline in earth_moved(one):
        found[0 if is_cut else 1] += float(shapely.Polygon(outline).area)
    assert found == pytest.approx(expected, abs=1e-4)


@given(heights)
def test_stretches_with_ground_hold_every_known_place_beside_another(values: list[float]) -> None:
    found = parts_with_ground(OFFSETS, np.array(values))
    known = np.isfinite(values)
    beside = np.append(False, known[:-1]) | np.append(known[1:], False)
    expected = OFFSETS[known & beside]
    assert np.concatenate([[], *(part[:, 0] for part in found)]).tolist() == expected.tolist()
    for part in found:
        assert len(part) > 1


def test_without_ground_there_is_nothing() -> None:
    assert earth_moved(section([NO] * 7, [0.0] * 7)) == []
    assert earth_moved(section([0.0] * 7, [0.0] * 7)) == []
    assert parts_with_ground(OFFSETS, np.full(7, NO)) == []


def test_what_the_boundary_leaves_out_is_not_filled() -> None:
    is_inside = np.array([False, True, True, False, True, True])
    one = replace(section([0.0] * 7, [1.0] * 7), is_inside=is_inside)
    areas = [shapely.Polygon(outline).area for _, outline in earth_moved(one)]
    assert areas == pytest.approx([2.0, 6.5])
