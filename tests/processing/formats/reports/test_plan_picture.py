from __future__ import annotations

import numpy as np
import pytest

from processing.formats.reports.plan_picture import PlanPicture, plan_parts, scale_of

SIZE = (200.0, 170.0)


def strip(long_m: int, *, wide_m: int = 12) -> PlanPicture:
    """A road that runs from the south-west to the north-east, a pixel a metre."""
    y, x = np.mgrid[0:long_m, 0:long_m]
    rgb = np.where(np.abs(long_m - 1 - y - x)[..., None] < wide_m, 90, 255).astype(np.uint8)
    return PlanPicture(rgb.repeat(3, axis=2), 1000.0, 2000.0, 1000.0 + long_m, 2000.0 + long_m)


def test_a_small_site_is_one_map() -> None:
    assert plan_parts(strip(100), SIZE)[1] == ()


def test_a_long_road_is_shown_in_parts_that_can_be_read() -> None:
    plan = strip(900)
    scale, parts = plan_parts(plan, SIZE)
    assert scale < scale_of(plan, SIZE)
    assert 1 < len(parts) <= 12
    shown = sum(int((part.rgb < 255).all(axis=2).sum()) for part in parts)
    assert shown == (plan.rgb < 255).all(axis=2).sum()
    for part in parts:
        assert scale_of(part, SIZE) <= scale


def test_a_part_lies_where_its_pixels_did() -> None:
    plan = strip(900)
    for part in plan_parts(plan, SIZE)[1]:
        left, top = round(part.west - plan.west), round(plan.north - part.north)
        rows, columns = part.rgb.shape[:2]
        np.testing.assert_array_equal(part.rgb, plan.rgb[top : top + rows, left : left + columns])
        assert part.north - part.south == pytest.approx(rows)


def test_a_site_too_large_for_legible_parts_is_one_map() -> None:
    rgb = np.zeros((1600, 1600, 3), np.uint8)
    assert plan_parts(PlanPicture(rgb, 0.0, 0.0, 90_000.0, 90_000.0), SIZE)[1] == ()


def test_the_scale_is_round_and_the_map_fits() -> None:
    for long_m in (7, 33, 120, 1234):
        scale = scale_of(strip(long_m), SIZE)
        assert long_m * 1000 / scale <= min(SIZE)
        assert float(f"{scale:.1e}") == scale
