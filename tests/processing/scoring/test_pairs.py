"""Pairing of points: blocks of any size, any order, duplicates, and what has no counterpart."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.scoring.points.coded_points import CodedFile, CodedPoints, pairs_by_order
from processing.scoring.points.pairs_by_position import pairs_by_position

STEP_M = 0.001


def file_of(
    xyz: NDArray[np.float64], codes: NDArray[np.uint8], block: int, step_m: float = STEP_M
) -> CodedFile:
    def blocks() -> Iterator[CodedPoints]:
        kinds = {"kind": codes.astype(np.int16) - 5}
        for start in range(0, len(codes), block):
            yield CodedPoints(codes, xyz, kinds).part(slice(start, start + block))

    return CodedFile(Path("cloud"), len(codes), step_m, has_positions=True, blocks=blocks)


def cloud(count: int) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
    random = np.random.default_rng(5)
    steps = random.integers(0, 30, (count, 3))
    origin = np.array([-11_000.0, -35_000.0, 100.0])
    return origin + steps * STEP_M, random.integers(0, 20, count).astype(np.uint8)


@pytest.mark.parametrize(("one", "other"), [(1, 1), (3, 7), (100, 9), (1000, 1000)])
def test_blocks_of_different_sizes_are_paired_point_by_point(one: int, other: int) -> None:
    xyz, codes = cloud(100)
    truth, result = file_of(xyz, codes, one), file_of(xyz, codes, other)
    pairs = list(pairs_by_order(truth, result, SilentMonitor()))
    assert np.array_equal(np.concatenate([pair.truth.codes for pair in pairs]), codes)
    assert np.array_equal(np.concatenate([pair.result.codes for pair in pairs]), codes)


def test_rounding_to_the_coarser_file_s_step_is_no_other_place() -> None:
    xyz, codes = cloud(50)
    rounded = np.round(xyz, 2)
    pairs = pairs_by_order(
        file_of(xyz, codes, 50), file_of(rounded, codes, 50, 0.01), SilentMonitor()
    )
    assert sum(len(pair.truth.codes) for pair in pairs) == 50


def test_a_point_that_lies_elsewhere_is_named() -> None:
    xyz, codes = cloud(50)
    moved = xyz.copy()
    moved[31, 2] += 0.002
    with pytest.raises(Unsuitable, match="Point 32 "):
        list(pairs_by_order(file_of(xyz, codes, 7), file_of(moved, codes, 9), SilentMonitor()))


@pytest.mark.parametrize("at_once", [2_000_000, 40])
def test_points_at_one_place_are_paired_in_the_order_of_the_files(
    tmp_path: Path, at_once: int
) -> None:
    xyz, codes = cloud(400)
    xyz[200:] = xyz[:200]
    order = np.r_[np.random.default_rng(0).permutation(200), 200 + np.arange(200)]
    pairs = pairs_by_position(
        file_of(xyz, codes, 33),
        file_of(xyz[order], codes[order], 50),
        tmp_path,
        SilentMonitor(),
        points_at_once=at_once,
    )
    found = list(pairs)
    assert sum(len(pair.truth.codes) for pair in found) == 400
    for pair in found:
        assert np.array_equal(pair.truth.codes, pair.result.codes)
        assert np.array_equal(pair.truth.kinds["kind"], pair.truth.codes.astype(np.int16) - 5)
        assert np.array_equal(pair.result.kinds["kind"], pair.result.codes.astype(np.int16) - 5)


@pytest.mark.parametrize("at_once", [2_000_000, 40])
def test_points_without_counterpart_are_counted_one_to_one(tmp_path: Path, at_once: int) -> None:
    xyz, codes = cloud(300)
    lacking = np.arange(10, 300)
    with pytest.raises(Unsuitable, match="4 of the result's 294 points and 10 of the truth's 300"):
        list(
            pairs_by_position(
                file_of(xyz + np.r_[0.0, 0.0, 1.0] * (np.arange(300) < 10)[:, None], codes, 33),
                file_of(np.r_[xyz[lacking], xyz[[50] * 4]], codes[np.r_[lacking, [50] * 4]], 50),
                tmp_path,
                SilentMonitor(),
                points_at_once=at_once,
            )
        )


def test_a_file_without_points_has_no_pairs(tmp_path: Path) -> None:
    nothing = file_of(np.empty((0, 3)), np.empty(0, np.uint8), 10)
    assert list(pairs_by_order(nothing, nothing, SilentMonitor())) == []
    pairs = pairs_by_position(nothing, nothing, tmp_path, SilentMonitor())
    assert sum(len(pair.truth.codes) for pair in pairs) == 0
