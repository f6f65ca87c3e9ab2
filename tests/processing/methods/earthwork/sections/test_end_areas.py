"""Volumes from cross-sections: against bodies of known volume, along curves, within boundaries."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import Cancelled, OutOfRange, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.geometry.triangulation import triangulate_ground
from processing.methods.earthwork.sections.cross_sections import (
    SectionLayout,
    cross_sections,
    stations_of,
)
from processing.methods.earthwork.sections.end_areas import end_area_volume, prismoidal_volume
from processing.methods.earthwork.sections.height_surfaces import GridSurface, LevelSurface
from processing.methods.earthwork.volumes.tin_volume import volume_between
from processing.methods.ground.filters.cells import CellGrid
from tests.processing.methods.earthwork.bodies import (
    BATTER,
    EMBANKMENT_LONG_M,
    HIGH_M,
    LOW_M,
    SURVEYED,
    embankment_lines,
    embankment_m3,
    scattered_surface,
)

QUIET = SilentMonitor()
LEVEL = LevelSurface(0.0)
EAST = np.array([[0.0, 0.0], [60.0, 0.0]])


class FormulaGround:
    """A ground given by a formula."""

    def __init__(self, height):
        self._height = height

    def heights_at(self, xy: np.ndarray) -> np.ndarray:
        return self._height(xy[:, 0], xy[:, 1])


def embankment() -> tuple[TriangleSurface, TriangleSurface]:
    """Level ground, and the embankment on it, of triangles, over the same rectangle."""
    around = np.array([[0, -20, 0], [60, -20, 0], [60, 20, 0], [0, 20, 0.0]]) + SURVEYED
    lines = embankment_lines()
    ends = [
        np.array([lines[one][at], lines[other][at]])
        for one, other in ((0, 1), (2, 3), (0, 2))
        for at in (0, 1)
    ]
    return (
        triangulate_ground(around, (), QUIET),
        triangulate_ground(around, [*lines, *ends], QUIET),
    )


def test_all_methods_side_by_side_on_an_embankment_of_known_volume() -> None:
    before, after = embankment()
    expected = embankment_m3()
    line = SectionLayout(EAST + SURVEYED[:2], half_width_m=15.0, interval_m=20.0, step_m=0.02)
    tin = volume_between(before, after, QUIET)
    prisms = prismoidal_volume(line, (before, after), QUIET)
    ends = end_area_volume(line, (before, after), QUIET)
    assert tin.fill_m3 == pytest.approx(expected, rel=1e-9)
    assert prisms.fill_m3 == pytest.approx(expected, rel=2e-5)
    # Mean end areas are known to give too much where a body grows: m Δh² L / 6 each interval.
    rise = (HIGH_M - LOW_M) / 3
    excess = 3 * BATTER * rise**2 * 20.0 / 6
    assert ends.fill_m3 == pytest.approx(expected + excess, rel=2e-5)
    for found in (tin, prisms, ends):
        assert found.cut_m3 == pytest.approx(0.0, abs=1e-6)
    assert prisms.area_m2 == pytest.approx(EMBANKMENT_LONG_M * 30.0)
    assert (ends.missing_m2, ends.notes) == (0.0, ())


def test_stations_end_at_the_end_of_the_line() -> None:
    line = SectionLayout(EAST, 5.0, 25.0)
    assert stations_of(line).tolist() == [0.0, 25.0, 50.0, 60.0]
    assert stations_of(SectionLayout(EAST, 5.0, 20.0)).tolist() == [0.0, 20.0, 40.0, 60.0]
    assert stations_of(SectionLayout(EAST, 5.0, 100.0)).tolist() == [0.0, 60.0]


def test_the_profiles_of_a_section_and_its_sides() -> None:
    before = FormulaGround(lambda x, y: 0.1 * y)
    line = SectionLayout(EAST, 5.0, 30.0, 1.0)
    section = cross_sections(line, np.array([30.0]), (before, LEVEL), QUIET)[0]
    assert section.position == pytest.approx([30.0, 0.0])
    assert section.offsets_m == pytest.approx(np.arange(-5.0, 6.0))
    assert section.before == pytest.approx(-0.1 * np.arange(-5.0, 6.0))  # left is north
    assert section.cut_m2 == pytest.approx(1.25)
    assert section.fill_m2 == pytest.approx(1.25)
    assert section.moments.cut == pytest.approx(-1.25 * 10 / 3)
    assert section.moments.fill == pytest.approx(1.25 * 10 / 3)


@given(st.floats(-2.0, 2.0), st.floats(-1.0, 1.0), st.floats(0.07, 3.0))
def test_a_change_of_sign_within_a_step_is_split_exactly(
    height: float, slope: float, step: float
) -> None:
    after = FormulaGround(lambda x, y: height + slope * y)
    section = cross_sections(
        SectionLayout(EAST, 6.0, 60.0, step), np.array([7.0]), (LEVEL, after), QUIET
    )[0]
    positions = np.linspace(-6.0, 6.0, 20_001)
    change = height - slope * positions
    for found, moment, part in (
        (section.fill_m2, section.moments.fill, np.maximum(change, 0)),
        (section.cut_m2, section.moments.cut, np.maximum(-change, 0)),
    ):
        assert found == pytest.approx(np.trapezoid(part, positions), abs=1e-6)
        assert moment == pytest.approx(np.trapezoid(part * positions, positions), abs=1e-5)


def test_on_a_curve_areas_count_with_the_way_of_their_centroid() -> None:
    def ring(x, y):
        radius = np.hypot(x, y)
        return np.where((radius > 32.0) & (radius < 36.0), 1.0, 0.0)

    ways = np.linspace(0.0, np.pi / 2, 300)
    expected = np.pi / 4 * (36.0**2 - 32.0**2)
    for turned in (1, -1):
        xy = 30.0 * np.column_stack([np.cos(ways), np.sin(ways)])[::turned]
        line = SectionLayout(xy + SURVEYED[:2], 8.0, 5.0, 0.01)
        after = FormulaGround(lambda x, y: ring(x - SURVEYED[0], y - SURVEYED[1]))
        found = end_area_volume(line, (LEVEL, after), QUIET)
        assert found.fill_m3 == pytest.approx(expected, rel=2e-3)
        prisms = prismoidal_volume(line, (LEVEL, after), QUIET)
        assert prisms.fill_m3 == pytest.approx(expected, rel=2e-3)
        assert found.area_m2 == pytest.approx(np.pi / 4 * (38.0**2 - 22.0**2), rel=2e-3)


def test_a_line_that_bends_within_the_width_is_told() -> None:
    ways = np.linspace(0.0, np.pi / 2, 50)
    xy = 5.0 * np.column_stack([np.cos(ways), np.sin(ways)])
    found = end_area_volume(SectionLayout(xy, 8.0, 2.0), (LEVEL, LevelSurface(1.0)), QUIET)
    assert "cross each other" in found.notes[0].en
    inner = end_area_volume(
        SectionLayout(xy, 8.0, 2.0),
        (LEVEL, LevelSurface(1.0)),
        QUIET,
        shapely.Point(0, 0).buffer(9).difference(shapely.Point(0, 0).buffer(4)),
    )
    assert inner.notes == ()


def test_only_what_is_within_the_boundary_counts() -> None:
    boundary = shapely.Polygon(
        [[10, -4], [50, -4], [50, 3], [10, 3]], [[[20, -1], [40, -1], [40, 1], [20, 1]]]
    )
    line = SectionLayout(EAST, 7.0, 0.5)
    found = prismoidal_volume(line, (LEVEL, LevelSurface(2.0)), QUIET, boundary)
    # The ends of area and hole lie within intervals, or on their ends.
    assert found.fill_m3 == pytest.approx(2.0 * (40 * 7 - 20 * 2), rel=0.02)
    middle = next(one for one in found.sections if one.station_m == 30.0)
    assert middle.fill_m2 == pytest.approx(2.0 * 5.0, abs=1e-9)
    assert middle.offsets_m[:-1][middle.is_inside].min() == pytest.approx(-3.0)
    assert found.missing_m2 == 0.0


def test_two_parts_of_a_boundary_add_up() -> None:
    ground = scattered_surface(300, 3, lambda x, y: np.sin(x) + 0.1 * y)
    xy = np.array([[1.0, 9.0], [19.0, 12.0]]) + SURVEYED[:2]
    line = SectionLayout(xy, 6.0, 3.0)
    grounds = (LevelSurface(SURVEYED[2] + 1.0), ground)
    west, south = SURVEYED[:2]
    parts = [
        shapely.box(west, south, west + 20, south + 10.3),
        shapely.box(west, south + 10.3, west + 20, south + 20),
    ]
    whole = end_area_volume(line, grounds, QUIET, shapely.union_all(parts))
    found = [end_area_volume(line, grounds, QUIET, part) for part in parts]
    # A part's own edge is one more place of its profiles.
    assert sum(one.fill_m3 for one in found) == pytest.approx(whole.fill_m3, rel=1e-3)
    assert sum(one.cut_m3 for one in found) == pytest.approx(whole.cut_m3, rel=1e-3)
    assert sum(one.area_m2 for one in found) == pytest.approx(whole.area_m2)


def test_there_and_back_cut_and_fill_are_exchanged() -> None:
    ground = scattered_surface(300, 3, lambda x, y: np.sin(x) + 0.1 * y)
    line = SectionLayout(np.array([[1.0, 9.0], [9.0, 9.0], [19.0, 12.0]]) + SURVEYED[:2], 6.0, 3.0)
    level = LevelSurface(SURVEYED[2] + 1.0)
    there = end_area_volume(line, (level, ground), QUIET)
    back = end_area_volume(line, (ground, level), QUIET)
    assert (there.cut_m3, there.fill_m3) == pytest.approx((back.fill_m3, back.cut_m3))
    assert there.cut_m3 > 0.0
    assert there.net_m3 == pytest.approx(-back.net_m3)


def test_width_without_ground_is_told_where_it_is_most() -> None:
    holed = FormulaGround(lambda x, y: np.where((np.abs(y) < 2.0) & (x > 35.0), np.nan, 1.0))
    found = end_area_volume(SectionLayout(EAST, 6.0, 20.0, 0.1), (LEVEL, holed), QUIET)
    widths = [section.missing_m for section in found.sections]
    assert widths == pytest.approx([0.0, 0.0, 4.0, 4.0], abs=0.21)
    assert "2 of 4 sections" in found.notes[0].en
    assert found.area_m2 + found.missing_m2 == pytest.approx(720.0)
    assert found.fill_m3 == pytest.approx(found.area_m2)


@pytest.mark.parametrize(
    "line",
    [
        SectionLayout(EAST, 0.0),
        SectionLayout(EAST, 5.0, -1.0),
        SectionLayout(EAST, 5.0, 20.0, 0.0),
        SectionLayout(EAST, np.nan),
        SectionLayout(EAST, 50.0, 1e-4, 1e-4),
    ],
)
def test_sizes_that_cant_be_are_refused(line: SectionLayout) -> None:
    with pytest.raises(OutOfRange):
        end_area_volume(line, (LEVEL, LEVEL), QUIET)


def test_lines_that_are_none_and_lines_off_the_ground_are_refused() -> None:
    with pytest.raises(Unsuitable, match="no length"):
        end_area_volume(SectionLayout(EAST[:1], 5.0), (LEVEL, LEVEL), QUIET)
    with pytest.raises(Unsuitable, match="without position"):
        end_area_volume(SectionLayout(EAST * np.nan, 5.0), (LEVEL, LEVEL), QUIET)
    with pytest.raises(Unsuitable, match="No cross-section"):
        end_area_volume(
            SectionLayout(EAST, 5.0), (LEVEL, LEVEL), QUIET, shapely.box(99, 99, 100, 100)
        )
    before, _ = embankment()
    with pytest.raises(Unsuitable, match="No cross-section"):
        prismoidal_volume(SectionLayout(EAST, 5.0), (LEVEL, before), QUIET)


def test_many_sections_come_in_blocks_and_can_be_stopped() -> None:
    class Counting(SilentMonitor):
        checks = 0

        def check(self) -> None:
            self.checks += 1
            if self.checks == 3:
                raise Cancelled

    line = SectionLayout(EAST, 30.0, 0.05, 0.01)
    with pytest.raises(Cancelled):
        end_area_volume(line, (LEVEL, LEVEL), Counting())
    stations = [
        one.station_m
        for one in end_area_volume(
            SectionLayout(EAST, 30.0, 0.2, 0.05), (LEVEL, LEVEL), QUIET
        ).sections
    ]
    assert all(one < other for one, other in pairwise(stations))


def test_grounds_of_cells_are_cut_as_well_and_holes_are_no_larger_than_their_cells() -> None:
    _, column = np.mgrid[:40, :60]
    grid = CellGrid(np.array([*SURVEYED[:2], 12.0]), 0.5, 40, 60)
    heights = (0.1 * (column + 0.5) * 0.5).astype(np.float32)
    heights[10:14, 20:30] = np.nan
    ground = GridSurface(grid, heights)
    positions = np.random.default_rng(0).uniform(-2, 32, (3000, 2))
    found = ground.heights_at(positions + SURVEYED[:2])
    cell = np.floor(positions / 0.5).astype(int)
    inside = np.all((positions >= 0) & (positions < [30.0, 20.0]), axis=1)
    hole = (cell[:, 1] >= 10) & (cell[:, 1] < 14) & (cell[:, 0] >= 20) & (cell[:, 0] < 30)
    assert np.array_equal(np.isfinite(found), inside & ~hole)
    known = np.isfinite(found)
    assert np.allclose(found[known], 12.0 + 0.1 * positions[known, 0], atol=0.1 * 0.25 + 1e-6)
    line = SectionLayout(np.array([[2.0, 10.0], [8.0, 10.0]]) + SURVEYED[:2], 5.0, 1.0, 0.05)
    filled = end_area_volume(line, (ground, LevelSurface(14.0)), QUIET)
    assert filled.fill_m3 == pytest.approx(6.0 * 10.0 * (2.0 - 0.5), rel=1e-6)
