"""What the beams around a beam met, counted quickly, is what counting plainly gives."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.noise.beams.beam_kernels import PointBeams
from processing.methods.noise.beams.window_kernels import (
    NEAR_FEATURES,
    SUSPICION_FEATURES,
    WIDE_FEATURES,
    near_beams_kernel,
    suspicion_kernel,
    wide_beams_kernel,
)

_NEAR = (range(-2, 3), 3, 1)
_MIDDLE = (range(-4, 5, 2), 12, 1)
_WIDE = (range(-10, 11, 5), 64, 2)

RowWindow = tuple[range, int, int]


@pytest.fixture(scope="module")
def beams() -> PointBeams:
    """Rows of uneven length with gaps and double returns, in two recordings."""
    random = np.random.default_rng(8)
    counts = random.integers(0, 90, 30)
    columns = np.concatenate([np.sort(random.integers(0, 150, count)) for count in counts])
    starts = np.concatenate([[0], np.cumsum(counts)])
    segments = (np.arange(30) > 17).astype(np.int32)
    ranges = random.choice([4.0, 4.01, 4.06, 4.3, 9.0], columns.size)
    positions = np.zeros((columns.size, 3))
    return PointBeams(
        positions, positions, ranges, columns.astype(np.int32), starts, segments, 0.01
    )


@pytest.fixture(scope="module")
def asked(beams: PointBeams) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Every third point, and its row."""
    points = np.arange(0, beams.ranges.size, 3)
    return points, np.searchsorted(beams.row_starts, points, "right") - 1


def looked_at(
    beams: PointBeams, point: int, row: int, window: RowWindow
) -> tuple[NDArray[np.int64], int]:
    """The other points of a window, and how many rows it has."""
    offsets, aside, stride = window
    found, rows = [], 0
    for other in (row + offset for offset in offsets):
        if 0 <= other < beams.segments.size and beams.segments[other] == beams.segments[row]:
            rows += 1
            of_row = np.arange(beams.row_starts[other], beams.row_starts[other + 1])
            away = beams.columns[of_row].astype(int) - beams.columns[point]
            found.append(of_row[np.abs(away) <= aside][::stride])
    positions = np.concatenate(found)
    return positions[positions != point], rows


def plain_shares(
    beams: PointBeams, is_sure: NDArray[np.bool_], point: int, row: int, window: RowWindow
) -> list[float]:
    positions, rows = looked_at(beams, point, row, window)
    gaps = beams.ranges[positions] - beams.ranges[point]
    used, (_, aside, stride) = max(positions.size, 1), window
    near = [(np.abs(gaps) < limit).sum() / used for limit in (0.025, 0.1, 0.4)]
    aside_of = [(gaps < -0.1).sum() / used, (gaps > 0.1).sum() / used]
    sure = (is_sure[positions] & (gaps < -0.1)).sum() / used
    return [stride * positions.size / (rows * (2 * aside + 1) - 1), *near, *aside_of, sure]


def test_near_and_wide_windows_hold_what_plain_counting_finds(
    beams: PointBeams, asked: tuple[NDArray[np.int64], NDArray[np.int64]]
) -> None:
    points, rows = asked
    is_sure = np.random.default_rng(1).random(beams.ranges.size) < 0.5
    near = np.empty((points.size, NEAR_FEATURES), np.float32)
    wide = np.empty((points.size, WIDE_FEATURES), np.float32)
    near_beams_kernel(beams, is_sure, points, rows, near)
    wide_beams_kernel(beams, is_sure, points, rows, wide)
    for i, (point, row) in enumerate(zip(points, rows, strict=True)):
        expected = [
            plain_shares(beams, is_sure, int(point), int(row), one)
            for one in (_NEAR, _MIDDLE, _WIDE)
        ]
        np.testing.assert_allclose(near[i], expected[0] + expected[1], rtol=1e-5)
        np.testing.assert_allclose(wide[i, :-1], expected[2], rtol=1e-5)
        assert wide[i, -1] == pytest.approx(np.log2(beams.ranges[point]))


def test_suspicion_is_the_mean_of_what_was_said_beside(
    beams: PointBeams, asked: tuple[NDArray[np.int64], NDArray[np.int64]]
) -> None:
    points, rows = asked
    suspicions = np.random.default_rng(2).random(beams.ranges.size).astype(np.float32)
    found = np.empty((points.size, SUSPICION_FEATURES), np.float32)
    suspicion_kernel(beams, suspicions, points, rows, found)
    for i, (point, row) in enumerate(zip(points, rows, strict=True)):
        for number, window in enumerate((_MIDDLE, _WIDE)):
            positions, _ = looked_at(beams, int(point), int(row), window)
            alike = positions[np.abs(beams.ranges[positions] - beams.ranges[point]) < 0.1]
            means = [
                float(suspicions[one].mean()) if one.size else 0.0 for one in (positions, alike)
            ]
            np.testing.assert_allclose(found[i, 2 * number : 2 * number + 2], means, rtol=1e-4)
