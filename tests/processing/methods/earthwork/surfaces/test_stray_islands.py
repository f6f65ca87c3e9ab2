"""Islands of points over hidden ground: what another date shows there says whether they are it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.methods.earthwork.surfaces.stray_islands import contradicted, loose_islands
from processing.methods.earthwork.surfaces.surfaces import SideHeights

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

SIZE_M = 0.2
SHAPE = (100, 100)
HOLE = np.s_[20:80, 20:80]
SPARSE = np.s_[48:52:3, 40:60:4]
SOLID = np.s_[45:55, 45:55]


def shown(hole_m: Floats | float = np.nan) -> Floats:
    """Level ground with a hole, and what is measured in it."""
    heights = np.zeros(SHAPE)
    heights[HOLE] = hole_m
    return heights


def with_island(at: tuple[slice, slice], height_m: float) -> Floats:
    heights = shown()
    heights[at] = height_m
    return heights


def dates(other_m: float, *, is_measured: bool = True) -> tuple[SideHeights, SideHeights]:
    """A date expected to be level, and another that has its hole at a height."""
    everywhere = np.ones(SHAPE, np.bool_)
    other = shown(other_m)
    spread = np.where(np.isnan(shown()), 0.1, 0.0)
    return (
        SideHeights(np.zeros(SHAPE), ~np.isnan(shown()), spread),
        SideHeights(other, everywhere & is_measured, np.zeros(SHAPE)),
    )


def dropped(heights: Floats, other_m: float = 0.0, *, is_measured: bool = True) -> Mask:
    islands = loose_islands(heights, SIZE_M)
    assert islands.any()
    expected = dates(other_m, is_measured=is_measured)
    return contradicted(heights, islands, expected, 0, SIZE_M)


def test_a_part_that_hangs_together_with_nothing_is_an_island_and_the_site_is_none() -> None:
    islands = loose_islands(with_island(SOLID, 2.0), SIZE_M)
    steep = loose_islands(with_island(np.s_[20:80, 20:80], 0.5), SIZE_M)

    assert set(np.unique(islands)) == {0, 1}
    assert (islands[SOLID] == 1).all()
    # A step that the next metre of a slope at rest would make is of the same ground.
    assert not steep.any()
    assert not loose_islands(np.zeros((10, 10)), SIZE_M).any()


def test_an_island_far_from_what_another_date_shows_is_dropped() -> None:
    roof, mirrored = with_island(SOLID, 2.6), with_island(SPARSE, -3.0)

    assert dropped(roof)[SOLID].all()
    assert dropped(roof).sum() == 100
    assert dropped(mirrored)[SPARSE].all()


def test_ground_between_no_change_and_the_change_about_stays() -> None:
    # The other date lies 1.5 m lower, the surroundings let expect none of it.
    assert not dropped(with_island(SPARSE, -1.0), other_m=-1.5).any()
    assert not dropped(with_island(SPARSE, 0.2)).any()


def test_the_floor_of_a_pit_that_is_seen_as_a_surface_stays() -> None:
    assert not dropped(with_island(SOLID, -3.0)).any()


def test_an_island_that_no_other_date_shows_stays() -> None:
    assert not dropped(with_island(SOLID, 2.6), is_measured=False).any()
