"""The found ground in a section: where it lies, and which of it was measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.methods.ground.filters.cells import CellGrid
from processing.methods.ground.stored_surface import StoredSurface, SurfaceTile, SurfaceWriter
from processing.methods.ground.surface_line import remove_doubles, surface_lines
from processing.section.cut import Cut

ORIGIN = np.array([-12_000.0, -36_000.0, 5.0])
CUT = Cut((-11_990.0, -35_990.0, 20.0), (1.0, 0.0), half_length_m=8.0)
GRADE = 0.1


@pytest.fixture
def surface(tmp_path: Path) -> StoredSurface:
    """A plane that rises to the east, filled in from 10 m to 12 m, with nothing from 14 m on."""
    grid = CellGrid(ORIGIN, 0.5, 40, 40)
    east = (np.arange(40) + 0.5) * 0.5
    heights = np.tile((GRADE * east).astype(np.float32), (40, 1))
    heights[:, east > 14.0] = np.nan
    filled = np.tile((east > 10.0) & (east < 12.0), (40, 1))
    with SurfaceWriter(tmp_path / "s.tiles", grid, "") as writer:
        writer.add(SurfaceTile(0, 0, heights, filled))
    return StoredSurface(tmp_path / "s.tiles")


def test_ground_is_a_line_of_measured_and_filled_stretches(surface: StoredSurface) -> None:
    lines = surface_lines(surface, CUT)
    assert [line.is_filled for line in lines] == [False, True, False]
    for line in lines:
        east = line.positions[:, 0] + 10.0
        np.testing.assert_allclose(line.positions[:, 1], 5.0 + GRADE * east, atol=1e-3)
    ends = [line.positions[[0, -1], 0] + 10.0 for line in lines]
    np.testing.assert_allclose(ends[0], (2.0, 10.0), atol=0.55)
    np.testing.assert_allclose(ends[1], (10.0, 12.0), atol=0.55)
    assert ends[0][1] == ends[1][0]
    assert ends[2][1] == pytest.approx(13.75, abs=0.55)


def test_beside_the_surface_there_is_none(surface: StoredSurface) -> None:
    assert surface_lines(surface, Cut((0.0, 0.0, 0.0), (1.0, 0.0))) == ()


def test_drives_that_keep_the_same_surface_show_it_once(surface: StoredSurface) -> None:
    one, other = surface_lines(surface, CUT), surface_lines(surface, CUT)
    assert remove_doubles([one, other]) == one
    assert len(remove_doubles([one, other[:1]])) == 4
