from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.surfaces.filling import fill_smoothly
from processing.methods.earthwork.surfaces.hidden_ground import SeenBeside, fill_ground
from processing.methods.earthwork.surfaces.sight_lines import SightLines

Floats = NDArray[np.float64]
CELL_M = 0.5


def seen_from(stand: Floats, heights: Floats) -> tuple[Floats, SightLines]:
    """What a scanner sees of cells, by every beam to a cell's middle, and its sight lines."""
    rows, columns = heights.shape
    lines = SightLines.without_beams(stand[None])
    seen = np.full(heights.shape, np.nan)
    for row in range(rows):
        for column in range(columns):
            middle = np.array([(column + 0.5) * CELL_M, (row + 0.5) * CELL_M])
            ahead = np.arange(0.0, 1.0, 0.01)[1:, None]
            way = stand[:2] + ahead * (middle - stand[:2])
            cells = np.clip((way / CELL_M).astype(int), 0, [columns - 1, rows - 1])
            beam = stand[2] + ahead[:, 0] * (heights[row, column] - stand[2])
            ground = heights[cells[:, 1], cells[:, 0]]
            own = (cells[:, 0] == column) & (cells[:, 1] == row)
            if np.all((ground <= beam + 0.02) | own):
                seen[row, column] = heights[row, column]
    known = np.argwhere(np.isfinite(seen))
    for share in np.ndindex(5, 5):
        positions = (known[:, ::-1] + 0.1 + np.array(share) / 5) * CELL_M
        lines.add(0, np.column_stack([positions, seen[tuple(known.T)]]), np.zeros(3))
    return seen, lines.finished()


def alone(lines: SightLines, heights: Floats) -> SeenBeside:
    """Beams of the only date."""
    return SeenBeside(lines, np.full(heights.shape, np.nan))


def bank(columns: int) -> Floats:
    """A bank with a flat top 3 m high, then a slope of 1:2, then level ground; along x."""
    x = (np.arange(columns) + 0.5) * CELL_M
    profile = np.clip(3.0 - (x - 12.0) / 2.0, 0.0, 3.0)
    return np.tile(profile, (40, 1))


def test_ground_behind_a_crest_is_found_lower_than_the_beam_over_it() -> None:
    true = bank(80)
    seen, lines = seen_from(np.array([6.0, 10.0, 4.7]), true)
    hidden = np.isnan(seen)

    everywhere = np.ones(seen.shape, np.bool_)
    smooth = fill_smoothly(seen, ~hidden, everywhere)
    filled = fill_ground(seen, everywhere, alone(lines, seen), CELL_M, SilentMonitor())
    # At the edge the shadow is open: what is beyond the last points there stays unknown.
    hidden &= np.isfinite(filled.heights)
    assert hidden.sum() > 100
    off_smooth = (smooth - true)[hidden].sum() * CELL_M**2
    off = (filled.heights - true)[hidden].sum() * CELL_M**2

    assert off_smooth > 5.0
    assert abs(off) < 0.5 * off_smooth
    assert filled.spread[hidden].mean() > 0.1
    assert (filled.spread[np.isfinite(seen)] < 0.1).all()


def test_a_hole_in_a_plane_is_filled_by_the_plane() -> None:
    rows, columns = np.mgrid[:30, :40]
    plane = 0.1 * columns + 0.05 * rows
    known = np.hypot(rows - 15, columns - 20) > 6
    filled = fill_smoothly(np.where(known, plane, 99.0), known, np.ones_like(known))

    np.testing.assert_allclose(filled, plane, atol=0.02)


def test_ground_beyond_the_last_points_stays_unknown() -> None:
    heights = np.full((60, 100), np.nan)
    heights[:, :40] = 1.0
    heights[20:40, 5:30] = np.nan
    none = SightLines.without_beams(np.empty((0, 3)))
    filled = fill_ground(
        heights, np.ones(heights.shape, np.bool_), alone(none, heights), 0.5, SilentMonitor()
    )

    # Surrounded by points, 10 m by 12.5 m.
    assert np.isfinite(filled.heights[:, :40]).all()
    assert np.isnan(filled.heights[:, 40:]).all()


def test_nothing_measured_gives_nothing() -> None:
    none = SightLines.without_beams(np.empty((0, 3)))
    nothing = np.full((4, 4), np.nan)
    filled = fill_ground(
        nothing, np.ones((4, 4), np.bool_), alone(none, nothing), 0.5, SilentMonitor()
    )

    assert np.isnan(filled.heights).all()


def test_a_beam_limits_ground_before_what_it_hit() -> None:
    lines = SightLines.without_beams(np.array([[0.0, 0.0, 2.0]]))
    lines.add(0, np.array([[20.0, 0.1, 0.0], [np.nan, np.nan, np.nan]]), np.zeros(3))
    lines = lines.finished()

    before, behind = lines.highest_at(0, np.array([[10.0, 0.05], [30.0, 0.15]]))
    assert before == pytest.approx(1.0, abs=0.02)
    assert behind == np.inf
