"""Gratings among the covers of a gutter along x."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.gutters.grating_facts import GratingFacts, GratingFound
from processing.methods.road.gutters.gutter_axis import GutterAxis
from processing.methods.road.gutters.gutter_gratings import RatedCovers, add_gratings
from processing.methods.road.gutters.gutter_lids import GutterCover

WIDE_M, LONG_M = 0.4, 0.6
AXIS = GutterAxis.through(np.array([[0.0, 0.0, 5.0], [10.0, 0.0, 5.0]]))


def rectangle(middle: tuple[float, float], long: float, wide: float) -> NDArray[np.float64]:
    x, y = long / 2, wide / 2
    ring = np.array([[-x, -y, 5.0], [x, -y, 5.0], [x, y, 5.0], [-x, y, 5.0]])
    return ring + np.array([*middle, 0.0])


def cover(along_m: float, *, long_m: float = LONG_M, is_grating: bool = False) -> GutterCover:
    return GutterCover(
        rectangle((along_m, 0.0), long_m, WIDE_M),
        is_grating=is_grating,
        is_bridged=False,
        width_m=WIDE_M,
        length_m=long_m,
        on_top=50,
        below=0,
        along_m=along_m,
        seen=(2, 2),
        rough_m=0.002,
    )


def grating(x: float, y: float = 0.0, *, long_m: float = 0.5, sure: float = 0.9) -> GratingFound:
    facts = GratingFacts(
        rows=10, open_share=0.6, depth_m=0.1, least_part=0.5, about=0.0, raised_m=0.0
    )
    corners = rectangle((x, y), long_m, 0.38)
    return GratingFound(corners, long_m, 0.38, facts, sure, points=(4, 5, 6, 7), drive=1)


def lids(count: int = 5, sure: float = 0.7) -> RatedCovers:
    covers = tuple(cover(1.0 + LONG_M * number) for number in range(count))
    return RatedCovers(covers, np.full(count, sure))


def test_a_grating_takes_the_place_of_the_lid_that_was_taken_for_one() -> None:
    own, beside = add_gratings(AXIS, lids(), [grating(2.2)])

    assert not beside
    assert [one.is_grating for one in own.covers] == [False, False, True, False, False]
    assert own.covers[2].length_m == pytest.approx(0.5)
    assert own.covers[2].points == (4, 5, 6, 7)
    assert own.covers[2].drives == (1, 1, 1, 1)
    assert own.sure == pytest.approx([0.7, 0.7, 0.9, 0.7, 0.7])


def test_lids_that_are_surer_stay() -> None:
    own, beside = add_gratings(AXIS, lids(sure=0.95), [grating(2.2)])

    assert not beside
    assert not any(one.is_grating for one in own.covers)


def test_a_grating_that_the_joints_tell_of_too_keeps_its_place_and_is_surer() -> None:
    both = RatedCovers((cover(1.0), cover(1.55, long_m=0.5, is_grating=True)), np.array([0.7, 0.6]))
    own, _ = add_gratings(AXIS, both, [grating(1.56)])

    assert own.covers == both.covers
    assert own.sure == pytest.approx([0.7, 0.9])


def test_a_catch_basin_beside_a_gutter_is_none_of_its_covers() -> None:
    basin = grating(2.2, 0.9)
    own, beside = add_gratings(AXIS, lids(), [basin])

    assert beside == (basin,)
    assert len(own.covers) == 5
