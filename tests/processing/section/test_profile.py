"""Ground lines and crossings of sections that were made up."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.text import Text
from processing.section.cut import Cut
from processing.section.profile import DrawnLine, crossings_of, ground_line

CUT = Cut((0.0, 0.0, 100.0), (1.0, 0.0), 1.0, 15.0)


def surface(random: np.random.Generator, offsets: np.ndarray) -> np.ndarray:
    """A road and, from 2 m on, a pavement 15 cm above it."""
    return np.where(offsets < 2.0, 100.0, 100.15) + random.normal(0, 0.003, offsets.size)


def test_leaves_above_and_stray_points_below_do_not_move_the_ground() -> None:
    random = np.random.default_rng(1)
    offsets = random.uniform(-5, 5, 20_000)
    heights = surface(random, offsets)
    leaves = random.uniform(0, offsets.size, 4_000).astype(int)
    heights[leaves] += random.uniform(0.5, 3.0, leaves.size)
    heights[random.uniform(0, offsets.size, 60).astype(int)] -= 2.0
    (line,) = ground_line(offsets, heights)
    expected = np.where(line[:, 0] < 2.0, 100.0, 100.15)
    off_edge = np.abs(line[:, 0] - 2.0) > 0.05
    assert np.abs(line[off_edge, 1] - expected[off_edge]).max() < 0.01
    assert np.diff(line[:, 0]).max() < 0.11


def test_a_leaf_over_hidden_ground_is_no_spike() -> None:
    offsets = np.arange(0.0, 4.0, 0.01)
    heights = np.where((offsets > 2.0) & (offsets < 2.05), 103.0, 100.0)
    (line,) = ground_line(offsets, heights)
    assert line[:, 1].max() == pytest.approx(100.0)


def test_a_wide_gap_interrupts_the_ground_and_a_narrow_one_does_not() -> None:
    offsets = np.concatenate(
        [np.arange(0, 1, 0.01), np.arange(1.3, 2, 0.01), np.arange(3, 4, 0.01)]
    )
    line = ground_line(offsets, np.full(offsets.size, 7.0))
    assert [part[[0, -1], 0].round(1).tolist() for part in line] == [[0.0, 2.0], [3.0, 4.0]]
    assert ground_line([], []) == ()


def line(*positions: tuple[float, float, float], is_closed: bool = False) -> DrawnLine:
    return DrawnLine(Text("Curb", "縁石"), "curb", 30, np.array(positions, float), is_closed)


def test_a_line_crosses_where_it_passes_the_plane() -> None:
    (found,) = crossings_of(CUT, line((2, -4, 100), (4, 4, 102)))
    assert (found.offset_m, found.height_m) == pytest.approx((3.0, 101.0))


def test_a_vertex_in_the_plane_counts_once_and_not_where_the_line_turns_back() -> None:
    assert len(crossings_of(CUT, line((1, -2, 100), (1, 0, 100), (1, 2, 100)))) == 1
    assert len(crossings_of(CUT, line((1, -2, 100), (1, 0, 100), (1, -2, 100)))) == 0


def test_an_area_is_crossed_twice_and_a_point_only_within_the_slab() -> None:
    square = line((1, -1, 5), (3, -1, 5), (3, 1, 5), (1, 1, 5), is_closed=True)
    assert sorted(one.offset_m for one in crossings_of(CUT, square)) == pytest.approx([1.0, 3.0])
    assert len(crossings_of(CUT, line((1, 0.4, 5)))) == 1
    assert crossings_of(CUT, line((1, 0.6, 5))) == []


def test_what_passes_beyond_the_ends_of_the_slab_does_not_count() -> None:
    assert crossings_of(CUT, line((16, -1, 0), (16, 1, 0))) == []
